//! Parses the text of a formula into a tree.
//!
//! Grammar: numbers, names, `+ − * / ^` with their usual precedence (`^` from the right, before a sign:
//! −v^2 = −(v²)), parentheses, and functions of one argument. Existing parser crates return
//! values, but the recurrence needs the tree, and errors must give the character.

use std::fmt;

use super::tree::{Function, Tree};

/// Maximum number of characters of a formula.
pub const LONGEST: usize = 1000;

/// Deepest nesting of parentheses, signs and powers.
const DEEPEST: usize = 50;

/// Functions with kinks or jumps.
const NOT_SMOOTH: &[&str] =
    &["min", "max", "floor", "ceil", "round", "mod", "if", "step", "heaviside", "clamp"];

/// A syntax error in a formula.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SyntaxError {
    /// Character, counted from 1.
    pub character: usize,
    /// What is wrong there.
    pub what: String,
}

impl fmt::Display for SyntaxError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "at character {}: {}", self.character, self.what)
    }
}

#[derive(Clone, Debug, PartialEq)]
enum Token {
    Number(f64),
    Name(String),
    Mark(char),
    End,
}

impl fmt::Display for Token {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number(number) => write!(f, "{number}"),
            Self::Name(name) => write!(f, "{name}"),
            Self::Mark(mark) => write!(f, "“{mark}”"),
            Self::End => f.write_str("the end"),
        }
    }
}

/// Whether a name is valid for a constant.
pub fn is_name(name: &str) -> bool {
    let mut letters = name.chars();
    let start = |letter: char| letter.is_ascii_alphabetic() || letter == '_';
    letters.next().is_some_and(start)
        && letters.all(|letter| start(letter) || letter.is_ascii_digit())
}

/// Whether a name already has a meaning in a formula.
pub fn is_taken(name: &str) -> bool {
    name == "v" || name == "pi" || Function::named(name).is_some() || NOT_SMOOTH.contains(&name)
}

/// Reads the formula of a law whose constants have these names.
pub(super) fn parse(text: &str, names: &[&str]) -> Result<Tree, SyntaxError> {
    read(text, names, true)
}

/// Reads the formula of a number: the slip velocity has no meaning in it.
pub(super) fn parse_number(text: &str, names: &[&str]) -> Result<Tree, SyntaxError> {
    read(text, names, false)
}

fn read(text: &str, names: &[&str], of_law: bool) -> Result<Tree, SyntaxError> {
    if text.chars().count() > LONGEST {
        let what = format!("the formula is longer than {LONGEST} characters");
        return Err(SyntaxError { character: LONGEST, what });
    }
    let mut parser = Parser { tokens: tokens(text)?, at: 0, depth: 0, names, of_law };
    let tree = parser.sum()?;
    match parser.peek() {
        Token::End => Ok(tree),
        other => Err(parser.wrong(format!("expected an operator (+ - * / ^), found {other}"))),
    }
}

fn tokens(text: &str) -> Result<Vec<(usize, Token)>, SyntaxError> {
    let letters: Vec<char> = text.chars().collect();
    let mut found = Vec::new();
    let mut at = 0;
    while at < letters.len() {
        let first = at;
        let letter = letters[at];
        let run = |from: usize, of: &dyn Fn(char) -> bool| {
            from + letters[from..].iter().take_while(|letter| of(**letter)).count()
        };
        let digit = |letter: char| letter.is_ascii_digit();
        if letter.is_whitespace() {
            at += 1;
            continue;
        }
        let token = if digit(letter) || letter == '.' {
            at = run(at, &|letter| digit(letter) || letter == '.');
            if matches!(letters.get(at), Some('e' | 'E')) {
                let sign = usize::from(matches!(letters.get(at + 1), Some('+' | '-')));
                if letters.get(at + 1 + sign).copied().is_some_and(digit) {
                    at = run(at + 1 + sign, &digit);
                }
            }
            let written: String = letters[first..at].iter().collect();
            let number = written.parse::<f64>().ok().filter(|number| number.is_finite());
            Token::Number(number.ok_or_else(|| SyntaxError {
                character: first + 1,
                what: format!("{written} is not a finite number"),
            })?)
        } else if letter.is_ascii_alphabetic() || letter == '_' {
            at = run(at, &|letter| letter.is_ascii_alphanumeric() || letter == '_');
            Token::Name(letters[first..at].iter().collect())
        } else if "+-*/^()".contains(letter) {
            at += 1;
            Token::Mark(letter)
        } else {
            let hint = match letter {
                '|' => "write abs(v) for |v|".to_owned(),
                ',' => "functions take one argument, and numbers use a decimal point".to_owned(),
                '−' | '–' => "use - (a plain hyphen) as the minus sign".to_owned(),
                '·' | '×' => "use * for a product".to_owned(),
                other => format!("“{other}” has no meaning in a formula"),
            };
            return Err(SyntaxError { character: first + 1, what: hint });
        };
        found.push((first + 1, token));
    }
    found.push((letters.len() + 1, Token::End));
    Ok(found)
}

