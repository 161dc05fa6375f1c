//! `cargo xtask names`: fails when two types of the workspace have the same name.
//!
//! Types are the structs, enums, unions, traits and type aliases at the top level of a file of `crates/*/src` or `xtask/src`,
//! tests left out, and those that the macro `reasons` of quell-verbs defines. Associated types and types inside of functions or inline
//! modules do not count.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::Path;

use crate::manifest;
use crate::ratchet::{Counts, Ratchet, RatchetMode};
use crate::source;

/// Definitions of each name that is not unique.
const RATCHET: Ratchet = Ratchet {
    check: "names",
    file: "xtask/names.toml",
    counted: "Types that share a name with another, with the number of their definitions.",
};

/// A name that is one idea, although several types have it.
struct OneIdea {
    name: &'static str,
    /// The folder where it may be defined any number of times.
    folder: &'static str,
    /// Why its types need no names of their own.
    #[expect(dead_code, reason = "an entry without a reason shall not compile")]
    reason: &'static str,
}

/// Names that are meant to be shared.
const SHARED: &[OneIdea] = &[OneIdea {
    name: "Arguments",
    folder: "crates/quell-cli/src/verbs/",
    reason: "what the command line passes to one verb; the verb is the module",
}];

/// Where a name is defined: path from the root, and line.
type Places = Vec<(String, usize)>;

/// Checks the types of the workspace at `root`.
///
/// # Errors
/// Names that more types share than allowed; counts that have fallen; a file that cannot be read.
pub(crate) fn run(root: &Path, mode: RatchetMode) -> Result<(), String> {
    let mut definitions = BTreeMap::new();
    for folder in manifest::folders_of_members(root)? {
        for path in source::files(&folder.join("src"))? {
            if source::has_extension(&path, "rs") {
                let text = source::read(&path)?;
                define(&mut definitions, &source::relative(&path, root), &text);
            }
        }
    }
    let count = definitions.len();
    let shared = shared(definitions);
    let counts: Counts = shared.iter().map(|(name, at)| (name.clone(), at.len())).collect();
    RATCHET.check(root, &counts, mode, |name| shared.get(name).map(shown).unwrap_or_default())?;
    eprintln!("names: {count} names of types, {} of them not unique", shared.len());
    Ok(())
}

/// Adds the types that a file defines.
fn define(definitions: &mut BTreeMap<String, Places>, path: &str, text: &str) {
    let mut in_reasons = false;
    for (number, line) in source::production(text).lines().enumerate() {
        in_reasons = if in_reasons { line != "}" } else { line == "reasons! {" };
        let line = if in_reasons { line.strip_prefix("    ").unwrap_or(line) } else { line };
        if let Some(name) = defined(line) {
            let places = definitions.entry(name.to_owned()).or_default();
            places.push((path.to_owned(), number + 1));
        }
    }
}

/// The name of the type that a line without indentation defines.
fn defined(line: &str) -> Option<&str> {
    let mut rest = line;
    if let Some(after) = rest.strip_prefix("pub") {
        rest = match after.strip_prefix('(') {
            Some(restricted) => restricted.split_once(')')?.1,
            None => after,
        };
        rest = rest.strip_prefix(' ')?;
    }
    rest = rest.strip_prefix("unsafe ").unwrap_or(rest);
    let (keyword, rest) = rest.split_once(' ')?;
    let end = rest.find(|letter: char| !letter.is_alphanumeric() && letter != '_');
    let name = &rest[..end.unwrap_or(rest.len())];
    let is_type = matches!(keyword, "struct" | "enum" | "union" | "trait" | "type");
    (is_type && !name.is_empty()).then_some(name)
}

/// Names defined twice or more, without those that are meant to be.
fn shared(definitions: BTreeMap<String, Places>) -> BTreeMap<String, Places> {
    definitions
        .into_iter()
        .filter(|(name, places)| {
            let idea = SHARED.iter().find(|idea| idea.name == name);
            let others = |path: &str| !idea.is_some_and(|idea| path.starts_with(idea.folder));
            let outside = places.iter().filter(|(path, _)| others(path)).count();
            places.len() > 1 && outside > 0
        })
        .collect()
}

fn shown(places: &Places) -> String {
    let mut text = String::new();
    for (path, line) in places {
        let _ = writeln!(text, "    {path}:{line}");
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The names that are not unique in files with these texts, with the lines of their definitions.
    fn found(files: &[(&str, &str)]) -> Vec<(String, Vec<usize>)> {
        let mut definitions = BTreeMap::new();
        for (path, text) in files {
            define(&mut definitions, path, text);
        }
        shared(definitions)
            .into_iter()
            .map(|(name, places)| (name, places.into_iter().map(|(_, line)| line).collect()))
            .collect()
    }

    #[test]
    fn shared_names_are_found_with_their_lines() {
        let first = "pub struct Shared<T>(T);\nenum Unique {}\n";
        let second = "\npub(crate) trait Shared: Sized {\n    type Item;\n}\ntype Item = u8;\npub(in crate::a) enum Third {}";
        assert_eq!(
            found(&[("a.rs", first), ("b.rs", second)]),
            [("Shared".to_owned(), vec![1, 2])]
        );
        let third = "pub unsafe trait Third {}\nunion Unique { a: u8 }";
        let names: Vec<String> = found(&[("a.rs", first), ("b.rs", second), ("c.rs", third)])
            .into_iter()
            .map(|(name, _)| name)
            .collect();
        assert_eq!(names, ["Shared", "Third", "Unique"]);
    }

    #[test]
    fn tests_comments_and_inner_types_do_not_count() {
        let text = "struct A;\n#[cfg(test)]\nmod tests {\nstruct A;\n}\n/*\nstruct A;\n*/\nfn f() {\n    struct A;\n}\n";
        assert_eq!(found(&[("a.rs", text)]), []);
    }

    #[test]
    fn reasons_of_a_macro_count() {
        let text = "reasons! {\n    /// Why.\n    pub enum A {\n        B(A),\n        ;\n    }\n}\nstruct A;\nfn f() {\n    struct A;\n}\n";
        assert_eq!(found(&[("a.rs", text)]), [("A".to_owned(), vec![3, 8])]);
    }

    #[test]
    fn a_meant_name_is_free_in_its_folder_alone() {
        let text = "pub(crate) struct Arguments {}";
        let verbs = ["crates/quell-cli/src/verbs/a.rs", "crates/quell-cli/src/verbs/b.rs"];
        assert_eq!(found(&[(verbs[0], text), (verbs[1], text)]), []);
        let elsewhere = [(verbs[0], text), ("crates/quell/src/a.rs", text)];
        assert_eq!(found(&elsewhere).len(), 1);
    }
}
