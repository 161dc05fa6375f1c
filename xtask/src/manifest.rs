//! Dependencies of the workspace's crates, as stated in their `Cargo.toml` files.

use std::fmt;
use std::path::{Path, PathBuf};

use toml::{Table, Value};

use crate::source::read;

/// The purpose of a dependency.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Use {
    /// `[dependencies]`.
    Normal,
    /// `[dev-dependencies]`: tests, examples, benches.
    Dev,
    /// `[build-dependencies]`.
    Build,
}

impl fmt::Display for Use {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Normal => "dependencies",
            Self::Dev => "dev-dependencies",
            Self::Build => "build-dependencies",
        })
    }
}

/// One dependency of a crate.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Dependency {
    /// Name of the package, also where the crate renames it.
    pub(crate) package: String,
    /// Its purpose.
    pub(crate) purpose: Use,
}

/// A crate of the workspace and its dependencies.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Manifest {
    /// Name of the package.
    pub(crate) name: String,
    /// Whether it may be published.
    pub(crate) is_published: bool,
    /// Every dependency, including those of single platforms.
    pub(crate) dependencies: Vec<Dependency>,
}

impl Manifest {
    /// From the text of a `Cargo.toml`; `shared` is the root's `[workspace.dependencies]`.
    ///
    /// # Errors
    /// A text that is not TOML, or has no `package.name`.
    pub(crate) fn parse(text: &str, shared: &Table) -> Result<Self, String> {
        let root: Table = text.parse().map_err(|why| format!("{why}"))?;
        let name = root
            .get("package")
            .and_then(|package| package.get("name"))
            .and_then(Value::as_str)
            .ok_or("no package.name")?;
        let mut dependencies = Vec::new();
        collect(&root, shared, &mut dependencies);
        for platform in root.get("target").and_then(Value::as_table).into_iter().flatten() {
            if let Some(tables) = platform.1.as_table() {
                collect(tables, shared, &mut dependencies);
            }
        }
        let publish = root.get("package").and_then(|package| package.get("publish"));
        let is_published = publish.and_then(Value::as_bool) != Some(false);
        Ok(Self { name: name.to_owned(), is_published, dependencies })
    }
}

/// Reads the three dependency tables of `tables`, in either spelling that Cargo accepts.
fn collect(tables: &Table, shared: &Table, into: &mut Vec<Dependency>) {
    for (key, purpose) in [
        ("dependencies", Use::Normal),
        ("dev-dependencies", Use::Dev),
        ("dev_dependencies", Use::Dev),
        ("build-dependencies", Use::Build),
        ("build_dependencies", Use::Build),
    ] {
        for (name, entry) in tables.get(key).and_then(Value::as_table).into_iter().flatten() {
            let package = renamed(entry)
                .or_else(|| shared.get(name).filter(|_| inherits(entry)).and_then(renamed))
                .unwrap_or(name);
            into.push(Dependency { package: package.to_owned(), purpose });
        }
    }
}

/// The name behind `x = { package = "…" }`.
fn renamed(entry: &Value) -> Option<&str> {
    entry.get("package")?.as_str()
}

/// Whether an entry reads `x = { workspace = true }` or `x.workspace = true`.
fn inherits(entry: &Value) -> bool {
    entry.get("workspace").and_then(Value::as_bool) == Some(true)
}

/// Every member of the workspace at `root`, in the order of `workspace.members`.
///
/// # Errors
/// A manifest that cannot be read, named by its path.
pub(crate) fn members(root: &Path) -> Result<Vec<Manifest>, String> {
    let workspace = workspace(root)?;
    let shared = workspace.get("dependencies").and_then(Value::as_table).cloned();
    let shared = shared.unwrap_or_default();
    let mut manifests = Vec::new();
    for folder in folders_of_members(root)? {
        let path = folder.join("Cargo.toml");
        let manifest = Manifest::parse(&read(&path)?, &shared);
        manifests.push(manifest.map_err(|why| format!("{}: {why}", path.display()))?);
    }
    Ok(manifests)
}

/// The folder of every member, in the order of `workspace.members`.
///
/// # Errors
/// A root manifest that cannot be read, or has no `workspace.members`.
pub(crate) fn folders_of_members(root: &Path) -> Result<Vec<PathBuf>, String> {
    let workspace = workspace(root)?;
    let patterns = workspace
        .get("members")
        .and_then(Value::as_array)
        .ok_or_else(|| format!("{}: no workspace.members", root.join("Cargo.toml").display()))?;
    let mut found = Vec::new();
    for pattern in patterns.iter().filter_map(Value::as_str) {
        found.extend(folders(root, pattern)?);
    }
    Ok(found)
}

/// The table `[workspace]` of the root manifest.
fn workspace(root: &Path) -> Result<Table, String> {
    let path = root.join("Cargo.toml");
    let manifest: Table =
        read(&path)?.parse().map_err(|why| format!("{}: {why}", path.display()))?;
    Ok(manifest.get("workspace").and_then(Value::as_table).cloned().unwrap_or_default())
}

/// Folders of a member pattern: a path, or a path ending in `/*`.
fn folders(root: &Path, pattern: &str) -> Result<Vec<PathBuf>, String> {
    let Some(parent) = pattern.strip_suffix("/*") else {
        return Ok(vec![root.join(pattern)]);
    };
    let parent = root.join(parent);
    let entries = parent.read_dir().map_err(|why| format!("{}: {why}", parent.display()))?;
    let mut folders: Vec<PathBuf> = entries
        .filter_map(|entry| entry.ok().map(|entry| entry.path()))
        .filter(|folder| folder.join("Cargo.toml").is_file())
        .collect();
    folders.sort();
    Ok(folders)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_table_spelling_and_rename_is_read() {
        let shared: Table = r#"
            threads = { package = "rayon", version = "1" }
            quell-model = { path = "crates/quell-model" }
        "#
        .parse()
        .expect("TOML");
        let manifest = Manifest::parse(
            r#"
            [package]
            name = "planted"
            [dependencies]
            quell-model = { workspace = true }
            threads.workspace = true
            plain = "1"
            [dev-dependencies]
            text = { package = "toml", version = "1" }
            [build_dependencies]
            cc = "1"
            [target.'cfg(unix)'.dependencies]
            pyo3 = { version = "0.1", optional = true }
            "#,
            &shared,
        )
        .expect("a manifest");
        assert_eq!((manifest.name.as_str(), manifest.is_published), ("planted", true));
        let private = "[package]\nname = \"planted\"\npublish = false";
        assert!(!Manifest::parse(private, &shared).expect("a manifest").is_published);
        let mut found: Vec<(&str, Use)> = manifest
            .dependencies
            .iter()
            .map(|dependency| (dependency.package.as_str(), dependency.purpose))
            .collect();
        found.sort_by_key(|(package, _)| *package);
        assert_eq!(
            found,
            [
                ("cc", Use::Build),
                ("plain", Use::Normal),
                ("pyo3", Use::Normal),
                ("quell-model", Use::Normal),
                ("rayon", Use::Normal),
                ("toml", Use::Dev),
            ]
        );
    }

    #[test]
    fn a_manifest_without_a_name_is_refused() {
        assert!(Manifest::parse("[dependencies]", &Table::new()).is_err());
        assert!(Manifest::parse("[package", &Table::new()).is_err());
    }
}
