//! `cargo xtask layers`: fails on a dependency that the table of layers forbids.
//!
//! It reads the normal, dev and build dependencies of every member, including those of single
//! platforms and renamed ones, and reports all violations at once.

use std::path::Path;

use crate::manifest::{self, Dependency, Manifest, Use};

mod table;

use table::{CONFINED, LAYERS};

/// Checks the workspace at `root`.
///
/// # Errors
/// The dependencies that the table forbids, one per line; a manifest that cannot be read.
pub(crate) fn run(root: &Path) -> Result<(), String> {
    let manifests = manifest::members(root)?;
    let violations = violations(&manifests);
    if violations.is_empty() {
        eprintln!("layers: {} crates, no forbidden dependency", manifests.len());
        Ok(())
    } else {
        Err(format!(
            "layers: forbidden (see xtask/src/layers/table.rs)\n  {}",
            violations.join("\n  ")
        ))
    }
}

/// A description of every dependency that is not allowed.
fn violations(manifests: &[Manifest]) -> Vec<String> {
    let mut violations = Vec::new();
    for manifest in manifests {
        if !LAYERS.iter().any(|layer| layer.name == manifest.name) {
            let unknown = "is not in the table of layers: add a line with a reason";
            violations.push(format!("{} {unknown}", manifest.name));
            continue;
        }
        for dependency in &manifest.dependencies {
            let forbidden = forbidden_layer(&manifest.name, dependency)
                .or_else(|| forbidden_home(&manifest.name, dependency));
            if let Some(reason) = forbidden {
                violations.push(format!(
                    "{} -> {} ({}): {reason}",
                    manifest.name, dependency.package, dependency.purpose
                ));
            }
        }
    }
    violations
}

/// Why a crate may not use a crate of the workspace.
fn forbidden_layer(name: &str, dependency: &Dependency) -> Option<&'static str> {
    let package = dependency.package.as_str();
    let inside = LAYERS.iter().any(|layer| layer.name == package);
    let layer = LAYERS.iter().find(|layer| layer.name == name)?;
    (inside && !layer.may_use.contains(&package)).then_some(layer.reason)
}

/// Why a crate may not use an external dependency.
fn forbidden_home(name: &str, dependency: &Dependency) -> Option<&'static str> {
    let confined = CONFINED.iter().find(|confined| confined.package == dependency.package)?;
    let allowed =
        confined.homes.contains(&name) || (confined.in_tests && dependency.purpose == Use::Dev);
    (!allowed).then_some(confined.reason)
}

#[cfg(test)]
mod tests {
    use super::table::{Confined, CrateLayer};
    use super::*;

    /// The crate of the table that does not exist yet.
    const PLANNED: &str = "quell-explorer";

    /// What the check reports for one crate with one dependency.
    fn verdict(name: &str, package: &str, purpose: Use) -> Vec<String> {
        let dependency = Dependency { package: package.to_owned(), purpose };
        let dependencies = vec![dependency];
        violations(&[Manifest { name: name.to_owned(), is_published: true, dependencies }])
    }

