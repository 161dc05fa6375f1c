//! `cargo xtask package`: every crate can be published, in this order, and holds all it needs.
//!
//! Crates are packed without being built again. What is compiled in from outside of a crate's folder would be missing on
//! the registry: no source file may reach out of it.

use std::path::Path;
use std::process::Command;

use crate::manifest;

/// Crates in the order in which they are published: each after those it uses.
const ORDER: &[&str] = &[
    "quell-numerics",
    "quell-model",
    "quell-linear",
    "quell-dynamics",
    "quell-disc",
    "quell-plot",
    "quell-study",
    "quell",
    "quell-reproduce",
    "quell-cli",
];

/// Packs every crate.
///
/// # Errors
/// A crate out of order, one that reaches out of its folder, one that cannot be packed.
pub(crate) fn run(root: &Path) -> Result<(), String> {
    let manifests = manifest::members(root)?;
    for (place, name) in ORDER.iter().enumerate() {
        let manifest = manifests.iter().find(|manifest| manifest.name == *name);
        let manifest = manifest.ok_or_else(|| format!("package: there is no crate {name}"))?;
        for dependency in &manifest.dependencies {
            let used = ORDER.iter().position(|other| *other == dependency.package);
            if used.is_some_and(|used| used >= place) {
                return Err(format!(
                    "package: {name} uses {}, published later",
                    dependency.package
                ));
            }
        }
        reaches_out(&root.join("crates").join(name).join("src"), 1)?;
    }
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let mut command = Command::new(cargo);
    command.args(["package", "--no-verify", "--allow-dirty"]).current_dir(root);
    for name in ORDER {
        command.args(["--package", name]);
    }
    let status = command.status().map_err(|why| format!("cargo package: {why}"))?;
    if !status.success() {
        return Err(format!("cargo package: {status}"));
    }
    eprintln!("package: publish in this order: {}", ORDER.join(", "));
    Ok(())
}

/// Complains of a file that includes one from outside of its crate; `depth` is how deep the folder lies below it.
fn reaches_out(folder: &Path, depth: usize) -> Result<(), String> {
    let failed = |why: std::io::Error| format!("package: {}: {why}", folder.display());
    for file in std::fs::read_dir(folder).map_err(failed)? {
        let path = file.map_err(failed)?.path();
        if path.is_dir() {
            reaches_out(&path, depth + 1)?;
        } else if path.extension().is_some_and(|extension| extension == "rs")
            && !path.ends_with("tests.rs")
        {
            let text = std::fs::read_to_string(&path).map_err(failed)?;
            // Tests are not built where a crate is used.
            let shipped = text.split("#[cfg(test)]\nmod ").next().unwrap_or_default();
            if includes_outside(shipped, depth) {
                return Err(format!(
                    "package: {} includes a file of another folder",
                    path.display()
                ));
            }
        }
    }
    Ok(())
}

/// Does a text include a file further up than the root of its crate?
fn includes_outside(text: &str, depth: usize) -> bool {
    let far = "../".repeat(depth + 1);
    ["include_str!(", "include_bytes!("]
        .iter()
        .flat_map(|macro_name| text.split(macro_name).skip(1))
        .any(|rest| rest.split(");").next().is_some_and(|argument| argument.contains(&far)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_from_outside_are_seen() {
        assert!(includes_outside("const A: &str = include_str!(\"../../a.txt\");", 1));
        assert!(!includes_outside("const A: &str = include_str!(\"../a.txt\");", 1));
        assert!(!includes_outside("let path = \"../../../a\";", 1));
        assert!(includes_outside("x = include_str!(concat!(\"../../../\", $a));", 2));
    }

    #[test]
    fn crates_of_this_workspace_hold_what_they_include() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
        for name in ORDER {
            assert_eq!(reaches_out(&root.join("crates").join(name).join("src"), 1), Ok(()));
        }
    }
}
