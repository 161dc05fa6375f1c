//! The literature as BibTeX: `references.bib`, compiled in.
//!
//! The file in this folder is the original; a test compares the copy in the root of the repository with it.

/// Every entry, with comments between groups of them.
pub const BIBLIOGRAPHY: &str = include_str!("references.bib");

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

/// The entry of a key, from its `@` to its closing brace.
pub fn entry(key: &str) -> Option<&'static str> {
    let named = format!("{{{key},\n");
    let inside = BIBLIOGRAPHY.find(&named)?;
    let begin = BIBLIOGRAPHY[..inside].rfind('@')?;
    // An entry ends with the first closing brace at the beginning of a line.
    let end = begin + BIBLIOGRAPHY[begin..].find("\n}")? + 2;
    BIBLIOGRAPHY.get(begin..end)
}

/// An entry as a line of Markdown, such as "Harris, Fredric J. (1978). *On the use of …*. Proceedings of the IEEE 66(1), 51–83"
pub(super) fn line(entry: &str) -> String {
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
        let thesis = if entry.contains("phdthesis") { "PhD thesis, " } else { "" };
        part(format!("{thesis}{house}{place}"));
    }
    if !entry.contains("journal")
        && let Some(number) = field("number")
    {
        part(number);
    }
    text
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
    use crate::cite::SOURCES;

    #[test]
    fn every_source_has_its_entry() {
        for source in SOURCES {
            let entry = entry(source.key).unwrap_or_else(|| panic!("{}", source.key));
            assert!(entry.starts_with('@') && entry.ends_with("\n}"), "{entry}");
            assert!(entry.contains(&format!("{{{},\n", source.key)), "{entry}");
            assert_eq!(entry.matches('{').count(), entry.matches('}').count(), "{entry}");
            assert_eq!(entry.matches("\n@").count(), 0, "{entry}");
        }
        assert_eq!(entry("nobody1900"), None);
    }
}
