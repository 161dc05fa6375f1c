//! The programs of all tests, several at a time.
//!
//! `cargo test` runs one program after another, and each leaves cores idle while its last long test ends. Here every program begins as
//! soon as another is done, and what each prints is shown whole when it ends. All of them run, also after a failure.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::{Mutex, PoisonError};
use std::thread;
use std::time::Instant;

use serde_json::Value;

use crate::programs::cargo;

/// A program of tests.
pub(crate) struct TestProgram {
    /// Its crate and its source.
    pub(crate) name: String,
    pub(crate) command: Command,
}

/// Builds the test programs of the workspace and returns them, each with these arguments.
///
/// # Errors
/// The compiler failed, whose messages are printed.
pub(crate) fn built(root: &Path, arguments: &[&str]) -> Result<Vec<TestProgram>, String> {
    let mut build = cargo();
    build
        .args(["test", "--workspace", "--no-run", "--message-format", "json-render-diagnostics"])
        .current_dir(root)
        .stderr(std::process::Stdio::inherit());
    let output = build.output().map_err(|why| format!("cargo test --no-run: {why}"))?;
    if !output.status.success() {
        return Err(format!("cargo test --no-run: {}", output.status));
    }
    let text = String::from_utf8_lossy(&output.stdout);
    let mut programs: Vec<TestProgram> =
        text.lines().filter_map(|line| program(line, arguments)).collect();
    // Cargo names them in the order in which they were built. Those of all tests of a crate take longest.
    programs.sort_by_key(|program| (!program.name.ends_with("tests/all.rs"), program.name.clone()));
    Ok(programs)
}

/// The test program of a message of cargo, if it is about one.
fn program(message: &str, arguments: &[&str]) -> Option<TestProgram> {
    let message: Value = serde_json::from_str(message).ok()?;
    let executable = message["executable"].as_str()?;
    if message["profile"]["test"] != true {
        return None;
    }
    let folder = PathBuf::from(message["manifest_path"].as_str()?).parent()?.to_owned();
    let source = Path::new(message["target"]["src_path"].as_str()?);
    let package = folder.file_name()?.to_string_lossy().into_owned();
    let source = source.strip_prefix(&folder).unwrap_or(source).display();
    let mut command = Command::new(executable);
    command
        .args(arguments)
        .arg(format!("--test-threads={}", threads()))
        .current_dir(&folder)
        .env("CARGO_MANIFEST_DIR", &folder);
    Some(TestProgram { name: format!("{package}: {source}"), command })
}

/// Programs at a time.
const PROGRAMS: usize = 2;

/// Threads of each program: all cores, so that none is idle while the last program ends.
fn threads() -> usize {
    thread::available_parallelism().map_or(1, usize::from)
}

/// Runs the programs, in their order as far as they wait for each other. `last` begins with the first of them, and what it prints is shown
/// after everything else.
///
/// # Errors
/// The programs that failed, one per line.
pub(crate) fn run(programs: Vec<TestProgram>, last: Option<TestProgram>) -> Result<(), String> {
    let (waiting, failed) = (Mutex::new(programs.into_iter()), Mutex::new(Vec::new()));
    let next = || waiting.lock().unwrap_or_else(PoisonError::into_inner).next();
    let ended = |TestProgram { name, mut command }: TestProgram| {
        let begun = Instant::now();
        let output = command.output();
        let ended = EndedProgram { name, seconds: begun.elapsed().as_secs_f64(), output };
        if !ended.is_success() {
            failed.lock().unwrap_or_else(PoisonError::into_inner).push(ended.name.clone());
        }
        ended
    };
    let work = || {
        while let Some(program) = next() {
            ended(program).print();
        }
    };
    let held = thread::scope(|scope| {
        for _ in 1..PROGRAMS {
            scope.spawn(work);
        }
        let held = last.map(ended);
        work();
        held
    });
    if let Some(held) = held {
        held.print();
    }
    let failed = failed.into_inner().unwrap_or_else(PoisonError::into_inner);
    if failed.is_empty() { Ok(()) } else { Err(format!("failed:\n  {}", failed.join("\n  "))) }
}

/// A program that has ended.
struct EndedProgram {
    name: String,
    seconds: f64,
    output: std::io::Result<Output>,
}

impl EndedProgram {
    fn is_success(&self) -> bool {
        self.output.as_ref().is_ok_and(|output| output.status.success())
    }

    /// Prints all of it at once.
    fn print(&self) {
        let text = match &self.output {
            Ok(output) => {
                let [printed, errors] =
                    [&output.stdout, &output.stderr].map(|text| String::from_utf8_lossy(text));
                format!("{errors}{printed}")
            }
            Err(why) => why.to_string(),
        };
        println!("     Running {} ({:.0} s)\n{}\n", self.name, self.seconds, text.trim_end());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shell(name: &str, script: &str) -> TestProgram {
        let mut command = Command::new("sh");
        command.args(["-c", script]);
        TestProgram { name: name.to_owned(), command }
    }

    #[test]
    fn messages_about_test_programs_are_programs() {
        let message = |test: bool| {
            format!(
                r#"{{"reason":"compiler-artifact","manifest_path":"/w/crates/a/Cargo.toml","target":{{"src_path":"/w/crates/a/tests/all.rs"}},"profile":{{"test":{test}}},"executable":"/w/target/all"}}"#
            )
        };
        let found = program(&message(true), &["--skip", "slow"]).expect("a program");
        assert_eq!(found.name, "a: tests/all.rs");
        assert_eq!(found.command.get_current_dir(), Some(Path::new("/w/crates/a")));
        assert_eq!(found.command.get_args().take(2).collect::<Vec<_>>(), ["--skip", "slow"]);
        assert!(program(&message(false), &[]).is_none() && program("text", &[]).is_none());
    }

    #[cfg(unix)]
    #[test]
    fn every_program_runs_and_failures_are_named() {
        let folder = std::env::temp_dir().join(format!("quell-test-run-{}", std::process::id()));
        std::fs::create_dir_all(&folder).expect("a folder");
        let touch = |name: &str| format!("touch {}", folder.join(name).display());
        let programs = vec![
            shell("one", &touch("one")),
            shell("two", "exit 1"),
            shell("three", &touch("three")),
        ];
        let report = run(programs, Some(shell("last", &touch("last")))).expect_err("two fails");
        assert_eq!(report, "failed:\n  two");
        for name in ["one", "three", "last"] {
            assert!(folder.join(name).exists(), "{name}");
        }
        std::fs::remove_dir_all(&folder).expect("removed");
        assert_eq!(run(vec![shell("fine", "true")], None), Ok(()));
    }
}
