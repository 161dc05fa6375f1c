//! Paths in one file: those of its `use` items, and qualified paths elsewhere in its code.

/// Segments of a path.
pub(super) type Segments = Vec<String>;

/// A path as a file contains it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct WrittenPath {
    /// Inline modules of the file around it, outermost first.
    pub(super) inside: Segments,
    /// Its segments.
    pub(super) segments: Segments,
    /// The name that a `use` item introduces (`*` and the path for a glob); `None` elsewhere.
    pub(super) alias: Option<String>,
    /// Whether it belongs to a `pub use`, of any visibility.
    pub(super) exported: bool,
    /// The byte at which its statement begins.
    pub(super) start: usize,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum CodeToken<'a> {
    Word(&'a str),
    Separator,
    Sign(char),
}

/// Every qualified path in code without comments and literals.
pub(super) fn paths(code: &str) -> Vec<WrittenPath> {
    let tokens = tokens(code);
    let mut paths = Vec::new();
    let mut inside: Vec<(String, usize)> = Vec::new();
    let (mut depth, mut at) = (0_usize, 0);
    while at < tokens.len() {
        let here = inside.iter().map(|(name, _)| name.clone());
        match tokens[at].0 {
            CodeToken::Sign('{') => depth += 1,
            CodeToken::Sign('}') => {
                depth = depth.saturating_sub(1);
                if inside.last().is_some_and(|(_, opened)| *opened == depth) {
                    inside.pop();
                }
            }
            CodeToken::Word("mod") => {
                if let [(CodeToken::Word(name), _), (CodeToken::Sign('{'), _), ..] =
                    tokens[at + 1..]
                {
                    inside.push((name.to_owned(), depth));
                }
            }
            CodeToken::Word("use") if token(&tokens, at + 1) != Some(CodeToken::Sign('<')) => {
                let start = tokens[at].1;
                let exported = is_exported(&tokens, at);
                let mut leaves = Vec::new();
                at = use_tree(&tokens, at + 1, &Vec::new(), &mut leaves);
                paths.extend(leaves.into_iter().map(|(alias, segments)| WrittenPath {
                    inside: here.clone().collect(),
                    segments,
                    alias: Some(alias),
                    exported,
                    start,
                }));
                continue;
            }
            CodeToken::Word(_) if begins_path(&tokens, at) => {
                let (segments, end) = plain_path(&tokens, at);
                let (inside, start) = (here.collect(), tokens[at].1);
                paths.push(WrittenPath { inside, segments, alias: None, exported: false, start });
                at = end;
                continue;
            }
            _ => {}
        }
        at += 1;
    }
    paths
}

fn token<'a>(tokens: &[(CodeToken<'a>, usize)], at: usize) -> Option<CodeToken<'a>> {
    tokens.get(at).map(|(token, _)| *token)
}

/// Words, `::` and other signs of a code, with the bytes at which they begin.
fn tokens(code: &str) -> Vec<(CodeToken<'_>, usize)> {
    let mut tokens = Vec::new();
    let mut rest = code;
    while let Some(first) = rest.chars().next() {
        let at = code.len() - rest.len();
        let is_word = |letter: char| letter.is_alphanumeric() || letter == '_';
        let length = if is_word(first) {
            let length = rest.find(|letter| !is_word(letter)).unwrap_or(rest.len());
            tokens.push((CodeToken::Word(&rest[..length]), at));
            length
        } else if rest.starts_with("::") {
            tokens.push((CodeToken::Separator, at));
            2
        } else {
            if !first.is_whitespace() {
                tokens.push((CodeToken::Sign(first), at));
            }
            first.len_utf8()
        };
        rest = &rest[length..];
    }
    tokens
}

