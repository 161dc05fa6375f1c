//! Division of a source text into code, comments and literals, exact enough for any text that compiles.

/// What a piece of a text is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum PieceKind {
    /// Neither of the others.
    Code,
    /// A comment or doc comment, with its delimiters.
    Comment,
    /// A string or character literal, with its delimiters and without its prefix.
    Literal,
}

/// A piece of a source text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct SourcePiece<'a> {
    /// What it is.
    pub(crate) kind: PieceKind,
    /// Its text.
    pub(crate) text: &'a str,
    /// The byte at which it begins.
    pub(crate) start: usize,
}

/// How comments and literals are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Language {
    /// Rust.
    Rust,
    /// Comments from `#` to the end of the line; strings in single, double or triple quotes: Python and TOML.
    Hash,
}

/// All pieces of a text, in order and without gaps.
pub(crate) fn pieces(text: &str, language: Language) -> Vec<SourcePiece<'_>> {
    let mut pieces = Vec::new();
    let (mut begin, mut at) = (0, 0);
    while at < text.len() {
        let found = match language {
            Language::Rust => rust(text, at),
            Language::Hash => hash(&text[at..]),
        };
        let Some((kind, length)) = found else {
            at += text[at..].chars().next().map_or(1, char::len_utf8);
            continue;
        };
        if begin < at {
            pieces.push(SourcePiece {
                kind: PieceKind::Code,
                text: &text[begin..at],
                start: begin,
            });
        }
        pieces.push(SourcePiece { kind, text: &text[at..at + length], start: at });
        at += length;
        begin = at;
    }
    if begin < at {
        pieces.push(SourcePiece { kind: PieceKind::Code, text: &text[begin..at], start: begin });
    }
    pieces
}

/// The comment or literal of Rust that begins at `at`, and its length.
fn rust(text: &str, at: usize) -> Option<(PieceKind, usize)> {
    let rest = &text[at..];
    if rest.starts_with("//") {
        return Some((PieceKind::Comment, rest.find('\n').unwrap_or(rest.len())));
    }
    if rest.starts_with("/*") {
        return Some((PieceKind::Comment, block_comment(rest)));
    }
    let length = match rest.as_bytes()[0] {
        b'"' => quoted(rest, "\"", !text[..at].ends_with('r')),
        b'\'' => character(rest)?,
        b'#' => raw_string(text, at)?,
        _ => return None,
    };
    Some((PieceKind::Literal, length))
}

/// The length of a block comment, in which others may be nested.
fn block_comment(text: &str) -> usize {
    let (mut depth, mut at) = (0_usize, 0);
    while at < text.len() {
        let rest = &text.as_bytes()[at..];
        if rest.starts_with(b"/*") {
            depth += 1;
            at += 2;
        } else if rest.starts_with(b"*/") {
            depth -= 1;
            at += 2;
            if depth == 0 {
                return at;
            }
        } else {
            at += 1;
        }
    }
    text.len()
}

/// The length of a string that begins with a quote, up to the same quote.
fn quoted(text: &str, quote: &str, escapes: bool) -> usize {
    let bytes = text.as_bytes();
    let mut at = quote.len();
    while at < bytes.len() {
        if escapes && bytes[at] == b'\\' {
            at += 2;
        } else if bytes[at..].starts_with(quote.as_bytes()) {
            return at + quote.len();
        } else {
            at += 1;
        }
    }
    text.len()
}

/// The length of a character literal, or `None` for a lifetime.
fn character(text: &str) -> Option<usize> {
    let mut characters = text.char_indices().skip(1);
    let (_, first) = characters.next()?;
    if first == '\\' {
        return Some(quoted(text, "'", true));
    }
    let (close, quote) = characters.next()?;
    (quote == '\'' && first != '\'').then_some(close + 1)
}

/// The length of a raw string whose first `#` is at `at`.
fn raw_string(text: &str, at: usize) -> Option<usize> {
    let hashes = text.as_bytes()[at..].iter().take_while(|byte| **byte == b'#').count();
    let opened = text.as_bytes().get(at + hashes) == Some(&b'"');
    if !opened || !text[..at].ends_with('r') {
        return None;
    }
    let close = format!("\"{}", "#".repeat(hashes));
    let body = at + hashes + 1;
    let end = text[body..].find(&close).map_or(text.len(), |found| body + found + close.len());
    Some(end - at)
}

/// The comment or string of Python or TOML at the beginning of a text, and its length.
fn hash(text: &str) -> Option<(PieceKind, usize)> {
    if text.starts_with('#') {
        return Some((PieceKind::Comment, text.find('\n').unwrap_or(text.len())));
    }
    let quote = ["\"\"\"", "'''", "\"", "'"].into_iter().find(|quote| text.starts_with(quote))?;
    Some((PieceKind::Literal, quoted(text, quote, true)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(text: &str, language: Language, kind: PieceKind) -> Vec<&str> {
        let pieces = pieces(text, language);
        let whole: String = pieces.iter().map(|piece| piece.text).collect();
        assert_eq!(whole, text);
        assert!(pieces.iter().all(|piece| text[piece.start..].starts_with(piece.text)));
        pieces.into_iter().filter(|piece| piece.kind == kind).map(|piece| piece.text).collect()
    }

    #[test]
    fn rust_is_divided() {
        let text = "let a = \"x // \\\" y\"; // one\n/* two /* three */ */ fn f<'a>(b: &'a str) -> char { '\\'' }\n\
                    r#\"a \"quote\" b\"#; b\"bytes\"; let c = 'ö'; r\"\\\"; r#type /// é\n";
        assert_eq!(
            found(text, Language::Rust, PieceKind::Comment),
            ["// one", "/* two /* three */ */", "/// é"]
        );
        assert_eq!(
            found(text, Language::Rust, PieceKind::Literal),
            ["\"x // \\\" y\"", "'\\''", "#\"a \"quote\" b\"#", "\"bytes\"", "'ö'", "\"\\\""]
        );
    }

    #[test]
    fn python_and_toml_are_divided() {
        let text =
            "a = 'it\\'s' # one\ndef f():\n    \"\"\"Two # \"lines\"\n    here.\"\"\"\nb = \"#\"";
        assert_eq!(found(text, Language::Hash, PieceKind::Comment), ["# one"]);
        assert_eq!(
            found(text, Language::Hash, PieceKind::Literal),
            ["'it\\'s'", "\"\"\"Two # \"lines\"\n    here.\"\"\"", "\"#\""]
        );
    }

    #[test]
    fn unfinished_texts_end_with_the_text() {
        for text in ["\"open", "/* open", "r#\"open\"", "'", "b\"\\", "\"\"\"open"] {
            for language in [Language::Rust, Language::Hash] {
                let whole: String = pieces(text, language).iter().map(|piece| piece.text).collect();
                assert_eq!(whole, text);
            }
        }
    }
}
