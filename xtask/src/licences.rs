//! `cargo xtask licences`: checks that the licence of every dependency is compatible with MIT OR Apache-2.0.
//!
//! `cargo tree` prints the name and the SPDX expression of each crate in the lock file, including those of tests and of other
//! platforms. An expression is acceptable if one of its alternatives (`OR`, `/`) requires accepted licences only (`AND`).

use std::path::Path;

use crate::programs::cargo;

/// Accepted licences: permissive, or public domain. The reason is the same for all: those who redistribute Quell need only keep
/// the notices.
const ACCEPTED: &[&str] = &[
    "0BSD",
    "Apache-2.0",
    "Apache-2.0 WITH LLVM-exception",
    "BSD-2-Clause",
    "BSD-3-Clause",
    "BSL-1.0",
    "CC0-1.0",
    "ISC",
    "MIT",
    "Unicode-3.0",
    "Unlicense",
    "Zlib",
];

/// Checks every crate in the lock file.
///
/// # Errors
/// The crates whose licence is missing or not accepted, one per line; a `cargo tree` that failed.
pub(crate) fn run(root: &Path) -> Result<(), String> {
    let tree = ["tree", "--workspace", "--locked", "--target", "all", "--prefix", "none"];
    let output = cargo()
        .args(tree)
        .args(["--edges", "normal,build,dev", "--no-dedupe", "--format", "{p}|{l}"])
        .current_dir(root)
        .output()
        .map_err(|why| format!("cargo tree: {why}"))?;
    if !output.status.success() {
        return Err(format!("cargo tree: {}", String::from_utf8_lossy(&output.stderr)));
    }
    let text = String::from_utf8_lossy(&output.stdout);
    let mut lines: Vec<&str> = text.lines().filter(|line| !line.is_empty()).collect();
    lines.sort_unstable();
    lines.dedup();
    let refused: Vec<&str> = lines.iter().copied().filter(|line| !acceptable(line)).collect();
    if refused.is_empty() {
        eprintln!("licences: {} crates, all accepted", lines.len());
        Ok(())
    } else {
        Err(format!(
            "licences: not accepted (see xtask/src/licences.rs)\n  {}",
            refused.join("\n  ")
        ))
    }
}

/// Whether the licence of a line `name version|expression` is accepted.
fn acceptable(line: &str) -> bool {
    let Some((_, expression)) = line.split_once('|') else { return false };
    // `(A OR B) AND C` requires both: a parenthesis is an expression of its own.
    let groups: Vec<&str> = match expression.split_once(')') {
        Some((inside, rest)) if inside.starts_with('(') => {
            vec![&inside[1..], rest.trim().trim_start_matches("AND").trim()]
        }
        _ => vec![expression],
    };
    groups.iter().all(|group| group.is_empty() || one_of(group)) && !expression.trim().is_empty()
}

/// Whether one alternative is accepted as a whole.
fn one_of(expression: &str) -> bool {
    expression.split(" OR ").flat_map(|part| part.split('/')).any(|alternative| {
        alternative.split(" AND ").all(|licence| ACCEPTED.contains(&licence.trim()))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn alternatives_and_conjunctions_are_distinguished() {
        for fine in [
            "a v1|MIT",
            "a v1|MIT/Apache-2.0",
            "a v1|GPL-3.0-only OR MIT",
            "a v1|(MIT OR Apache-2.0) AND Unicode-3.0",
            "a v1|Apache-2.0 WITH LLVM-exception OR Apache-2.0 OR MIT",
        ] {
            assert!(acceptable(fine), "{fine}");
        }
        for not in [
            "a v1|",
            "a v1",
            "a v1|GPL-3.0-only",
            "a v1|MIT AND GPL-3.0-only",
            "a v1|(MIT OR Apache-2.0) AND GPL-3.0-only",
            "a v1|AGPL-3.0 OR MPL-2.0",
        ] {
            assert!(!acceptable(not), "{not}");
        }
    }
}
