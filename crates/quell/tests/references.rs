//! Sources that `quell cite` prints are in `references.bib`, with the same title and year.

use std::path::Path;

use quell::cite::SOURCES;
use quell::cite::bibliography::BIBLIOGRAPHY;

/// Fields of one entry: the text after `name = {`.
fn field<'a>(entry: &'a str, name: &str) -> Option<&'a str> {
    let line = entry.lines().find(|line| {
        line.trim_start().strip_prefix(name).is_some_and(|rest| rest.trim_start().starts_with('='))
    })?;
    let (_, value) = line.split_once('{')?;
    value.trim_end().strip_suffix("},")
}

fn bibliography() -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../references.bib");
    std::fs::read_to_string(path).expect("references.bib")
}

/// Entries with their keys.
fn entries(text: &str) -> Vec<(&str, &str)> {
    text.split("\n@")
        .skip(1)
        .filter_map(|entry| {
            let (_, rest) = entry.split_once('{')?;
            rest.split_once(',')
        })
        .collect()
}

#[test]
fn every_source_is_an_entry_with_its_title_and_year() {
    let text = bibliography();
    let entries = entries(&text);
    for source in SOURCES {
        let entry = entries.iter().find(|(key, _)| *key == source.key);
        let (_, entry) = entry.unwrap_or_else(|| panic!("{} is not in references.bib", source.key));
        let title = field(entry, "title").expect("a title");
        let title = title.replace(['{', '}'], "").replace("--", "–").to_lowercase();
        let printed = source.reference().to_lowercase();
        assert!(printed.contains(&title), "{}: {title}", source.key);
        let year = field(entry, "year").expect("a year");
        assert!(printed.contains(year) && source.key.ends_with(year), "{}: {year}", source.key);
    }
}

#[test]
fn keys_are_unique_and_entries_complete() {
    let text = bibliography();
    let entries = entries(&text);
    assert_eq!(entries.len(), text.matches("\n@").count(), "an entry that cannot be read");
    for (index, (key, entry)) in entries.iter().enumerate() {
        assert!(entries[..index].iter().all(|(other, _)| other != key), "{key} stands twice");
        for name in ["author", "title", "year"] {
            assert!(field(entry, name).is_some(), "{key} has no {name}");
        }
    }
}

/// The visible copy in the root is identical to the compiled-in file.
#[test]
fn the_copy_in_the_root_is_the_bibliography() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../references.bib");
    if std::env::var_os("QUELL_BLESS").is_some() {
        std::fs::write(&path, BIBLIOGRAPHY).expect("written");
    }
    assert_eq!(bibliography(), BIBLIOGRAPHY, "QUELL_BLESS=1 writes the copy");
}
