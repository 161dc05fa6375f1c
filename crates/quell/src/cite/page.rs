//! The bibliography as a page of the book: every entry of `references.bib`, by author.

use std::fmt::Write as _;

use super::bibliography::BIBLIOGRAPHY;

const OPENING: &str = "\
# Sources

The complete bibliographic data are in `references.bib` of the repository, from which this page is made. `quell cite STUDY.toml` lists \
the sources of an answer.
";

/// Letters as BibTeX writes them.
const LETTERS: [(&str, &str); 12] = [
    (r"{\'e}", "é"),
    (r"{\'o}", "ó"),
    (r"{\'a}", "á"),
    (r#"{\"o}"#, "ö"),
    (r#"{\"u}"#, "ü"),
    (r#"{\"U}"#, "Ü"),
    (r"{\`A}", "À"),
    (r"{\AA}", "Å"),
    (r"{\o}", "ø"),
    (r"\&", "&"),
    ("--", "–"),
    ("~", " "),
];

/// The page as Markdown.
pub fn markdown() -> String {
    let mut lines: Vec<String> = BIBLIOGRAPHY.split("\n@").skip(1).map(line).collect();
    lines.sort_by_key(|line| line.to_lowercase());
    let mut page = OPENING.to_owned() + "\n";
    for line in &lines {
        let _ = writeln!(page, "* {line}");
    }
    page
}

/// One entry as a line.
fn line(entry: &str) -> String {
    let field = |name: &str| field(entry, name);
    let authors = field("author").unwrap_or_default().replace(" and ", "; ");
    let mut text = format!(
        "{authors} ({}). *{}*",
        field("year").unwrap_or_default(),
        field("title").unwrap_or_default()
    );
    let mut part = |words: String| {
        text.push_str(". ");
        text.push_str(&words);
    };
    if let Some(edition) = field("edition") {
        part(format!("{} edition", ordinal(&edition)));
    }
    if let Some(journal) = field("journal").or_else(|| field("booktitle")) {
        let volume = field("volume").map_or_else(String::new, |volume| format!(" {volume}"));
        let number = field("number").map_or_else(String::new, |number| format!("({number})"));
        let pages = field("pages").map_or_else(String::new, |pages| format!(", {pages}"));
        part(format!("{journal}{volume}{number}{pages}"));
    }
    let house = ["publisher", "school", "institution", "howpublished"];
    if let Some(house) = house.into_iter().find_map(field) {
        let place = field("address").map_or_else(String::new, |place| format!(", {place}"));
        part(format!("{house}{place}"));
    }
    if !entry.contains("journal")
        && let Some(number) = field("number")
    {
        part(number);
    }
    text + "."
}

/// Value of a field, which is on one line of its own.
fn field(entry: &str, name: &str) -> Option<String> {
    let line = entry.lines().find(|line| {
        line.trim_start().strip_prefix(name).is_some_and(|rest| rest.trim_start().starts_with('='))
    })?;
    let (_, value) = line.split_once('{')?;
    let value = value.trim_end().trim_end_matches(',').strip_suffix('}')?;
    let plain = LETTERS
        .iter()
        .fold(value.to_owned(), |text, (written, letter)| text.replace(written, letter));
    Some(plain.replace(['{', '}'], ""))
}

fn ordinal(number: &str) -> String {
    let ending = match number {
        "1" => "st",
        "2" => "nd",
        "3" => "rd",
        _ => "th",
    };
    format!("{number}{ending}")
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
