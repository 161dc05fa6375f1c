//! `cargo xtask test`: everything that must hold before a change is merged.
//!
//! The steps run in order and stop at the first failure, which is named. The tests come last,
//! those of Python after those of Rust, and nothing is printed after them, so that a good run
//! closes with a summary. One profile (dev, optimised in the root manifest) serves all steps:
//! nothing is compiled twice for the sake of a profile.

use std::path::Path;
use std::process::Command;

use crate::{layers, licences, python};

/// One step.
struct Step {
    /// Its name.
    name: &'static str,
    /// What it does.
    action: Action,
    /// What to do when it fails.
    advice: &'static str,
}

/// What a step does.
enum Action {
    /// `cargo` with arguments.
    Cargo(&'static [&'static str]),
    /// The check of dependency arrows.
    Layers,
    /// The check of licences.
    Licences,
    /// The wheel, in an environment of its own, and the tests of Python.
    Python,
}

#[rustfmt::skip]
const STEPS: &[Step] = &[
    Step {
        name: "formatting",
        action: Action::Cargo(&["fmt", "--all", "--check"]),
        advice: "run `cargo fmt --all`",
    },
    Step {
        name: "lints",
        action: Action::Cargo(&["clippy", "--workspace", "--all-targets", "--", "-D", "warnings"]),
        advice: "mend what clippy names, or `#[expect(lint, reason = \"…\")]`",
    },
    Step {
        name: "layers",
        action: Action::Layers,
        advice: "turn the arrow round, or move the code",
    },
    Step {
        name: "licences",
        action: Action::Licences,
        advice: "choose another crate, or argue for its licence in xtask/src/licences.rs",
    },
    Step {
        name: "documentation",
        action: Action::Cargo(&["doc", "--workspace", "--no-deps"]),
        advice: "mend the doc comments that rustdoc names",
    },
    Step {
        name: "tests",
        action: Action::Cargo(&["test", "--workspace"]),
        advice: "the failing test is named above",
    },
    Step {
        name: "python",
        action: Action::Python,
        advice: "the failing test is named above; target/python has the environment",
    },
];

/// Runs every step in the workspace at `root`.
///
/// # Errors
/// The name of the first step that failed, and what to do about it.
pub(crate) fn run(root: &Path) -> Result<(), String> {
    until_failure(|action| match action {
        Action::Cargo(arguments) => cargo(root, arguments),
        Action::Layers => layers::run(root),
        Action::Licences => licences::run(root),
        Action::Python => python::run(root),
    })
}

/// Runs the steps with `act` and stops at the first that fails.
fn until_failure(mut act: impl FnMut(&Action) -> Result<(), String>) -> Result<(), String> {
    for (index, step) in STEPS.iter().enumerate() {
        let command = match step.action {
            Action::Cargo(arguments) => format!("cargo {}", arguments.join(" ")),
            Action::Layers => "cargo xtask layers".to_owned(),
            Action::Licences => "cargo xtask licences".to_owned(),
            Action::Python => "cargo xtask python".to_owned(),
        };
        eprintln!("[{}/{}] {}: {command}", index + 1, STEPS.len(), step.name);
        act(&step.action).map_err(|why| {
            format!("{why}\nxtask test: FAILED at {}: {}", step.name, step.advice)
        })?;
    }
    Ok(())
}

/// Runs the same `cargo` that runs this chore. Warnings of rustdoc are errors.
fn cargo(root: &Path, arguments: &[&str]) -> Result<(), String> {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let status = Command::new(cargo)
        .args(arguments)
        .current_dir(root)
        .env("RUSTDOCFLAGS", "-D warnings")
        .status()
        .map_err(|why| format!("cargo {}: {why}", arguments.join(" ")))?;
    if status.success() { Ok(()) } else { Err(format!("cargo {}: {status}", arguments.join(" "))) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_good_run_closes_with_the_summaries_of_the_tests() {
        let mut names = 0;
        let done = until_failure(|_| {
            names += 1;
            Ok(())
        });
        assert_eq!((done, names), (Ok(()), STEPS.len()));
        let [.., rust, python] = STEPS else { panic!("steps") };
        assert!(matches!(rust.action, Action::Cargo(["test", "--workspace"])));
        assert!(matches!(python.action, Action::Python));
    }

    #[test]
    fn the_first_failure_stops_the_run_and_is_named() {
        for (broken, step) in STEPS.iter().enumerate() {
            let mut count = 0;
            let done = until_failure(|_| {
                count += 1;
                if count == broken + 1 { Err("planted".to_owned()) } else { Ok(()) }
            });
            let said = done.expect_err("planted");
            assert!(said.contains(step.name) && said.contains("planted"), "{said}");
            assert_eq!(count, broken + 1);
        }
    }
}
