//! `cargo xtask cycles`: fails when modules of one crate use each other in a ring, and prints the ring.
//!
//! A module is a file. It uses another if one of its `use` items or qualified paths resolves to an item there (`crate::`,
//! `super::`, `self::`, or the name of a child module). A re-exported name resolves to the module that defines it. Tests do not
//! count, nor does a `pub use` of a child by its parent, which publishes the child's items without depending on them.

use std::collections::BTreeMap;
use std::path::Path;

use crate::manifest;
use crate::ratchet::{Counts, Ratchet, RatchetMode};

mod modules;
mod paths;
mod rings;

use modules::Modules;

/// Files in rings, by crate.
const RATCHET: Ratchet = Ratchet {
    check: "cycles",
    file: "xtask/cycles.toml",
    counted: "Files that use each other in rings, by crate.",
};

/// Checks every crate of the workspace at `root`.
///
/// # Errors
/// The rings of crates with more files in rings than allowed; counts that have fallen; a file that cannot be read.
pub(crate) fn run(root: &Path, mode: RatchetMode) -> Result<(), String> {
    let mut counts = Counts::new();
    let mut texts = BTreeMap::new();
    let mut groups = 0;
    for folder in manifest::folders_of_members(root)? {
        let key = crate::source::relative(&folder, root);
        let modules = Modules::read(&folder.join("src"))?;
        let found = modules.rings();
        let files: usize = found.iter().map(|ring| ring.files).sum();
        if files > 0 {
            counts.insert(key.clone(), files);
            groups += found.len();
            texts.insert(key, found.iter().map(|ring| ring.text.as_str()).collect::<String>());
        }
    }
    RATCHET.check(root, &counts, mode, |key| texts.get(key).cloned().unwrap_or_default())?;
    eprintln!("cycles: {groups} groups of modules in rings, all of them known");
    Ok(())
}
