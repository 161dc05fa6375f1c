//! Counts of what should not exist and still does. A count may only fall: the check fails when one grows, and also when one has
//! fallen and the file of counts still allows the larger number.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::Path;

use toml::{Table, Value};

/// Counts by crate, folder or name. A missing key is zero.
pub(crate) type Counts = BTreeMap<String, usize>;

/// What a check does with the counts that it finds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum RatchetMode {
    /// It compares them with those allowed.
    Check,
    /// It records those that have fallen, then compares.
    Bless,
    /// It prints what it counts, then compares.
    List,
}

impl RatchetMode {
    /// From the option of the command line; `None` for any other.
    pub(crate) fn from_option(option: Option<&str>) -> Option<Self> {
        match option {
            None => Some(Self::Check),
            Some("--bless") => Some(Self::Bless),
            Some("--list") => Some(Self::List),
            Some(_) => None,
        }
    }
}

/// A file with the counts that a check allows.
pub(crate) struct Ratchet {
    /// The check, as `cargo xtask` names it.
    pub(crate) check: &'static str,
    /// Its file, relative to the root of the workspace.
    pub(crate) file: &'static str,
    /// What is counted, for the head of the file.
    pub(crate) counted: &'static str,
}

impl Ratchet {
    /// Compares counts with those allowed. A missing file allows nothing; `Bless` creates it with all counts.
    ///
    /// # Errors
    /// Each count that differs from the one allowed, with `describe` of each key that grew; a file that cannot be read or
    /// written.
    pub(crate) fn check(
        &self,
        root: &Path,
        found: &Counts,
        mode: RatchetMode,
        describe: impl Fn(&str) -> String,
    ) -> Result<(), String> {
        if mode == RatchetMode::List {
            for (key, count) in found {
                print!("  {key}: {count}\n{}", describe(key));
            }
        }
        let path = root.join(self.file);
        let bless = mode == RatchetMode::Bless;
        let mut allowed = if path.exists() {
            parse(&crate::source::read(&path)?).map_err(|why| format!("{}: {why}", self.file))?
        } else if bless {
            found.clone()
        } else {
            Counts::new()
        };
        if bless {
            allowed = lowered(&allowed, found);
            std::fs::write(&path, self.text(&allowed))
                .map_err(|why| format!("{}: {why}", path.display()))?;
        }
        let complaints = complaints(&allowed, found, describe);
        if complaints.is_empty() {
            return Ok(());
        }
        Err(format!(
            "{check}: counts differ from {file}\n{complaints}\
             `cargo xtask {check} --bless` records counts that have fallen; where one has grown, correct the source",
            check = self.check,
            file = self.file,
        ))
    }

    /// The file of counts.
    fn text(&self, counts: &Counts) -> String {
        let mut text = format!(
            "# {}\n# Written by `cargo xtask {} --bless`, which lowers counts and never raises one.\n",
            self.counted, self.check
        );
        for (key, count) in counts {
            let _ = writeln!(text, "{} = {count}", Value::String(key.clone()));
        }
        text
    }
}

/// Counts from the text of a file.
fn parse(text: &str) -> Result<Counts, String> {
    let table: Table = text.parse().map_err(|why| format!("{why}"))?;
    let count = |value: &Value| value.as_integer().and_then(|count| usize::try_from(count).ok());
    table
        .iter()
        .map(|(key, value)| {
            let count = count(value).filter(|count| *count > 0);
            Ok((key.clone(), count.ok_or_else(|| format!("{key}: expected a count above 0"))?))
        })
        .collect()
}

/// Allowed counts, with those that have fallen replaced by what was found.
fn lowered(allowed: &Counts, found: &Counts) -> Counts {
    allowed
        .iter()
        .map(|(key, count)| (key.clone(), *count.min(found.get(key).unwrap_or(&0))))
        .filter(|(_, count)| *count > 0)
        .collect()
}

/// One line for each key whose counts differ, followed by the description of those that grew.
fn complaints(allowed: &Counts, found: &Counts, describe: impl Fn(&str) -> String) -> String {
    let mut text = String::new();
    let mut keys: Vec<&String> = allowed.keys().chain(found.keys()).collect();
    keys.sort();
    keys.dedup();
    for key in keys {
        let (allowed, found) =
            (allowed.get(key).copied().unwrap_or(0), found.get(key).copied().unwrap_or(0));
        if found != allowed {
            let _ = writeln!(text, "  {key}: found {found}, allowed {allowed}");
        }
        if found > allowed {
            text += &describe(key);
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    fn counts(entries: &[(&str, usize)]) -> Counts {
        entries.iter().map(|(key, count)| ((*key).to_owned(), *count)).collect()
    }

    #[test]
    fn grown_and_fallen_counts_are_reported() {
        let allowed = counts(&[("equal", 2), ("fallen", 3), ("grown", 1)]);
        let found = counts(&[("equal", 2), ("fallen", 1), ("grown", 2), ("new", 1)]);
        let text = complaints(&allowed, &found, |key| format!("    <{key}>\n"));
        assert_eq!(
            text,
            "  fallen: found 1, allowed 3\n  grown: found 2, allowed 1\n    <grown>\n  new: found 1, allowed 0\n    <new>\n"
        );
        assert_eq!(complaints(&found, &found, |_| String::new()), "");
    }

    #[test]
    fn blessing_lowers_and_never_raises() {
        let allowed = counts(&[("fallen", 3), ("gone", 1), ("grown", 1)]);
        let found = counts(&[("fallen", 2), ("grown", 5), ("new", 1)]);
        assert_eq!(lowered(&allowed, &found), counts(&[("fallen", 2), ("grown", 1)]));
    }

    #[test]
    fn a_file_of_counts_is_read_back() {
        let ratchet = Ratchet { check: "x", file: "x.toml", counted: "Things." };
        let all = counts(&[("Name", 2), ("crates/a", 1)]);
        assert_eq!(parse(&ratchet.text(&all)), Ok(all));
        assert!(parse("a = 0").is_err_and(|why| why.contains("a: expected")));
        assert!(parse("a = \"many\"").is_err());
    }

    #[test]
    fn a_folder_is_checked_and_blessed() {
        let root = std::env::temp_dir().join(format!("quell-ratchet-{}", std::process::id()));
        std::fs::create_dir_all(&root).expect("a folder");
        let ratchet = Ratchet { check: "x", file: "x.toml", counted: "Things." };
        let check = |count: usize, mode: RatchetMode| {
            ratchet.check(&root, &counts(&[("a", count)]), mode, |_| String::new())
        };
        assert!(check(2, RatchetMode::Check).is_err());
        assert_eq!(check(2, RatchetMode::Bless), Ok(()));
        assert_eq!(check(2, RatchetMode::Check), Ok(()));
        assert!(
            check(1, RatchetMode::Check).is_err_and(|why| why.contains("a: found 1, allowed 2"))
        );
        assert!(
            check(3, RatchetMode::Bless).is_err_and(|why| why.contains("a: found 3, allowed 2"))
        );
        assert_eq!(check(1, RatchetMode::Bless), Ok(()));
        assert!(check(2, RatchetMode::Check).is_err());
        std::fs::remove_dir_all(&root).expect("removed");
    }
}
