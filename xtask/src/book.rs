//! `cargo xtask book`: builds the book as a site in `target/book`, with pictures made by `quell reproduce`.
//!
//! Chapters are copied from `docs/book`; `quell reproduce` adds current pictures, the report and the table of claims; mdBook
//! builds the site.

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::programs::{cargo, command};

/// The folder of the pictures among the chapters.
const PICTURES: &str = "src/reproduction";

/// Builds the book.
///
/// # Errors
/// A command that failed or is missing, a file that cannot be copied.
pub(crate) fn run(root: &Path) -> Result<(), String> {
    let work = root.join("target/book-source");
    let site = fs::canonicalize(root).map_err(|why| why.to_string())?.join("target/book");
    if work.exists() {
        fs::remove_dir_all(&work).map_err(|why| format!("{}: {why}", work.display()))?;
    }
    copy(&root.join("docs/book"), &work)?;
    let quell = ["run", "--release", "--package", "quell-cli", "--", "reproduce", "--out"];
    let pictures = fs::canonicalize(&work).map_err(|why| why.to_string())?.join(PICTURES);
    command(cargo().args(quell).arg(&pictures).current_dir(root))?;
    let mut site_builder = Command::new("mdbook");
    site_builder.arg("build").arg(&work).arg("--dest-dir").arg(&site);
    command(site_builder.current_dir(root))
        .map_err(|why| format!("{why} (`cargo install mdbook` installs it)"))?;
    eprintln!("book: {}", site.join("index.html").display());
    Ok(())
}

/// Copies a folder.
fn copy(from: &Path, to: &Path) -> Result<(), String> {
    let failed = |path: &Path, why: std::io::Error| format!("{}: {why}", path.display());
    fs::create_dir_all(to).map_err(|why| failed(to, why))?;
    for file in fs::read_dir(from).map_err(|why| failed(from, why))? {
        let path: PathBuf = file.map_err(|why| failed(from, why))?.path();
        let Some(name) = path.file_name() else { continue };
        let target = to.join(name);
        if path.is_dir() {
            copy(&path, &target)?;
        } else if path.extension().is_some_and(|extension| extension == "md") {
            let text = fs::read_to_string(&path).map_err(|why| failed(&path, why))?;
            fs::write(&target, typeset(&inward(&text))).map_err(|why| failed(&target, why))?;
        } else {
            fs::copy(&path, &target).map_err(|why| failed(&path, why))?;
        }
    }
    Ok(())
}

/// Replaces links to files of the repository by their text: the site does not contain these files.
fn inward(page: &str) -> String {
    let mut inward = String::new();
    let mut rest = page;
    while let Some((before, after)) = rest.split_once("](") {
        let (target, end) = after.split_once(')').unwrap_or((after, ""));
        let outward = target.starts_with("../") && target.contains("crates/");
        match before.rfind('[') {
            Some(open) if outward => {
                inward += &before[..open];
                inward += &before[open + 1..];
            }
            _ => {
                inward += before;
                inward += "](";
                inward += target;
                inward.push(')');
            }
        }
        rest = end;
    }
    inward + rest
}

/// Sets subscripts and superscripts, as in `v_m` and `e^{γ−w}`; code and links are left as they are.
fn typeset(page: &str) -> String {
    let mut fenced = false;
    let mut typeset = String::new();
    for line in page.lines() {
        fenced ^= line.starts_with("```");
        if fenced || line.starts_with("    ") || line.starts_with("```") {
            typeset += line;
        } else {
            for (index, piece) in line.split('`').enumerate() {
                if index > 0 {
                    typeset.push('`');
                }
                typeset += &if index % 2 == 1 { piece.to_owned() } else { symbols(piece) };
            }
        }
        typeset.push('\n');
    }
    typeset
}

/// Sets subscripts and superscripts of a text. A single letter before an underscore is a symbol; a longer word is a name.
fn symbols(text: &str) -> String {
    let letters: Vec<char> = text.chars().collect();
    let mut typeset = String::new();
    let mut at = 0;
    while at < letters.len() {
        let letter = |back: usize| at.checked_sub(back).map(|index| letters[index]);
        let symbol = letter(1)
            .is_some_and(|x| x == '∂' || x.is_alphabetic() && !x.is_ascii_alphabetic())
            || letter(1).is_some_and(|x| x.is_ascii_alphabetic())
                && !letter(2).is_some_and(|x| x.is_ascii_alphabetic());
        let tag = match letters[at] {
            '_' if symbol => "sub",
            '^' => "sup",
            _ => "",
        };
        let (inner, length) =
            if tag.is_empty() { (String::new(), 0) } else { group(&letters[at + 1..]) };
        if inner.is_empty() {
            typeset.push(letters[at]);
        } else {
            let _ = write!(typeset, "<{tag}>{}</{tag}>", symbols(&inner));
        }
        at += 1 + length;
    }
    typeset
}

/// The subscript or superscript at the beginning of `letters`, and the number of characters it takes.
fn group(letters: &[char]) -> (String, usize) {
    let close = match letters.first() {
        Some('{') => '}',
        Some('(') => ')',
        Some(letter) if letter.is_alphabetic() && !letter.is_ascii() => {
            return (letter.to_string(), 1);
        }
        _ => {
            let count = letters.iter().take_while(|letter| letter.is_ascii_alphanumeric()).count();
            return (letters[..count].iter().collect(), count);
        }
    };
    let end = letters.iter().position(|letter| *letter == close).unwrap_or(letters.len() - 1);
    (letters[1..end].iter().collect(), end + 1)
}

#[cfg(test)]
mod tests {
    use super::{inward, typeset};

    #[test]
    fn links_out_of_the_book_become_words() {
        assert_eq!(
            inward(
                "| [a_test](../../../crates/q/tests/e.rs) | [x](theory/y.md) | ![p](../r/f.svg)\n"
            ),
            "| a_test | [x](theory/y.md) | ![p](../r/f.svg)\n"
        );
    }

    #[test]
    fn symbols_are_typeset_and_names_are_not() {
        assert_eq!(typeset("αG_max, 2v_mζ\n"), "αG<sub>max</sub>, 2v<sub>m</sub>ζ\n");
        assert_eq!(
            typeset("∂_θ²φ, e^(i w_j τ)\n"),
            "∂<sub>θ</sub>²φ, e<sup>i w<sub>j</sub> τ</sup>\n"
        );
        assert_eq!(
            typeset("e^{γ−w}, α^L, e^(−w)\n"),
            "e<sup>γ−w</sup>, α<sup>L</sup>, e<sup>−w</sup>\n"
        );
        let untouched = "`v_m` and [sign_test_name](crates/quell_b.rs)\n```sh\nx_y\n```\n    v_m\n";
        assert_eq!(typeset(untouched), untouched);
    }
}
