//! Labels: plain text with symbols between dollars, measured with the bundled fonts.
//!
//! Between `$` and `$`: Latin and lower-case Greek letters print in italics, `_x` and `_{xy}` are subscripts
//! (upright), `^x` and `^{xy}` are superscripts (which may contain a subscript `_x`), `\bar{…}` puts a bar over its letters
//! (as does a combining macron after a letter), `\word` prints the word upright (`\ln`), and `-` prints as a minus sign.
//! An unpaired dollar prints as itself. Greek letters are written literally: `$τ$`, `$ω_0$`.
//!
//! [`super::tspan`] converts letter styles to SVG elements.

use super::fonts::{self, Face};
use super::letter_style::{LetterStyle, ScriptLevel};
use super::tspan::Pen;

/// Distance between the lines of a label inside a frame, over its size.
pub(super) const LINE_HEIGHT: f64 = 1.15;

#[derive(Debug, Clone, PartialEq, Eq)]
struct TextRun {
    text: String,
    look: LetterStyle,
}

/// A label, parsed into runs of one letter style.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct RichText {
    runs: Vec<TextRun>,
}

impl RichText {
    /// Parses a label.
    pub(super) fn parse(source: &str) -> Self {
        let mut label = Self { runs: Vec::new() };
        let mut rest = source;
        while let Some(start) = rest.find('$') {
            let Some(length) = rest[start + 1..].find('$') else {
                break;
            };
            label.push_text(&rest[..start], LetterStyle::default());
            label.push_symbols(&rest[start + 1..start + 1 + length]);
            rest = &rest[start + length + 2..];
        }
        label.push_text(rest, LetterStyle::default());
        label
    }

    /// True when nothing prints.
    pub(super) fn is_empty(&self) -> bool {
        self.runs.is_empty()
    }

    /// Width in pixels at this font size.
    pub(super) fn width(&self, size: f64, bold: bool) -> f64 {
        self.runs
            .iter()
            .map(|run| {
                let face = match (bold, run.look.italic) {
                    (true, _) => Face::Bold,
                    (false, true) => Face::Oblique,
                    (false, false) => Face::Regular,
                };
                fonts::width(&run.text, face) * size * run.look.level.share()
            })
            .sum()
    }

    /// The text as contents of an SVG `<text>` element.
    pub(super) fn svg(&self) -> String {
        let mut pen = Pen::default();
        for run in &self.runs {
            if run.look.barred {
                run.text.chars().for_each(|letter| pen.put_barred(letter, run.look));
            } else {
                pen.put(&run.text, run.look, run.look.level.depth());
            }
        }
        pen.into_text()
    }

    /// The text without styles: `_` before a subscript, `^` before a superscript, and a combining macron for a bar.
    pub(super) fn plain(&self) -> String {
        let mut plain = String::new();
        let mut level = ScriptLevel::Base;
        for run in &self.runs {
            if run.look.level != level {
                level = run.look.level;
                plain.push_str(match level {
                    ScriptLevel::Base => "",
                    ScriptLevel::Lowered | ScriptLevel::RaisedLowered => "_",
                    ScriptLevel::Raised => "^",
                });
            }
            for letter in run.text.chars() {
                plain.push(letter);
                if run.look.barred {
                    plain.push('\u{304}');
                }
            }
        }
        plain
    }

    /// The text as HTML.
    pub(super) fn html(&self) -> String {
        let mut html = String::new();
        for run in &self.runs {
            let LetterStyle { italic, barred, level } = run.look;
            let mut text = String::new();
            for letter in run.text.chars() {
                match letter {
                    '&' => text.push_str("&amp;"),
                    '<' => text.push_str("&lt;"),
                    '>' => text.push_str("&gt;"),
                    _ => text.push(letter),
                }
                if barred {
                    text.push('\u{304}');
                }
            }
            if italic {
                text = format!("<i>{text}</i>");
            }
            let (open, close) = match level {
                ScriptLevel::Base => ("", ""),
                ScriptLevel::Lowered => ("<sub>", "</sub>"),
                ScriptLevel::Raised => ("<sup>", "</sup>"),
                ScriptLevel::RaisedLowered => ("<sup><sub>", "</sub></sup>"),
            };
            html += open;
            html += &text;
            html += close;
        }
        html
    }

