//! `cargo xtask coverage`: the lines of the crates that no test reaches.
//!
//! The tests of Rust run with the compiler's own counters (`-C instrument-coverage`), including the processes of the command line
//! that they start; `llvm-profdata` and `llvm-cov` turn the counters into an lcov file, and the table and the list of uncovered
//! lines are made from it. Lines of lane code that is inlined everywhere are counted where the compiler left them, so the shares
//! are a guide; the list of lines is the result.
//!
//! Only the crates of the workspace that are measured get counters. For them cargo calls this program in place of the compiler
//! (`RUSTC_WORKSPACE_WRAPPER`), and it adds the option ([`compile`]).

use std::env;
use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};

mod report;
mod tools;

use crate::programs;
use tools::Tools;

/// Set when cargo calls this program in place of the compiler.
pub(crate) const COMPILES: &str = "QUELL_COVERAGE_COMPILES";

/// The option of the compiler that adds counters.
const COUNTERS: &str = "-Cinstrument-coverage";

/// Its working folder, below the root.
const FOLDER: &str = "target/coverage";

/// The crate of the lanes. Counters in its inlined operations would be counters in every innermost loop of the other crates, a
/// hundred times slower. It is measured by its own tests alone, and has no counters when the others are measured.
const LANES: &str = "quell-numerics";

/// Measures one crate by its own tests, or all; prints the table of crates, and writes the uncovered lines of each file.
///
/// # Errors
/// The tools of LLVM are missing, a test failed, the report cannot be read or written.
pub(crate) fn run(root: &Path, only: Option<&str>) -> Result<(), String> {
    let root = fs::canonicalize(root).map_err(|why| why.to_string())?;
    let tools = Tools::find(&root)?;
    let lcov = if let Some(name) = only {
        measure(&root, &tools, name, &["--package", name])?
    } else {
        let lanes = measure(&root, &tools, "lanes", &["--package", LANES])?;
        let mut packages = vec!["--workspace"];
        packages
            .extend([LANES, "quell-python", "xtask"].iter().flat_map(|name| ["--exclude", name]));
        lanes + &measure(&root, &tools, "others", &packages)?
    };
    let files = report::files(&lcov, &root)?;
    let list = root.join(FOLDER).join("uncovered.txt");
    fs::write(&list, report::uncovered(&files))
        .map_err(|why| format!("{}: {why}", list.display()))?;
    print!("{}", report::table(&files));
    eprintln!("coverage: uncovered lines are listed in {}", list.display());
    Ok(())
}

/// The lcov report of some packages, made in a folder of its own.
fn measure(root: &Path, tools: &Tools, name: &str, packages: &[&str]) -> Result<String, String> {
    let folder = root.join(FOLDER).join(name);
    let profiles = folder.join("profiles");
    if profiles.exists() {
        fs::remove_dir_all(&profiles).map_err(|why| format!("{}: {why}", profiles.display()))?;
    }
    fs::create_dir_all(&profiles).map_err(|why| format!("{}: {why}", profiles.display()))?;
    // Cargo keeps what different wrappers compile apart by their paths, and shares the dependencies with every other build.
    let wrapper = folder.join(format!("compiler{}", env::consts::EXE_SUFFIX));
    let copied = env::current_exe().and_then(|program| fs::copy(program, &wrapper));
    copied.map_err(|why| format!("{}: {why}", wrapper.display()))?;
    let cargo = || {
        let mut command = programs::cargo();
        command.current_dir(root).args(["test", "--tests"]).args(packages);
        command.env("RUSTC_WORKSPACE_WRAPPER", &wrapper).env(COMPILES, "1");
        // Processes of one program share up to four files.
        command.env("LLVM_PROFILE_FILE", profiles.join("quell-%4m.profraw"));
        command
    };
    let built = tools::output(cargo().args(["--no-run", "--message-format", "json"]))?;
    let mut tests = cargo();
    // Threads that share counters wait for each other's caches: tests and sweeps run on one.
    tests.env("RUST_TEST_THREADS", "1").env("RAYON_NUM_THREADS", "1");
    // Pictures drawn in full take many times as long; another test draws them coarsely.
    tests.args(["--", "--skip", "pictures_are_those_of_reproduce"]);
    let status = tests.status().map_err(|why| format!("cargo test: {why}"))?;
    if !status.success() {
        return Err(format!("coverage: cargo test: {status}"));
    }
    tools.lcov(&profiles, &folder.join("merged.profdata"), &executables(&built))
}

/// The programs in the messages of `cargo test --message-format json`.
fn executables(messages: &str) -> Vec<PathBuf> {
    let marked = messages.lines().filter_map(|line| line.split_once("\"executable\":\""));
    let paths = marked.filter_map(|(_, rest)| rest.split_once('"'));
    paths.map(|(path, _)| PathBuf::from(path.replace("\\\\", "\\"))).collect()
}

/// Runs the compiler as cargo calls it (its path, its arguments), with counters in packages that are measured.
pub(crate) fn compile(arguments: impl Iterator<Item = OsString>) -> ExitCode {
    let is_measured = env::var_os("CARGO_PRIMARY_PACKAGE").is_some();
    let Some((compiler, arguments)) = compiler(arguments, is_measured) else {
        eprintln!("{COMPILES} is set, and no compiler is named");
        return ExitCode::FAILURE;
    };
    match Command::new(&compiler).args(arguments).status() {
        Ok(status) if status.success() => ExitCode::SUCCESS,
        Ok(status) => {
            let code = status.code().and_then(|code| u8::try_from(code).ok());
            code.map_or(ExitCode::FAILURE, ExitCode::from)
        }
        Err(why) => {
            eprintln!("{}: {why}", compiler.display());
            ExitCode::FAILURE
        }
    }
}

/// The compiler and its arguments; counters are added for a package that is measured, which is one that cargo was asked to test.
fn compiler(
    mut arguments: impl Iterator<Item = OsString>,
    is_measured: bool,
) -> Option<(OsString, Vec<OsString>)> {
    let compiler = arguments.next()?;
    let counters = is_measured.then(|| COUNTERS.into());
    Some((compiler, arguments.chain(counters).collect()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn measured_packages_get_counters_and_others_do_not() {
        let words = |words: &[&str]| words.iter().map(OsString::from).collect::<Vec<_>>();
        let call = words(&["rustc", "--crate-name", "quell"]);
        let (program, arguments) = compiler(call.clone().into_iter(), true).expect("a compiler");
        assert_eq!(program, "rustc");
        assert_eq!(arguments, words(&["--crate-name", "quell", "-Cinstrument-coverage"]));
        let (_, arguments) = compiler(call.into_iter(), false).expect("a compiler");
        assert_eq!(arguments, words(&["--crate-name", "quell"]));
        assert!(compiler(std::iter::empty(), true).is_none());
    }

    #[test]
    fn programs_are_read_from_the_messages_of_cargo() {
        let messages = "{\"reason\":\"compiler-artifact\",\"executable\":null,\"fresh\":true}\n\
                        {\"filenames\":[\"/t/a-1\"],\"executable\":\"/t/a-1\",\"fresh\":false}\n\
                        {\"executable\":\"C:\\\\t\\\\b.exe\"}\n{\"reason\":\"build-finished\"}\n";
        assert_eq!(executables(messages), [PathBuf::from("/t/a-1"), PathBuf::from("C:\\t\\b.exe")]);
    }
}
