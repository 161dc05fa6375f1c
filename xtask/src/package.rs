//! `cargo xtask package`: checks that every crate can be published, in a fixed order, and contains all files it needs.
//!
//! Crates are packed without being built again. A file that is compiled in from outside a crate's folder would be missing on
//! the registry, so no source file may include one.

use std::path::Path;

use crate::manifest::{self, Manifest};
use crate::programs::{cargo, command};

/// Crates in the order of their publication: each after those it uses.
const ORDER: &[&str] = &[
    "quell-numerics",
    "quell-model",
    "quell-linear",
    "quell-dynamics",
    "quell-disc",
    "quell-design",
    "quell-plot",
    "quell-input",
    "quell-study",
    "quell-verbs",
    "quell-maps",
    "quell",
    "quell-reproduce",
    "quell-cli",
];

/// Packs every crate.
///
/// # Errors
/// A crate out of order, one that includes a file from outside its folder, one that cannot be packed.
pub(crate) fn run(root: &Path) -> Result<(), String> {
    check_order(&manifest::members(root)?)?;
    for name in ORDER {
        check_includes(&root.join("crates").join(name).join("src"), 1)?;
    }
    let mut packing = cargo();
    packing.args(["package", "--no-verify", "--allow-dirty"]).current_dir(root);
    for name in ORDER {
        packing.args(["--package", name]);
    }
    command(&mut packing)?;
    eprintln!("package: publish in this order: {}", ORDER.join(", "));
    Ok(())
}

/// Checks that the order contains every crate that is published, each after those it uses.
fn check_order(manifests: &[Manifest]) -> Result<(), String> {
    for manifest in manifests.iter().filter(|manifest| manifest.is_published) {
        if !ORDER.contains(&manifest.name.as_str()) {
            return Err(format!("package: {} is not in the order of publication", manifest.name));
        }
    }
    for (index, name) in ORDER.iter().enumerate() {
        let manifest = manifests.iter().find(|manifest| manifest.name == *name);
        let manifest = manifest.ok_or_else(|| format!("package: no crate is named {name}"))?;
        for dependency in &manifest.dependencies {
            let used = ORDER.iter().position(|other| *other == dependency.package);
            if used.is_some_and(|used| used >= index) {
                let package = &dependency.package;
                return Err(format!("package: {name} uses {package}, which is published later"));
            }
        }
    }
    Ok(())
}

/// Checks that no file includes one from outside its crate; `depth` is the depth of `folder` below the folder of the crate.
fn check_includes(folder: &Path, depth: usize) -> Result<(), String> {
    let failed = |why: std::io::Error| format!("package: {}: {why}", folder.display());
    for file in std::fs::read_dir(folder).map_err(failed)? {
        let path = file.map_err(failed)?.path();
        if path.is_dir() {
            check_includes(&path, depth + 1)?;
        } else if path.extension().is_some_and(|extension| extension == "rs")
            && !path.ends_with("tests.rs")
        {
            let text = std::fs::read_to_string(&path).map_err(failed)?;
            // Tests are not built where a crate is used.
            let shipped = text.split("#[cfg(test)]\nmod ").next().unwrap_or_default();
            if includes_outside(shipped, depth) {
                return Err(format!(
                    "package: {} includes a file from outside its crate",
                    path.display()
                ));
            }
        }
    }
    Ok(())
}

/// Whether a text includes a file from above the folder of its crate.
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
    use crate::manifest::{Dependency, Use};

    #[test]
    fn the_order_is_complete_and_follows_the_dependencies() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
        let mut manifests = manifest::members(&root).expect("readable manifests");
        assert_eq!(check_order(&manifests), Ok(()));

        let (first, last) = (ORDER[0], ORDER[ORDER.len() - 1]);
        let lowest = manifests.iter_mut().find(|manifest| manifest.name == first);
        let planted = Dependency { package: last.to_owned(), purpose: Use::Dev };
        lowest.expect("a crate").dependencies.push(planted);
        assert!(check_order(&manifests).is_err_and(|why| why.contains(last)));

        let new = Manifest { name: "new".to_owned(), is_published: true, dependencies: vec![] };
        assert!(check_order(&[new]).is_err_and(|why| why.contains("new is not in the order")));
        assert!(check_order(&[]).is_err_and(|why| why.contains(first)));
    }

    #[test]
    fn files_from_outside_are_found() {
        assert!(includes_outside("const A: &str = include_str!(\"../../a.txt\");", 1));
        assert!(!includes_outside("const A: &str = include_str!(\"../a.txt\");", 1));
        assert!(!includes_outside("let path = \"../../../a\";", 1));
        assert!(includes_outside("x = include_str!(concat!(\"../../../\", $a));", 2));
    }

    #[test]
    fn crates_of_this_workspace_contain_what_they_include() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
        for name in ORDER {
            assert_eq!(check_includes(&root.join("crates").join(name).join("src"), 1), Ok(()));
        }
    }
}
