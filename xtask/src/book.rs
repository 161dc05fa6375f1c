//! `cargo xtask book`: the book as a site in `target/book`, with its pictures made by `quell reproduce`.
//!
//! Chapters are copied from `docs/book` beside fresh pictures, the report and the table of claims; mdBook does the rest.

use std::ffi::OsStr;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Where the pictures stand among the chapters.
const PICTURES: &str = "src/reproduction";

/// Makes it.
///
/// # Errors
/// A command that failed or is missing, a file that cannot be copied.
pub(crate) fn run(root: &Path) -> Result<(), String> {
    let work = root.join("target/book-source");
    let site = fs::canonicalize(root).map_err(|why| why.to_string())?.join("target/book");
    if work.exists() {
        fs::remove_dir_all(&work).map_err(|why| format!("{}: {why}", work.display()))?;
    }
    copy(&root.join("docs/book"), &work)?;
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let quell = ["run", "--release", "--package", "quell-cli", "--", "reproduce", "--out"];
    let pictures = fs::canonicalize(&work).map_err(|why| why.to_string())?.join(PICTURES);
    command(&cargo, root, |command| command.args(quell).arg(&pictures))?;
    command(OsStr::new("mdbook"), root, |command| {
        command.arg("build").arg(&work).arg("--dest-dir").arg(&site)
    })
    .map_err(|why| format!("{why} (`cargo install mdbook` installs it)"))?;
    eprintln!("book: {}", site.join("index.html").display());
    Ok(())
}

fn command(
    program: &OsStr,
    root: &Path,
    arguments: impl FnOnce(&mut Command) -> &mut Command,
) -> Result<(), String> {
    let name = program.display();
    let status = arguments(Command::new(program).current_dir(root)).status();
    let status = status.map_err(|why| format!("{name}: {why}"))?;
    if status.success() { Ok(()) } else { Err(format!("{name}: {status}")) }
}

/// Copies a folder.
fn copy(from: &Path, to: &Path) -> Result<(), String> {
    let failed = |path: &Path, why: std::io::Error| format!("{}: {why}", path.display());
    fs::create_dir_all(to).map_err(|why| failed(to, why))?;
    for file in fs::read_dir(from).map_err(|why| failed(from, why))? {
        let path: PathBuf = file.map_err(|why| failed(from, why))?.path();
        let Some(name) = path.file_name() else { continue };
        let target = to.join(name);
        if path.is_dir() {
            copy(&path, &target)?;
        } else {
            fs::copy(&path, &target).map_err(|why| failed(&path, why))?;
        }
    }
    Ok(())
}