    fn push_text(&mut self, text: &str, look: LetterStyle) {
        for letter in text.chars() {
            // Control and private-use characters are not printable and must not appear in the XML.
            let private = ('\u{E000}'..='\u{F8FF}').contains(&letter);
            if private || matches!(letter, '\u{FFFE}' | '\u{FFFF}') {
                continue;
            }
            let letter = if letter.is_control() { ' ' } else { letter };
            match self.runs.last_mut() {
                Some(run) if run.look == look => run.text.push(letter),
                _ => self.runs.push(TextRun { text: letter.to_string(), look }),
            }
        }
    }

    fn push_symbols(&mut self, source: &str) {
        let letters: Vec<char> = source.chars().collect();
        let mut at = 0;
        while at < letters.len() {
            match letters[at] {
                '_' | '^' => {
                    let level =
                        if letters[at] == '_' { ScriptLevel::Lowered } else { ScriptLevel::Raised };
                    let (inner, next) = group(&letters, at + 1);
                    self.push_letters(&inner, level, false);
                    at = next;
                }
                '\\' => {
                    let end = word_end(&letters, at + 1);
                    let word: String = letters[at + 1..end].iter().collect();
                    if word == "bar" {
                        let (inner, next) = group(&letters, end);
                        self.push_letters(&inner, ScriptLevel::Base, true);
                        at = next;
                    } else {
                        self.push_text(&word, LetterStyle::default());
                        at = end.max(at + 1);
                    }
                }
                '{' | '}' => at += 1,
                letter => {
                    let barred = letters.get(at + 1).is_some_and(|next| is_macron(*next));
                    self.push_letters(&[letter], ScriptLevel::Base, barred);
                    at += 1;
                }
            }
        }
    }

    fn push_letters(&mut self, letters: &[char], level: ScriptLevel, barred: bool) {
        let mut level = level;
        let usual = level;
        for &letter in letters.iter().filter(|letter| !is_macron(**letter)) {
            if letter == '_' && usual == ScriptLevel::Raised {
                level = ScriptLevel::RaisedLowered;
                continue;
            }
            let italic =
                matches!(level, ScriptLevel::Base | ScriptLevel::Raised) && is_slanted(letter);
            let printed = if letter == '-' { '\u{2212}' } else { letter };
            self.push_text(printed.encode_utf8(&mut [0; 4]), LetterStyle { italic, barred, level });
            level = usual;
        }
    }
}

/// The letters of `{…}`, or the one letter at `at`, and the index after them.
fn group(letters: &[char], at: usize) -> (Vec<char>, usize) {
    match letters.get(at) {
        Some('{') => {
            let length = letters[at..].iter().position(|letter| *letter == '}');
            let end = length.map_or(letters.len(), |length| at + length);
            (letters[at + 1..end].to_vec(), (end + 1).min(letters.len()))
        }
        Some(letter) => (vec![*letter], at + 1),
        None => (Vec::new(), at),
    }
}

fn word_end(letters: &[char], at: usize) -> usize {
    let length = letters[at..].iter().take_while(|letter| letter.is_ascii_alphabetic()).count();
    at + length
}

fn is_macron(letter: char) -> bool {
    matches!(letter, '\u{304}' | '\u{305}')
}

/// Whether a symbol prints in italics: Latin letters and lower-case Greek.
fn is_slanted(letter: char) -> bool {
    letter.is_ascii_alphabetic()
        || ('α'..='ω').contains(&letter)
        || matches!(letter, 'ϕ' | 'ϵ' | 'ϑ')
}

/// Breaks a text into labels no wider than `room` pixels, at spaces outside `$…$`.
///
/// A single word that is wider gets a line of its own.
pub(super) fn wrap(source: &str, size: f64, bold: bool, room: f64) -> Vec<RichText> {
    let mut lines: Vec<String> = Vec::new();
    for paragraph in source.lines() {
        let mut line = String::new();
        let mut symbols = false;
        let words = paragraph.split(|letter: char| {
            symbols ^= letter == '$';
            letter == ' ' && !symbols
        });
        for word in words {
            let longer = if line.is_empty() { word.to_string() } else { format!("{line} {word}") };
            if line.is_empty() || RichText::parse(&longer).width(size, bold) <= room {
                line = longer;
            } else {
                lines.push(std::mem::replace(&mut line, word.to_string()));
            }
        }
        lines.push(line);
    }
    lines.iter().map(|line| RichText::parse(line)).collect()
}

