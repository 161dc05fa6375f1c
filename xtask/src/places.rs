//! The places that the pages for developers name exist: a file that moved is noticed there.

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;
    use std::fs;
    use std::path::Path;

    /// Pages that say where things are.
    const PAGES: &[&str] = &[
        "ARCHITECTURE.md",
        "CONTRIBUTING.md",
        "docs/decisions.md",
        "docs/places.md",
        "docs/book/src/howto/extend.md",
    ];

    /// Folders whose names begin a place.
    const TOP: &[&str] = &[
        "benches/",
        "crates/",
        "docs/",
        "fuzz/",
        "python/",
        "quell",
        "reference/",
        "studies/",
        "xtask/",
    ];

    /// Ends of the names of files.
    const FILES: &[&str] = &[".bib", ".md", ".py", ".rs", ".toml"];

    /// Words in capitals or with a letter for a number: patterns of names, not names.
    const PATTERNS: &[&str] = &["VERB", "-N."];

    fn root() -> &'static Path {
        Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("a workspace")
    }

    /// Every file and folder below one, as a path from the root that begins with a slash.
    fn collect(folder: &Path, path: &str, found: &mut BTreeSet<String>) {
        for entry in fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry")) {
            let name = entry.file_name().to_string_lossy().into_owned();
            if name.starts_with('.') || name == "target" {
                continue;
            }
            let path = format!("{path}/{name}");
            if entry.path().is_dir() {
                collect(&entry.path(), &path, found);
            }
            found.insert(path);
        }
    }

    /// `a/{b,c}.rs` as `a/b.rs` and `a/c.rs`.
    fn expanded(text: &str) -> Vec<String> {
        let Some((before, rest)) = text.split_once('{') else { return vec![text.to_owned()] };
        let Some((each, after)) = rest.split_once('}') else { return vec![text.to_owned()] };
        let names = each.split(',').map(|name| format!("{before}{}{after}", name.trim()));
        names.flat_map(|text| expanded(&text)).collect()
    }

    fn is_place(text: &str) -> bool {
        let is_plain = text.chars().all(|c| c.is_alphanumeric() || "_./{},-".contains(c));
        let is_file = FILES.iter().any(|end| text.ends_with(end));
        let is_below = text.contains('/') && TOP.iter().any(|top| text.starts_with(top));
        is_plain && (is_file || is_below) && !PATTERNS.iter().any(|part| text.contains(part))
    }

    /// The names of files and folders in a line, between backticks.
    fn places(line: &str) -> impl Iterator<Item = String> {
        let named = line.split('`').skip(1).step_by(2);
        let named = named.map(|text| text.split(':').next().unwrap_or(text).trim_end_matches('/'));
        named.filter(|text| is_place(text)).flat_map(expanded).collect::<Vec<_>>().into_iter()
    }

    #[test]
    fn every_place_that_a_page_names_exists() {
        let mut all = BTreeSet::new();
        collect(root(), "", &mut all);
        let mut count = 0;
        for page in PAGES {
            let text = fs::read_to_string(root().join(page)).expect("a page");
            for (number, line) in text.lines().enumerate() {
                for place in places(line) {
                    count += 1;
                    let exists = all.iter().any(|path| path.ends_with(&format!("/{place}")));
                    assert!(exists, "{page}, line {}: `{place}` does not exist", number + 1);
                }
            }
        }
        assert!(count > 200, "only {count} places were found: the pages are read wrongly");
    }

    #[test]
    fn names_in_braces_are_several_places() {
        let found: Vec<String> =
            places("| `quell-study/src/{model,template}.rs: at` | `at` |").collect();
        assert_eq!(found, ["quell-study/src/model.rs", "quell-study/src/template.rs"]);
    }
}