    #[test]
    fn the_workspace_obeys_its_table() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
        let manifests = manifest::members(&root).expect("readable manifests");
        assert!(manifests.iter().any(|manifest| manifest.name == "quell-numerics"));
        assert!(manifests.iter().any(|manifest| manifest.name == "xtask"));
        assert_eq!(violations(&manifests), Vec::<String>::new());
    }

    #[test]
    fn planted_dependencies_upwards_and_sideways_are_reported() {
        for (name, package) in [
            ("quell-numerics", "quell-model"),
            ("quell-model", "quell-dynamics"),
            ("quell-dynamics", "quell-disc"),
            ("quell-linear", "quell-dynamics"),
            ("quell-disc", "quell-dynamics"),
            ("quell-dynamics", "quell"),
            ("quell", "quell-cli"),
            ("quell-cli", "quell-dynamics"),
            ("quell-cli", "quell-python"),
            ("quell-explorer", "quell-numerics"),
            ("xtask", "quell-numerics"),
        ] {
            for purpose in [Use::Normal, Use::Dev, Use::Build] {
                let found = verdict(name, package, purpose);
                assert_eq!(found.len(), 1, "{name} -> {package}");
                assert!(found[0].starts_with(&format!("{name} -> {package} ({purpose}): ")));
            }
        }
    }

    #[test]
    fn dependencies_downwards_are_allowed() {
        for (name, package) in [
            ("quell-model", "quell-numerics"),
            ("quell-dynamics", "quell-model"),
            ("quell-disc", "quell-numerics"),
            ("quell", "quell-dynamics"),
            ("quell-cli", "quell"),
            ("quell-python", "quell"),
            ("quell-dynamics", "libm"),
        ] {
            assert_eq!(verdict(name, package, Use::Normal), Vec::<String>::new());
        }
    }

    #[test]
    fn planted_confined_dependencies_are_reported() {
        for (name, package) in [
            ("quell-dynamics", "rayon"),
            ("quell-maps", "rayon"),
            ("quell-model", "toml"),
            ("quell-dynamics", "zarrs"),
            ("quell-cli", "resvg"),
            ("quell", "clap"),
            ("quell", "indicatif"),
            ("quell", "pyo3"),
            ("quell-python", "clap"),
            ("quell-model", "serde"),
            ("quell-numerics", "serde_json"),
        ] {
            assert_eq!(verdict(name, package, Use::Normal).len(), 1, "{name} -> {package}");
        }
        for (name, package) in [
            ("quell-verbs", "rayon"),
            ("quell-cli", "clap"),
            ("quell-cli", "serde_json"),
            ("xtask", "toml"),
        ] {
            assert_eq!(verdict(name, package, Use::Normal), Vec::<String>::new());
        }
    }

    #[test]
    fn only_tests_may_read_reference_numbers_anywhere() {
        assert!(verdict("quell-dynamics", "serde_json", Use::Dev).is_empty());
        assert_eq!(verdict("quell-dynamics", "serde_json", Use::Build).len(), 1);
        assert_eq!(verdict("quell-dynamics", "zarrs", Use::Dev).len(), 1);
    }

    #[test]
    fn a_crate_without_a_line_is_reported() {
        let found = verdict("quell-new", "libm", Use::Normal);
        assert_eq!(found.len(), 1);
        assert!(found[0].starts_with("quell-new is not in the table"));
    }

    /// If every allowed dependency points to an earlier line, no cycle is possible.
    #[test]
    fn the_table_points_downwards() {
        for (row, layer) in LAYERS.iter().enumerate() {
            assert!(!layer.reason.is_empty());
            for used in layer.may_use {
                let below = LAYERS[..row].iter().any(|lower| lower.name == *used);
                assert!(below, "{} -> {used}", layer.name);
            }
        }
    }

    /// A permission that no crate needs would let a dependency spread unnoticed.
    #[test]
    fn every_permission_is_needed() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
        let manifests = manifest::members(&root).expect("readable manifests");
        let uses = |name: &str, package: &str, purposes: &[Use]| {
            let manifest = manifests.iter().find(|manifest| manifest.name == name);
            let dependencies = manifest.map(|manifest| manifest.dependencies.iter());
            dependencies.is_some_and(|mut dependencies| {
                dependencies.any(|dependency| {
                    dependency.package == package && purposes.contains(&dependency.purpose)
                })
            })
        };
        for Confined { package, homes, in_tests, .. } in CONFINED {
            let all = [Use::Normal, Use::Build, Use::Dev];
            let purposes = if *in_tests { &all[..2] } else { &all };
            for home in *homes {
                assert!(uses(home, package, purposes), "{home} does not use {package}");
            }
            let elsewhere = |layer: &CrateLayer| {
                !homes.contains(&layer.name) && uses(layer.name, package, &[Use::Dev])
            };
            assert_eq!(LAYERS.iter().any(elsewhere), *in_tests, "{package} in tests");
        }
        for layer in LAYERS.iter().filter(|layer| layer.name != PLANNED) {
            let exists = manifests.iter().any(|manifest| manifest.name == layer.name);
            assert!(exists, "{} is no member of the workspace", layer.name);
        }
    }

    /// The table in ARCHITECTURE.md is the table of the check.
    #[test]
    fn the_printed_table_is_the_table() {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../ARCHITECTURE.md");
        let text = std::fs::read_to_string(path).expect("ARCHITECTURE.md");
        let printed: Vec<&str> = text
            .lines()
            .skip_while(|line| !line.starts_with("| crate | may use |"))
            .skip(2)
            .take_while(|line| line.starts_with('|'))
            .collect();
        let rows: Vec<String> = LAYERS
            .iter()
            .map(|layer| {
                let used: Vec<String> =
                    layer.may_use.iter().map(|name| format!("`{name}`")).collect();
                let used = if used.is_empty() { "nothing".to_owned() } else { used.join(", ") };
                format!("| `{}` | {used} | {} |", layer.name, layer.reason)
            })
            .collect();
        assert_eq!(printed, rows);
    }
}
