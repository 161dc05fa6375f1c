//! The modules of a crate, and the uses between them.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;
use std::path::Path;

use super::paths::{self, Segments, WrittenPath};
use super::rings;
use crate::source;

/// The largest number of re-exports that are followed from one name.
const FOLLOWED: usize = 16;

/// The files of a crate.
#[derive(Debug, Default)]
pub(super) struct Modules {
    files: BTreeMap<Segments, File>,
}

/// One file.
#[derive(Debug)]
struct File {
    /// Its path below the folder of sources.
    path: String,
    /// Its code with comments, literals and tests blanked.
    code: String,
    /// Paths written in it.
    written: Vec<WrittenPath>,
}

/// A group of files that use each other.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Ring {
    /// The number of files in the group.
    pub(super) files: usize,
    /// Their names, and the shortest ring among them with one use per line.
    pub(super) text: String,
}

impl Modules {
    /// Reads the sources below a folder.
    ///
    /// # Errors
    /// A file that cannot be read.
    pub(super) fn read(folder: &Path) -> Result<Self, String> {
        let mut texts = Vec::new();
        for path in source::files(folder)? {
            if source::has_extension(&path, "rs") {
                texts.push((source::relative(&path, folder), source::read(&path)?));
            }
        }
        let texts = texts.iter().map(|(path, text)| (path.as_str(), text.as_str()));
        Ok(Self::new(texts))
    }

    /// From paths below the folder of sources, and texts. Files of tests are left out.
    pub(super) fn new<'a>(texts: impl Iterator<Item = (&'a str, &'a str)>) -> Self {
        let mut files = BTreeMap::new();
        for (path, text) in texts {
            let mut name: Segments =
                path.trim_end_matches(".rs").split('/').map(str::to_owned).collect();
            if name.iter().any(|part| part == "tests") {
                continue;
            }
            let is_root = name.len() == 1 && matches!(name[0].as_str(), "lib" | "main");
            if is_root || name.last().is_some_and(|last| last == "mod") {
                name.pop();
            }
            let code = source::production(text);
            let written = paths::paths(&code);
            files.insert(name, File { path: path.to_owned(), code, written });
        }
        Self { files }
    }

    /// Every group of files that use each other.
    pub(super) fn rings(&self) -> Vec<Ring> {
        let names: Vec<&Segments> = self.files.keys().collect();
        let uses: Vec<BTreeMap<usize, usize>> = names
            .iter()
            .map(|name| {
                let index = |target: &Segments| names.binary_search(&target).unwrap_or_default();
                self.uses(name).into_iter().map(|(target, line)| (index(&target), line)).collect()
            })
            .collect();
        let graph: Vec<BTreeSet<usize>> =
            uses.iter().map(|targets| targets.keys().copied().collect()).collect();
        rings::groups(&graph)
            .into_iter()
            .map(|group| {
                let ring = rings::shortest(&graph, &group);
                let members: Vec<String> = group.iter().map(|at| shown(names[*at])).collect();
                let mut text = format!("    {} files: {}\n", group.len(), members.join(", "));
                for (from, to) in ring.iter().zip(ring.iter().cycle().skip(1)) {
                    let (file, line) = (&self.files[names[*from]].path, uses[*from][to]);
                    let _ = writeln!(text, "      src/{file}:{line} uses {}", shown(names[*to]));
                }
                Ring { files: group.len(), text }
            })
            .collect()
    }

    /// The modules that `module` uses, each with the line of the first use.
    fn uses(&self, module: &Segments) -> BTreeMap<Segments, usize> {
        let file = &self.files[module];
        let mut uses = BTreeMap::new();
        for written in &file.written {
            let Some(path) = self.absolute(module, written) else { continue };
            let first = self.file_of(&path);
            let publishes =
                written.exported && first.len() > module.len() && first.starts_with(module);
            let target = self.file_of(&self.followed(path));
            if target != *module && !publishes {
                uses.entry(target).or_insert_with(|| source::line(&file.code, written.start));
            }
        }
        uses
    }

    /// The path from the root of the crate for a path in `module`; `None` if it leads to another crate.
    fn absolute(&self, module: &Segments, written: &WrittenPath) -> Option<Segments> {
        let mut path: Segments = module.iter().chain(&written.inside).cloned().collect();
        let mut rest = written.segments.as_slice();
        match rest.first()?.as_str() {
            "crate" => {
                path.clear();
                rest = &rest[1..];
            }
            "self" => rest = &rest[1..],
            "super" => {
                while let Some(("super", others)) =
                    rest.split_first().map(|(first, others)| (first.as_str(), others))
                {
                    path.pop();
                    rest = others;
                }
            }
            child => {
                path.push(child.to_owned());
                if !self.files.contains_key(&path) {
                    return None;
                }
                rest = &rest[1..];
            }
        }
        path.extend_from_slice(rest);
        Some(path)
    }

    /// The file of a path: its longest prefix that is one.
    fn file_of(&self, path: &Segments) -> Segments {
        let mut path = path.clone();
        while !path.is_empty() && !self.files.contains_key(&path) {
            path.pop();
        }
        path
    }

    /// A path with re-exported names replaced by their definitions.
    fn followed(&self, mut path: Segments) -> Segments {
        for _ in 0..FOLLOWED {
            let module = self.file_of(&path);
            let Some(name) = path.get(module.len()) else { break };
            let Some(file) = self.files.get(&module) else { break };
            let target = file
                .written
                .iter()
                .filter(|written| written.alias.as_ref() == Some(name) && written.inside.is_empty())
                .find_map(|written| self.absolute(&module, written));
            let Some(target) = target else { break };
            let rest = path.split_off(module.len() + 1);
            path = target.into_iter().chain(rest).collect();
        }
        path
    }
}

