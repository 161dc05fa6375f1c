//! Rust code without comments, literals and tests. Spaces replace what is left out, so that offsets and lines are unchanged.

use std::collections::BTreeSet;

use super::lexer::{Language, PieceKind, pieces};

/// The code of a Rust text, with comments and literals blanked.
pub(crate) fn code(text: &str) -> String {
    let mut code = String::with_capacity(text.len());
    for piece in pieces(text, Language::Rust) {
        if piece.kind == PieceKind::Code {
            code += piece.text;
        } else {
            code += &blank(piece.text);
        }
    }
    code
}

/// The code of a Rust text as [`code`] returns it, with the items blanked that are compiled for tests alone.
pub(crate) fn production(text: &str) -> String {
    let mut code = code(text);
    let mut from = 0;
    while let Some(found) = next_test_attribute(&code[from..]) {
        let start = from + found;
        let end = start + item_length(&code[start..]);
        let blanked = blank(&code[start..end]);
        code.replace_range(start..end, &blanked);
        from = end;
    }
    code
}

/// Lines with code that is compiled for tests alone, counted from 1.
pub(crate) fn test_lines(text: &str) -> BTreeSet<usize> {
    let (code, production) = (code(text), production(text));
    let lines = code.lines().zip(production.lines()).enumerate();
    lines.filter(|(_, (all, left))| all != left).map(|(number, _)| number + 1).collect()
}

/// Spaces for every byte but the ends of lines.
fn blank(text: &str) -> String {
    text.bytes().map(|byte| if byte == b'\n' { '\n' } else { ' ' }).collect()
}

fn next_test_attribute(code: &str) -> Option<usize> {
    ["#[cfg(test)]", "#[cfg(all(test"].iter().filter_map(|attribute| code.find(attribute)).min()
}

/// The length of an item with its attributes: up to its first `;` or the end of its first block, outside of parentheses.
fn item_length(code: &str) -> usize {
    let (mut braces, mut others) = (0_usize, 0_usize);
    for (at, letter) in code.char_indices() {
        match letter {
            '(' | '[' => others += 1,
            ')' | ']' => others = others.saturating_sub(1),
            '{' => braces += 1,
            '}' => {
                braces = braces.saturating_sub(1);
                if braces == 0 && others == 0 {
                    return at + 1;
                }
            }
            ';' if braces == 0 && others == 0 => return at + 1,
            _ => {}
        }
    }
    code.len()
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;

    #[test]
    fn comments_and_literals_become_spaces() {
        let text = "let a = \"ö\"; // b\nc";
        assert_eq!(code(text), "let a =     ;     \nc");
        assert_eq!(code(text).len(), text.len());
    }

    /// An error in the division into literals and comments would leave a bracket unmatched.
    #[test]
    fn brackets_of_every_source_match() {
        let crates = Path::new(env!("CARGO_MANIFEST_DIR")).join("../crates");
        let files = crate::source::files(&crates).expect("sources");
        let mut count = 0;
        for path in files.iter().filter(|path| crate::source::has_extension(path, "rs")) {
            let text = crate::source::read(path).expect("a source");
            for code in [code(&text), production(&text)] {
                let mut open = Vec::new();
                for letter in code.chars() {
                    match letter {
                        '(' => open.push(')'),
                        '[' => open.push(']'),
                        '{' => open.push('}'),
                        ')' | ']' | '}' => assert_eq!(open.pop(), Some(letter), "{path:?}"),
                        _ => {}
                    }
                }
                assert!(open.is_empty(), "{path:?}");
            }
            count += 1;
        }
        assert!(count > 300);
    }

    #[test]
    fn items_for_tests_become_spaces() {
        let text = "use a;\n#[cfg(test)]\nuse b::{c, d};\n#[cfg(all(test, unix))]\n#[path = \"x\"]\n\
                    mod t {\n fn f() { g([1; 2]); }\n}\nuse e;\n\
                    #[cfg(test)]\nmod tests;\nuse h;";
        let left = production(text);
        assert_eq!(left.len(), text.len());
        assert_eq!(left.split_whitespace().collect::<Vec<_>>().join(" "), "use a; ; use e; use h;");
        assert_eq!(left.lines().count(), text.lines().count());
        let lines: Vec<usize> = test_lines(text).into_iter().collect();
        assert_eq!(lines, [2, 3, 4, 5, 6, 7, 8, 10, 11]);
    }
}
