//! The report of a measurement: shares by crate, and uncovered lines by file.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::Path;

use crate::source;

/// LineHits of a file with the number of times they ran.
type LineHits = BTreeMap<usize, u64>;

/// Covered and all lines of a crate.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Covered {
    covered: usize,
    all: usize,
}

/// LineHits of each measured file, by its path from the root of the workspace; those of tests are left out.
///
/// # Errors
/// A source file that cannot be read.
pub(super) fn files(lcov: &str, root: &Path) -> Result<BTreeMap<String, LineHits>, String> {
    let mut files = lines_of_files(lcov, root);
    for (file, lines) in &mut files {
        let tests = source::test_lines(&source::read(&root.join(file))?);
        lines.retain(|line, _| !tests.contains(line));
    }
    Ok(files)
}

/// LineHits of each measured file as lcov has them. A line that is in several records ran as often as in all of them together.
fn lines_of_files(lcov: &str, root: &Path) -> BTreeMap<String, LineHits> {
    let mut files: BTreeMap<String, LineHits> = BTreeMap::new();
    let mut file = None;
    for line in lcov.lines() {
        if let Some(path) = line.strip_prefix("SF:") {
            file = Some(source::relative(Path::new(path), root)).filter(|file| is_measured(file));
        } else if let (Some(rest), Some(file)) = (line.strip_prefix("DA:"), &file) {
            let mut numbers = rest.split(',').filter_map(|number| number.parse::<u64>().ok());
            if let (Some(number), Some(hits)) = (numbers.next(), numbers.next()) {
                let lines = files.entry(file.clone()).or_default();
                *lines.entry(usize::try_from(number).unwrap_or(0)).or_default() += hits;
            }
        }
    }
    files
}

/// Whether a file is a source of a crate, and none of its tests.
fn is_measured(file: &str) -> bool {
    let parts: Vec<&str> = file.split('/').collect();
    matches!(parts[..], ["crates", _, "src", ..])
        && !parts.iter().any(|part| matches!(*part, "tests" | "tests.rs"))
}

/// Crates with their shares, as Markdown.
pub(super) fn table(files: &BTreeMap<String, LineHits>) -> String {
    let mut crates: BTreeMap<&str, Covered> = BTreeMap::new();
    for (file, lines) in files {
        let name = file.split('/').nth(1).unwrap_or_default();
        for key in [name, "all"] {
            let share = crates.entry(key).or_default();
            share.all += lines.len();
            share.covered += lines.values().filter(|hits| **hits > 0).count();
        }
    }
    let mut text = "| crate | lines | covered | share |\n|---|---|---|---|\n".to_owned();
    for (name, Covered { covered, all }) in crates {
        let share = 100.0 * covered as f64 / all.max(1) as f64;
        let _ = writeln!(text, "| `{name}` | {all} | {covered} | {share:.1} % |");
    }
    text
}

/// `file: 3-7, 12`, the files with most uncovered lines first.
pub(super) fn uncovered(files: &BTreeMap<String, LineHits>) -> String {
    let mut rows: Vec<(usize, String)> = Vec::new();
    for (file, lines) in files {
        let missed: Vec<usize> =
            lines.iter().filter(|(_, hits)| **hits == 0).map(|(line, _)| *line).collect();
        let mut ranges: Vec<(usize, usize)> = Vec::new();
        for line in &missed {
            match ranges.last_mut() {
                Some((_, last)) if *last + 1 == *line => *last = *line,
                _ => ranges.push((*line, *line)),
            }
        }
        let words: Vec<String> = ranges
            .iter()
            .map(
                |(first, last)| {
                    if first == last { first.to_string() } else { format!("{first}-{last}") }
                },
            )
            .collect();
        if !missed.is_empty() {
            rows.push((missed.len(), format!("{file}: {}\n", words.join(", "))));
        }
    }
    rows.sort_by(|one, other| other.0.cmp(&one.0).then(one.1.cmp(&other.1)));
    rows.into_iter().map(|(_, row)| row).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_counted_by_crate_and_listed_by_file() {
        let lcov = "SF:/p/crates/a/src/x.rs\nDA:1,4\nDA:2,0\nDA:3,0\nDA:9,0\nend_of_record\n\
                    SF:/p/crates/b/src/y.rs\nDA:5,1\nend_of_record\n\
                    SF:/p/crates/b/src/y.rs\nDA:5,0\nDA:6,0\nDA:7,0\nend_of_record\n\
                    SF:/p/crates/a/src/x.rs\nDA:1,0\nend_of_record\n";
        let files = lines_of_files(lcov, Path::new("/p"));
        let table = table(&files);
        assert!(table.contains("| `a` | 4 | 1 | 25.0 % |"), "{table}");
        assert!(table.contains("| `all` | 7 | 2 | 28.6 % |"), "{table}");
        let list = "crates/a/src/x.rs: 2-3, 9\ncrates/b/src/y.rs: 6-7\n";
        assert_eq!(uncovered(&files), list);
    }

    #[test]
    fn only_sources_of_the_crates_are_measured() {
        for file in ["crates/a/src/lib.rs", "crates/a/src/b/mod.rs", "crates/a/src/protests.rs"] {
            assert!(is_measured(file), "{file}");
        }
        for file in [
            "crates/a/tests/b.rs",
            "crates/a/src/b/tests.rs",
            "crates/a/src/tests/b.rs",
            "crates/a/examples/b.rs",
            "xtask/src/main.rs",
            "/home/registry/libm/src/crates.rs",
        ] {
            assert!(!is_measured(file), "{file}");
        }
    }

    #[test]
    fn lines_of_tests_are_left_out() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
        let file = "crates/quell-numerics/src/roots.rs";
        let text = source::read(&root.join(file)).expect("a source");
        let tests = 1 + text.lines().position(|line| line == "#[cfg(test)]").expect("tests");
        let lcov = format!("SF:{file}\nDA:1,0\nDA:{},0\nend_of_record\n", tests + 2);
        let files = files(&lcov, &root).expect("a report");
        assert_eq!(files[file].keys().collect::<Vec<_>>(), [&1]);
    }
}
