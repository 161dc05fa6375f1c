//! The literature as BibTeX: `references.bib`, compiled in.
//!
//! The file in this folder is the original; a test compares the copy in the root of the repository with it.

/// Every entry, with comments between groups of them.
pub const BIBLIOGRAPHY: &str = include_str!("references.bib");

/// The entry of a key, from its `@` to its closing brace.
pub fn entry(key: &str) -> Option<&'static str> {
    let named = format!("{{{key},\n");
    let inside = BIBLIOGRAPHY.find(&named)?;
    let begin = BIBLIOGRAPHY[..inside].rfind('@')?;
    // An entry ends with the first closing brace at the beginning of a line.
    let end = begin + BIBLIOGRAPHY[begin..].find("\n}")? + 2;
    BIBLIOGRAPHY.get(begin..end)
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
