//! The bibliography as a page of the book: every entry of `references.bib`, by author.

use std::fmt::Write as _;

use super::bibliography::{BIBLIOGRAPHY, line};

const OPENING: &str = "\
# Sources

The complete bibliographic data are in `references.bib` of the repository, from which this page is made. `quell cite STUDY.toml` lists \
the sources of an answer.
";

/// The page as Markdown.
pub fn markdown() -> String {
    let mut lines: Vec<String> = BIBLIOGRAPHY.split("\n@").skip(1).map(line).collect();
    lines.sort_by_key(|line| line.to_lowercase());
    let mut page = OPENING.to_owned() + "\n";
    for line in &lines {
        let _ = writeln!(page, "* {line}.");
    }
    page
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_entry_is_a_line_without_marks_of_bibtex() {
        let page = markdown();
        assert_eq!(page.matches("\n* ").count(), BIBLIOGRAPHY.matches("\n@").count());
        assert!(!page.contains(['{', '}', '\\']), "{page}");
        assert!(page.contains("Den Hartog, J. P. (1931). *Forced vibrations with combined Coulomb and viscous friction*. Transactions"));
        assert!(page.contains("3rd edition. Springer"));
    }
}