/// Whether the `use` at `at` follows `pub` or `pub(…)`.
fn is_exported(tokens: &[(CodeToken<'_>, usize)], at: usize) -> bool {
    let before = &tokens[..at];
    match before.last() {
        Some((CodeToken::Word("pub"), _)) => true,
        Some((CodeToken::Sign(')'), _)) => {
            let open = before.iter().rposition(|(token, _)| *token == CodeToken::Sign('('));
            open.and_then(|open| open.checked_sub(1))
                .is_some_and(|at| before[at].0 == CodeToken::Word("pub"))
        }
        _ => false,
    }
}

/// Adds the leaves of the `use` tree at `at` with their names, and returns the position after the tree.
fn use_tree(
    tokens: &[(CodeToken<'_>, usize)],
    mut at: usize,
    prefix: &Segments,
    leaves: &mut Vec<(String, Segments)>,
) -> usize {
    let mut segments = prefix.clone();
    let mut alias = None;
    while let Some(token) = token(tokens, at) {
        match token {
            CodeToken::Word("as") => {
                if let Some((CodeToken::Word(name), _)) = tokens.get(at + 1) {
                    alias = Some((*name).to_owned());
                }
                at += 1;
            }
            // In `a::{self}` it stands for `a`; in `self::a` for the module itself.
            CodeToken::Word("self") if !segments.is_empty() => {}
            CodeToken::Word(name) => segments.push(name.to_owned()),
            CodeToken::Sign('*') => alias = Some(format!("*{}", segments.join("::"))),
            CodeToken::Sign('{') => {
                while !matches!(self::token(tokens, at), None | Some(CodeToken::Sign('}'))) {
                    at = use_tree(tokens, at + 1, &segments, leaves);
                }
                return at + 1;
            }
            CodeToken::Separator => {}
            CodeToken::Sign(_) => break,
        }
        at += 1;
    }
    // Between a comma and the closing brace there may be no leaf.
    if segments.len() > prefix.len() || alias.is_some() || named_self(tokens, at) {
        let name = alias.or_else(|| segments.last().cloned()).unwrap_or_default();
        leaves.push((name, segments));
    }
    at
}

/// Whether the token before `at` is `self`.
fn named_self(tokens: &[(CodeToken<'_>, usize)], at: usize) -> bool {
    at.checked_sub(1).and_then(|at| token(tokens, at)) == Some(CodeToken::Word("self"))
}

/// Whether the word at `at` begins a path of two segments or more. A visibility (`pub(in …)`) is not a use.
fn begins_path(tokens: &[(CodeToken<'_>, usize)], at: usize) -> bool {
    let before = |back: usize| at.checked_sub(back).and_then(|at| token(tokens, at));
    let continued = matches!(before(1), Some(CodeToken::Separator | CodeToken::Sign('.')));
    let visibility = before(1) == Some(CodeToken::Word("in"))
        && before(2) == Some(CodeToken::Sign('('))
        && before(3) == Some(CodeToken::Word("pub"));
    token(tokens, at + 1) == Some(CodeToken::Separator) && !continued && !visibility
}

/// Segments of the path at `at`, and the position after it.
fn plain_path(tokens: &[(CodeToken<'_>, usize)], mut at: usize) -> (Segments, usize) {
    let mut segments = Vec::new();
    while let Some(CodeToken::Word(name)) = token(tokens, at) {
        segments.push(name.to_owned());
        at += 1;
        if token(tokens, at) != Some(CodeToken::Separator) {
            break;
        }
        at += 1;
    }
    (segments, at)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn written(code: &str) -> Vec<(String, Option<String>, bool)> {
        paths(code)
            .into_iter()
            .map(|path| {
                let whole = [path.inside, path.segments].map(|part| part.join("::")).join("|");
                (whole, path.alias, path.exported)
            })
            .collect()
    }

    #[test]
    fn use_trees_are_expanded() {
        let code = "use crate::a::{self, b::{C, D as E,}, f::*};\npub(crate) use g::H;\npub use self::i;\nuse super::super::J;";
        let use_of = |path: &str, name: &str, exported| {
            (format!("|{path}"), Some(name.to_owned()), exported)
        };
        assert_eq!(
            written(code),
            [
                use_of("crate::a", "a", false),
                use_of("crate::a::b::C", "C", false),
                use_of("crate::a::b::D", "E", false),
                use_of("crate::a::f", "*crate::a::f", false),
                use_of("g::H", "H", true),
                use_of("self::i", "i", true),
                use_of("super::super::J", "J", false),
            ]
        );
    }

    #[test]
    fn qualified_paths_in_code_are_found() {
        let code = "pub(in crate::x) fn f(a: super::A) -> impl T + use<'_> { \
                    a.b::<C>(); crate::d::e::<F>(); g(h); $crate::m!() }\n\
                    mod inner { fn k() { super::l(); } } fn n() { self::o(); }";
        let paths: Vec<String> = written(code).into_iter().map(|(path, ..)| path).collect();
        assert_eq!(paths, ["|super::A", "|crate::d::e", "|crate::m", "inner|super::l", "|self::o"]);
    }

    #[test]
    fn offsets_are_those_of_the_statement() {
        let code = "fn f() {}\nuse super::{a,\n b};\nfn g() { super::c(); }";
        let starts: Vec<usize> = paths(code).iter().map(|path| path.start).collect();
        assert_eq!(starts, [10, 10, code.find("super::c").expect("planted")]);
    }
}
