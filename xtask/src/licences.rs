//! `cargo xtask licences`: every dependency may be used and passed on under terms that fit MIT OR Apache-2.0.
//!
//! `cargo tree` says name and SPDX expression of each crate of the lock file, those of tests and of other platforms
//! included. An expression is acceptable if one of its alternatives (`OR`, `/`) needs accepted licences only (`AND`).

use std::path::Path;
use std::process::Command;

/// Licences accepted: permissive, or public domain; the reason is the same for all of them: nothing is asked of those who
/// pass Quell on but to keep the notices.
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
/// The crates whose licence is missing or not accepted, one a line; a `cargo tree` that failed.
pub(crate) fn run(root: &Path) -> Result<(), String> {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let tree = ["tree", "--workspace", "--locked", "--target", "all", "--prefix", "none"];
    let output = Command::new(cargo)
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

/// Is the licence of a line `name version|expression` accepted?
fn acceptable(line: &str) -> bool {
    let Some((_, expression)) = line.split_once('|') else { return false };
    // `(A OR B) AND C` needs both: a parenthesis is an expression of its own.
    let groups: Vec<&str> = match expression.split_once(')') {
        Some((inside, rest)) if inside.starts_with('(') => {
            vec![&inside[1..], rest.trim().trim_start_matches("AND").trim()]
        }
        _ => vec![expression],
    };
    groups.iter().all(|group| group.is_empty() || one_of(group)) && !expression.trim().is_empty()
}

/// Is one alternative accepted as a whole?
fn one_of(expression: &str) -> bool {
    expression.split(" OR ").flat_map(|part| part.split('/')).any(|alternative| {
        alternative.split(" AND ").all(|licence| ACCEPTED.contains(&licence.trim()))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn alternatives_and_conjunctions_are_told_apart() {
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
