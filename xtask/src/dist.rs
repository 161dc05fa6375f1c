//! `cargo xtask dist`: what a release consists of, for the platform of this machine, in `target/distribution`: the program without symbols, the wheel for any
//! Python from 3.10 on, and their checksums (SHA-256).
//!
//! The program is built with the profile `dist`, the wheel with the profile `wheel` in the environment of `cargo xtask python`.

use std::fs;
use std::path::Path;
use std::process::Command;

use crate::programs::{cargo, command};
use crate::python;

/// The list of checksums, as `sha256sum --check` reads it.
const CHECKSUMS: &str = "SHA256SUMS";

/// Prints the checksums of the files of a folder.
const CHECKSUM_PROGRAM: &str = "
import hashlib, pathlib, sys
for path in sorted(pathlib.Path(sys.argv[1]).iterdir()):
    print(f'{hashlib.sha256(path.read_bytes()).hexdigest()}  {path.name}')
";

/// Builds all of it.
///
/// # Errors
/// A command that failed, a file that cannot be written.
pub(crate) fn run(root: &Path) -> Result<(), String> {
    let root = root.canonicalize().map_err(|why| format!("{}: {why}", root.display()))?;
    let place = root.join("target/distribution");
    let failed = |path: &Path, why: std::io::Error| format!("{}: {why}", path.display());
    if place.exists() {
        fs::remove_dir_all(&place).map_err(|why| failed(&place, why))?;
    }
    let program = ["build", "--profile", "dist", "--package", "quell-cli"];
    command(cargo().args(program).current_dir(&root))?;
    let (name, end) = ("quell", std::env::consts::EXE_SUFFIX);
    fs::create_dir_all(&place).map_err(|why| failed(&place, why))?;
    let program =
        place.join(format!("{name}-{}-{}{end}", std::env::consts::ARCH, std::env::consts::OS));
    let made = root.join("target/dist").join(format!("{name}{end}"));
    fs::copy(&made, &program).map_err(|why| failed(&made, why))?;
    let interpreter = python::environment(&root, &root.join("target/python"))?;
    python::wheel(&root, &place, "wheel", &interpreter)?;
    let mut sums = Command::new(&interpreter);
    let sums = sums.args(["-c", CHECKSUM_PROGRAM]).arg(&place).output();
    let sums = sums.map_err(|why| failed(&interpreter, why))?;
    let list = place.join(CHECKSUMS);
    fs::write(&list, &sums.stdout).map_err(|why| failed(&list, why))?;
    print!("{}", String::from_utf8_lossy(&sums.stdout));
    println!("in {}", place.display());
    Ok(())
}
