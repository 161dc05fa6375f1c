//! The prose of a file as a sequence of words: comments and string literals of source files, the text of Markdown.

use std::path::Path;

use crate::source::{self, Language, PieceKind, SourcePiece};

/// A word of prose.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Word {
    /// Its small letters.
    pub(super) text: String,
    /// Its line, counted from 1.
    pub(super) line: usize,
    /// Whether a phrase can continue after it: neither punctuation nor the end of the text follows.
    pub(super) continues: bool,
}

/// The words of a file; an empty list for a kind of file without prose.
pub(super) fn words(path: &Path, text: &str) -> Vec<Word> {
    let mut prose = Prose::default();
    match path.extension().and_then(|extension| extension.to_str()).unwrap_or_default() {
        "md" => prose.markdown(text),
        "rs" => prose.source(text, Language::Rust),
        "py" | "pyi" | "toml" => prose.source(text, Language::Hash),
        "ipynb" => prose.notebook(text),
        _ => {}
    }
    prose.words
}

/// Prose as it is collected.
#[derive(Default)]
struct Prose {
    words: Vec<Word>,
    /// Whether the current line is within a code fence.
    fenced: bool,
    /// Whether the current text is within backticks.
    quoted: bool,
}

impl Prose {
    /// The paragraphs of a page, without the section of a past release, whose text is final.
    fn markdown(&mut self, text: &str) {
        let mut released = false;
        for (number, line) in text.lines().enumerate() {
            if line.starts_with("## ") && !self.fenced {
                released = line.starts_with("## [0.1.0]");
            }
            if !released {
                self.line(line, number + 1);
            }
        }
        self.end();
    }

    /// Comments and string literals of a source file. Comments on consecutive lines are one text.
    fn source(&mut self, text: &str, language: Language) {
        let mut line = 1;
        let mut before = PieceKind::Code;
        for SourcePiece { kind, text, .. } in source::pieces(text, language) {
            let lines = text.matches('\n').count();
            let blank = kind == PieceKind::Code && text.trim().is_empty();
            let goes_on =
                kind == PieceKind::Comment && before == PieceKind::Comment || blank && lines < 2;
            if !goes_on {
                self.end();
            }
            match kind {
                PieceKind::Comment => {
                    let marks = |letter: char| matches!(letter, '/' | '*' | '!' | '#');
                    for (below, text) in text.lines().enumerate() {
                        self.line(text.trim_start().trim_start_matches(marks), line + below);
                    }
                }
                // A literal without white space is a key, a name or a path.
                PieceKind::Literal if text.contains(char::is_whitespace) => {
                    let escapes = ["\\n", "\\t", "\\"];
                    for (below, text) in text.lines().enumerate() {
                        let plain = escapes
                            .iter()
                            .fold(text.to_owned(), |text, escape| text.replace(escape, " "));
                        self.line(&plain, line + below);
                    }
                }
                PieceKind::Literal | PieceKind::Code => {}
            }
            if !blank {
                before = kind;
            }
            line += lines;
        }
        self.end();
    }

    /// The sources of the cells of a notebook, whose lines are JSON strings on lines of their own. Results of cells are skipped.
    fn notebook(&mut self, text: &str) {
        let mut within = false;
        for (number, line) in text.lines().enumerate() {
            let line = line.trim();
            if line == "\"source\": [" {
                within = true;
            } else if line.trim_end_matches(',') == "]" {
                within = false;
                self.end();
            } else if within {
                let text = line.trim_end_matches(',').trim_matches('"');
                self.line(&text.replace("\\n", " "), number + 1);
            }
        }
    }

    /// One line of prose.
    fn line(&mut self, line: &str, number: usize) {
        let trimmed = line.trim();
        if trimmed.starts_with("```") {
            self.fenced = !self.fenced;
            self.stop();
            return;
        }
        if self.fenced || trimmed.starts_with(">>> ") {
            return;
        }
        if trimmed.is_empty() {
            self.quoted = false;
            self.stop();
        }
        let breaks = |letter: char| {
            letter.is_whitespace() || matches!(letter, '–' | '—' | '…' | '|' | '"' | '`')
        };
        for piece in readable(line, &mut self.quoted).split(breaks) {
            self.word(piece, number);
        }
    }

    fn word(&mut self, piece: &str, line: usize) {
        let punctuation = |letter: char| !letter.is_alphanumeric();
        // A word that begins with a dash is an option of a command line.
        let text = piece
            .trim_end_matches(punctuation)
            .trim_start_matches(|letter| letter != '-' && punctuation(letter));
        if text.is_empty() {
            if !piece.is_empty() {
                self.stop();
            }
            return;
        }
        if piece.starts_with(['(', '[']) {
            self.stop();
        }
        let continues = !piece.ends_with(['.', ',', ';', ':', '!', '?', ')', ']']);
        self.words.push(Word { text: text.to_lowercase().replace('’', "'"), line, continues });
    }

    /// Ends a phrase.
    fn stop(&mut self) {
        if let Some(word) = self.words.last_mut() {
            word.continues = false;
        }
    }

    /// Ends a text.
    fn end(&mut self) {
        self.stop();
        self.fenced = false;
        self.quoted = false;
    }
}

/// A line without code in backticks, link targets and names in braces. A sign replaces code and names, so that phrases end there.
fn readable(line: &str, quoted: &mut bool) -> String {
    let mut readable = String::new();
    let mut rest = line;
    while let Some(first) = rest.chars().next() {
        let mut length = first.len_utf8();
        if first == '`' {
            *quoted = !*quoted;
            readable += " ; ";
        } else if *quoted {
            // Code is skipped.
        } else if rest.starts_with("](") {
            length = rest.find(')').map_or(length, |end| end + 1);
            readable += " ";
        } else if let Some(end) = braced_name(rest) {
            length = end;
            readable += " ; ";
        } else {
            readable.push(first);
        }
        rest = &rest[length..];
    }
    readable
}

/// The length of `{name}` or `{name:format}` at the beginning of a text.
fn braced_name(text: &str) -> Option<usize> {
    let end = text.strip_prefix('{')?.find('}')? + 2;
    (!text[..end].contains(char::is_whitespace)).then_some(end)
}