fn shown(module: &Segments) -> String {
    if module.is_empty() { "the root of the crate".to_owned() } else { module.join("::") }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rings(texts: &[(&str, &str)]) -> Vec<Ring> {
        Modules::new(texts.iter().copied()).rings()
    }

    #[test]
    fn a_ring_is_printed_with_its_lines() {
        let found = rings(&[
            ("lib.rs", "mod a;\nmod b;\nmod c;\npub use a::A;"),
            ("a.rs", "//! Text.\nuse crate::b::{B, D};\npub struct A;"),
            ("b/mod.rs", "mod deep;\npub struct B;\npub use deep::D;"),
            ("b/deep.rs", "pub struct D;\nfn f() -> super::super::c::C {}"),
            ("c.rs", "\n\nuse crate::A;\npub struct C;"),
        ]);
        let text = "    3 files: a, b::deep, c\n\
                    \x20     src/a.rs:2 uses b::deep\n      src/b/deep.rs:2 uses c\n      src/c.rs:3 uses a\n";
        assert_eq!(found, [Ring { files: 3, text: text.to_owned() }]);
    }

    #[test]
    fn a_parent_may_publish_its_children_but_not_use_those_that_use_it() {
        let child = "use super::Shared;\npub struct Own;";
        let publishes = "mod child;\npub(crate) use child::Own;\npub struct Shared;";
        assert_eq!(rings(&[("a/mod.rs", publishes), ("a/child.rs", child)]), []);
        for uses in [
            "mod child;\nuse child::Own;\npub struct Shared;",
            "mod child;\npub struct Shared;\nfn f() { child::g() }",
            "mod child;\npub struct Shared;\nfn f() { self::child::g() }",
        ] {
            let found = rings(&[("a/mod.rs", uses), ("a/child.rs", child)]);
            assert_eq!(found.len(), 1, "{uses}");
            assert_eq!(found[0].files, 2);
        }
    }

    #[test]
    fn a_name_counts_for_the_module_that_defines_it() {
        // `one` takes from its parent what `two` defines; the parent uses `one`.
        let parent = "mod one;\nmod two;\npub use two::Two;\nuse one::One;";
        let texts = [("lib.rs", parent), ("two.rs", "pub struct Two;")];
        let one = ("one.rs", "use super::Two;\npub struct One;");
        assert_eq!(rings(&[texts[0], texts[1], one]), []);
        let two = ("two.rs", "use super::one::One;\npub struct Two;");
        let found = rings(&[texts[0], two, one]);
        assert_eq!(found.iter().map(|ring| ring.files).collect::<Vec<_>>(), [2]);
    }

    #[test]
    fn tests_and_texts_do_not_count() {
        let found = rings(&[
            ("a.rs", "use crate::b::B;"),
            (
                "b.rs",
                "#[cfg(test)]\nmod tests { use crate::a::A; }\n// use crate::a;\nconst C: &str = \"use crate::a;\";",
            ),
            ("b/tests.rs", "use crate::a::A;"),
        ]);
        assert_eq!(found, []);
    }

    #[test]
    fn paths_of_inline_modules_begin_at_them() {
        let found = rings(&[
            ("lib.rs", "mod a;\nfn f() { a::g() }\nstruct Root;"),
            ("a.rs", "mod inner { use super::Own; }\nstruct Own;"),
        ]);
        assert_eq!(found, []);
        let found = rings(&[
            ("lib.rs", "mod a;\nfn f() { a::g() }\nstruct Root;"),
            ("a.rs", "mod inner { use super::super::Root; }"),
        ]);
        assert_eq!(found.len(), 1);
    }
}