/// Formats a number for an axis: with a minus sign, and never as minus zero.
pub(super) fn number(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    match text.strip_prefix('-') {
        Some(digits) if digits.chars().any(|digit| ('1'..='9').contains(&digit)) => {
            format!("\u{2212}{digits}")
        }
        Some(digits) => digits.to_string(),
        None => text,
    }
}

#[cfg(test)]
mod tests {
    use super::super::tspan::BAR;
    use super::*;

    fn runs_of(source: &str) -> Vec<(String, LetterStyle)> {
        RichText::parse(source).runs.into_iter().map(|run| (run.text, run.look)).collect()
    }

    #[test]
    fn symbols_are_italic_and_subscripts_upright() {
        let runs = runs_of("slip velocity $v_r$ (m/s)");
        let italic = LetterStyle { italic: true, ..LetterStyle::default() };
        let lowered = LetterStyle { level: ScriptLevel::Lowered, ..LetterStyle::default() };
        assert_eq!(
            runs,
            vec![
                ("slip velocity ".into(), LetterStyle::default()),
                ("v".into(), italic),
                ("r".into(), lowered),
                (" (m/s)".into(), LetterStyle::default()),
            ]
        );
    }

    #[test]
    fn both_notations_of_a_bar_are_equivalent() {
        assert_eq!(runs_of("$\\bar{μ}(v)$"), runs_of("$μ\u{304}(v)$"));
        assert!(runs_of("$\\bar{μ}$")[0].1.barred);
    }

    #[test]
    fn a_bar_does_not_change_the_width() {
        let (plain, barred) = (RichText::parse("$μ(v)$"), RichText::parse("$\\bar{μ}(v)$"));
        assert_eq!(plain.width(10.0, false), barred.width(10.0, false));
        let svg = barred.svg();
        let moves: f64 = svg
            .split("dx=\"")
            .skip(1)
            .filter_map(|rest| rest.split("em").next()?.parse::<f64>().ok())
            .sum();
        assert!((moves + fonts::width(BAR, Face::Regular)).abs() < 2e-3, "{svg}");
    }

    #[test]
    fn an_unpaired_dollar_is_printed_literally() {
        assert_eq!(runs_of("5 $ each"), vec![("5 $ each".into(), LetterStyle::default())]);
        assert_eq!(RichText::parse("5 $ each").svg(), "5 $ each");
    }

    #[test]
    fn private_use_characters_of_a_label_are_removed() {
        assert_eq!(RichText::parse("a\u{E000}b\u{F8FF}\u{1}").svg(), "ab ");
    }

    #[test]
    fn the_baseline_shift_is_undone_after_a_subscript() {
        let svg = RichText::parse("$x_1y$").svg();
        assert!(svg.contains("dy=\"0.250em\"") && svg.contains("dy=\"-0.200em\""), "{svg}");
        assert_eq!(svg.matches("<tspan").count(), svg.matches("</tspan>").count());
    }

    #[test]
    fn lines_break_at_spaces_outside_symbols() {
        let lines = wrap("aaaa bbbb $x + y$", 10.0, false, 60.0);
        assert_eq!(lines, vec![RichText::parse("aaaa bbbb"), RichText::parse("$x + y$")]);
    }

    #[test]
    fn plain_text_keeps_subscripts_and_bars() {
        let plain = |source: &str| RichText::parse(source).plain();
        assert_eq!(
            plain("slip $v_m$ = 0.2, $\\bar{μ}$ at $10^{-4}$"),
            "slip v_m = 0.2, μ\u{304} at 10^\u{2212}4"
        );
    }

    #[test]
    fn numbers_have_a_minus_sign_but_no_minus_zero() {
        assert_eq!(number(-0.25, 2), "\u{2212}0.25");
        assert_eq!(number(-0.0001, 2), "0.00");
    }
}