struct Parser<'n> {
    tokens: Vec<(usize, Token)>,
    at: usize,
    depth: usize,
    names: &'n [&'n str],
    /// Whether the slip velocity may occur.
    of_law: bool,
}

impl Parser<'_> {
    fn peek(&self) -> Token {
        self.tokens.get(self.at).map_or(Token::End, |(_, token)| token.clone())
    }

    fn wrong(&self, what: impl Into<String>) -> SyntaxError {
        let last = self.tokens.len().saturating_sub(1);
        let character = self.tokens.get(self.at.min(last)).map_or(1, |(at, _)| *at);
        SyntaxError { character, what: what.into() }
    }

    fn take(&mut self, mark: char) -> bool {
        let found = self.peek() == Token::Mark(mark);
        self.at += usize::from(found);
        found
    }

    fn sum(&mut self) -> Result<Tree, SyntaxError> {
        let mut tree = self.product()?;
        loop {
            if self.take('+') {
                tree = Tree::Sum(Box::new(tree), Box::new(self.product()?));
            } else if self.take('-') {
                tree = Tree::Difference(Box::new(tree), Box::new(self.product()?));
            } else {
                return Ok(tree);
            }
        }
    }

    fn product(&mut self) -> Result<Tree, SyntaxError> {
        let mut tree = self.signed()?;
        loop {
            if self.take('*') {
                if self.peek() == Token::Mark('*') {
                    return Err(self.wrong("use ^ for a power"));
                }
                tree = Tree::Product(Box::new(tree), Box::new(self.signed()?));
            } else if self.take('/') {
                tree = Tree::Quotient(Box::new(tree), Box::new(self.signed()?));
            } else {
                return Ok(tree);
            }
        }
    }

    fn signed(&mut self) -> Result<Tree, SyntaxError> {
        self.depth += 1;
        if self.depth > DEEPEST {
            return Err(self.wrong(format!("nested more than {DEEPEST} times")));
        }
        let tree = if self.take('-') {
            Tree::Negative(Box::new(self.signed()?))
        } else if self.take('+') {
            self.signed()?
        } else {
            self.power()?
        };
        self.depth -= 1;
        Ok(tree)
    }

    fn power(&mut self) -> Result<Tree, SyntaxError> {
        let base = self.primary()?;
        if self.take('^') {
            return Ok(Tree::Power(Box::new(base), Box::new(self.signed()?)));
        }
        Ok(base)
    }

    fn primary(&mut self) -> Result<Tree, SyntaxError> {
        match self.peek() {
            Token::Number(number) => {
                self.at += 1;
                Ok(Tree::Number(number))
            }
            Token::Name(name) => self.named(&name),
            Token::Mark('(') => {
                self.at += 1;
                self.closed()
            }
            other => {
                let velocity = if self.of_law { "v, " } else { "" };
                Err(self.wrong(format!(
                    "expected a number, {velocity}a name, a function or “(”, found {other}"
                )))
            }
        }
    }

    /// The expression after an opening parenthesis, which is already consumed, up to the closing one.
    fn closed(&mut self) -> Result<Tree, SyntaxError> {
        let tree = self.sum()?;
        if self.take(')') {
            return Ok(tree);
        }
        let other = self.peek();
        Err(self.wrong(format!("expected “)” or an operator (+ - * / ^), found {other}")))
    }

    fn named(&mut self, name: &str) -> Result<Tree, SyntaxError> {
        let called = matches!(self.tokens.get(self.at + 1), Some((_, Token::Mark('('))));
        if let Some(function) = Function::named(name) {
            if !called {
                return Err(self.wrong(format!("{name} is a function: write {name}(…)")));
            }
            self.at += 2;
            return Ok(Tree::Call(function, Box::new(self.closed()?)));
        }
        let tree = if NOT_SMOOTH.contains(&name) {
            return Err(self.wrong(format!(
                "{name} has kinks or jumps, which would need event detection: use smooth \
                 functions (exp, tanh, sqrt, …)"
            )));
        } else if let Some(index) = self.names.iter().position(|known| *known == name) {
            Tree::Constant(index)
        } else if name == "v" && self.of_law {
            Tree::Velocity
        } else if name == "pi" {
            Tree::Number(std::f64::consts::PI)
        } else {
            let functions: Vec<&str> = Function::NAMES.iter().map(|(name, _)| *name).collect();
            let known = match (self.of_law, self.names) {
                (true, []) => {
                    "the slip velocity is v, no constants are given in [friction.constants]"
                        .to_owned()
                }
                (true, names) => {
                    format!("the slip velocity is v, constants are {}", names.join(", "))
                }
                (false, []) => "the study has no [parameters]".to_owned(),
                (false, names) => format!("parameters are {}", names.join(", ")),
            };
            return Err(self.wrong(format!(
                "{name} is unknown: {known}, functions are {}",
                functions.join(", ")
            )));
        };
        if called {
            return Err(self.wrong(format!("{name} is not a function; write a product with *")));
        }
        self.at += 1;
        Ok(tree)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn value(text: &str) -> f64 {
        parse(text, &["a"]).map_err(|error| error.to_string()).expect(text).value(&[5.0])
    }

    #[test]
    fn precedence_is_the_usual_one() {
        for (text, expected) in [
            ("1 + 2*3", 7.0),
            ("(1 + 2)*3", 9.0),
            ("10 - 4 - 3", 3.0),
            ("16/4/2", 2.0),
            ("2^3^2", 512.0),
            ("-2^2", -4.0),
            ("2^-1", 0.5),
            ("1e-3*1E+3", 1.0),
            (".5 + 1.", 1.5),
            ("a*-a", -25.0),
            ("sqrt(16) + abs(-3) - sign(-2)", 8.0),
            ("cos(pi) + exp(0) + ln(1)", 0.0),
        ] {
            assert_eq!(value(text), expected, "{text}");
        }
    }

    #[test]
    fn errors_name_the_character() {
        for (text, character, part) in [
            ("0.3 + ", 7, "the end"),
            ("0.3 + )", 7, "found “)”"),
            ("0.3 0.1", 5, "an operator"),
            ("(0.3", 5, "“)”"),
            ("0.3*|v|", 5, "abs(v)"),
            ("0,3", 2, "decimal point"),
            ("max(v, 1)", 6, "one argument"),
            ("max(v)", 1, "kinks"),
            ("b*v", 1, "constants are a"),
            ("exp v", 1, "exp(…)"),
            ("2(v)", 2, "an operator"),
            ("a(v)", 1, "not a function"),
            ("1e999", 1, "finite"),
            ("v**2", 3, "use ^"),
            ("", 1, "the end"),
        ] {
            let error = parse(text, &["a"]).expect_err(text);
            assert_eq!(error.character, character, "{text}: {error}");
            assert!(error.what.contains(part), "{text}: {error}");
        }
        let deep = "(".repeat(400) + "v" + &")".repeat(400);
        assert!(parse(&deep, &[]).is_err());
        assert!(parse(&"v+".repeat(900), &[]).is_err());
    }
}
