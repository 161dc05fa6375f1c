//! `cargo xtask python`: builds the wheel, installs it into an environment of its own, and runs the Python tests.
//!
//! It needs only Python 3.11 or newer with `venv`, and cargo. The environment is in
//! `target/python`; its packages are pinned in `tests/requirements.txt` and installed again only when
//! that list or the interpreter changes. The wheel is built with the profile of `cargo test`
//! and installed as a user would install it.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::programs::{cargo, command};
use crate::test_run::TestProgram;

/// The crate of the wheel.
const CRATE: &str = "crates/quell-python";

/// Packages of the tests.
const REQUIREMENTS: &str = "crates/quell-python/tests/requirements.txt";

/// Interpreters to try, in order.
const INTERPRETERS: &[&str] = &["python3", "python"];

/// Program that fails in an interpreter that is too old, and prints the version of any other.
const PROBE: &str = "import sys, venv; assert sys.version_info >= (3, 11); print(sys.version)";

/// Builds the wheel, installs it, runs the tests.
///
/// # Errors
/// The command that failed, with its exit status.
pub(crate) fn run(root: &Path) -> Result<(), String> {
    command(&mut tests(root)?.command)
}

/// Builds the wheel, installs it, and returns the program of the tests.
///
/// # Errors
/// As [`run`], without the tests.
pub(crate) fn tests(root: &Path) -> Result<TestProgram, String> {
    let root = root.canonicalize().map_err(|why| format!("{}: {why}", root.display()))?;
    let place = root.join("target").join("python");
    let python = environment(&root, &place)?;
    let program = root.join("target/debug").join(format!("quell{}", std::env::consts::EXE_SUFFIX));
    // An existing program may be older than the sources, so cargo builds it if necessary. For a single package cargo would unify
    // features differently and compile the dependencies again. After the wheel it would recompile crates that the wheel built
    // with other settings.
    command(cargo().args(["build", "--workspace"]).current_dir(&root))?;
    let wheels = place.join("wheels");
    if wheels.exists() {
        fs::remove_dir_all(&wheels).map_err(|why| format!("{}: {why}", wheels.display()))?;
    }
    let wheel = wheel(&root, &wheels, "dev", &python)?;
    let install = ["-m", "pip", "install", "--quiet", "--force-reinstall", "--no-deps"];
    command(Command::new(&python).args(install).arg(&wheel))?;
    let mut pytest = Command::new(&python);
    pytest
        .args(["-m", "pytest"])
        .current_dir(root.join(CRATE))
        .env("QUELL_CLI", program)
        .env("PYTHONDONTWRITEBYTECODE", "1");
    Ok(TestProgram { name: "pytest".to_owned(), command: pytest })
}

/// The interpreter of the environment, with all packages that the tests need.
pub(crate) fn environment(root: &Path, place: &Path) -> Result<PathBuf, String> {
    let requirements = root.join(REQUIREMENTS);
    let list = fs::read_to_string(&requirements)
        .map_err(|why| format!("{}: {why}", requirements.display()))?;
    let (interpreter, version) = INTERPRETERS
        .iter()
        .find_map(|name| Some((*name, answer(Command::new(name).args(["-c", PROBE]))?)))
        .ok_or("no Python 3.11 or newer with venv: install one (python3, python3-venv)")?;
    let folder = place.join("environment");
    let python = if cfg!(windows) {
        folder.join("Scripts").join("python.exe")
    } else {
        folder.join("bin").join("python")
    };
    let stamp = folder.join("quell-requirements");
    let wanted = format!("{version}{list}");
    if fs::read_to_string(&stamp).is_ok_and(|found| found == wanted) {
        return Ok(python);
    }
    command(Command::new(interpreter).args(["-m", "venv", "--clear"]).arg(&folder))?;
    let install = ["-m", "pip", "install", "--quiet", "--disable-pip-version-check", "-r"];
    command(Command::new(&python).args(install).arg(&requirements))?;
    fs::write(&stamp, wanted).map_err(|why| format!("{}: {why}", stamp.display()))?;
    Ok(python)
}

/// Builds the wheel with a profile into a folder that has none, and returns its path.
pub(crate) fn wheel(
    root: &Path,
    folder: &Path,
    profile: &str,
    python: &Path,
) -> Result<PathBuf, String> {
    let mut maturin = Command::new(python);
    maturin.args(["-m", "maturin", "build", "--quiet", "--profile", profile, "--out"]).arg(folder);
    command(maturin.arg("--interpreter").arg(python).current_dir(root.join(CRATE)))?;
    let built = folder.read_dir().map_err(|why| format!("{}: {why}", folder.display()))?;
    let paths = built.filter_map(|entry| Some(entry.ok()?.path()));
    let wheels: Vec<PathBuf> =
        paths.filter(|path| path.extension().is_some_and(|end| end == "whl")).collect();
    match wheels.as_slice() {
        [wheel] => Ok(wheel.clone()),
        others => Err(format!("maturin built {} wheels, not one", others.len())),
    }
}

/// The standard output of a program that succeeds.
fn answer(program: &mut Command) -> Option<String> {
    let output = program.output().ok().filter(|output| output.status.success())?;
    String::from_utf8(output.stdout).ok()
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;

    #[test]
    fn packages_of_the_tests_are_pinned() {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(REQUIREMENTS);
        let list = fs::read_to_string(path).expect("requirements");
        let lines = list.lines().filter(|line| !line.is_empty() && !line.starts_with('#'));
        let mut count = 0;
        for line in lines {
            let package = line.split(';').next().unwrap_or_default();
            assert!(package.contains("=="), "{line} is not pinned");
            count += 1;
        }
        assert!(count > 5);
    }

    /// Every dependency of the wheel has the same features as in the workspace, so that nothing is compiled twice.
    #[test]
    fn the_wheel_shares_what_the_tests_compile() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
        let crates = |of: &[&str]| -> BTreeSet<String> {
            let mut tree = cargo();
            tree.args(["tree", "--offline", "--format", "{p} {f}", "--prefix", "none"]);
            let text = answer(tree.args(of).current_dir(&root)).expect("cargo tree");
            text.lines().map(|line| line.trim_end_matches(" (*)").to_owned()).collect()
        };
        let wheel = crates(&["--package", "quell-python", "--edges", "normal,build"]);
        let all = crates(&["--workspace", "--edges", "all"]);
        let others: Vec<_> = wheel.difference(&all).collect();
        assert!(
            wheel.len() > 50 && others.is_empty(),
            "{others:?}: give quell-python the features"
        );
    }
}
