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
    /// The tests of Rust but the slow ones.
    Quick,
    /// The check of dependency arrows.
    Layers,
    /// The check of licences.
    Licences,
    /// The wheel, in an environment of its own, and the tests of Python.
    Python,
}

const FORMATTING: Step = Step {
    name: "formatting",
    action: Action::Cargo(&["fmt", "--all", "--check"]),
    advice: "run `cargo fmt --all`",
};

const ARROWS: Step = Step {
    name: "layers",
    action: Action::Layers,
    advice: "turn the arrow round, or move the code",
};

#[rustfmt::skip]
const STEPS: &[Step] = &[
    FORMATTING,
    Step {
        name: "lints",
        action: Action::Cargo(&["clippy", "--workspace", "--all-targets", "--", "-D", "warnings"]),
        advice: "mend what clippy names, or `#[expect(lint, reason = \"…\")]`",
    },
    ARROWS,
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

/// Tests of half a minute or more, which `--quick` leaves out.
const SLOW: &[&str] = &[
    "a_million_random_steps_close_the_balance_of_work",
    "every_entry_is_made",
    "runs_from_rest_have_both_thresholds_in_any_window",
    "studies_commands_and_answers_are_true",
    "the_reader_of_stores_believes_no_damage",
    "the_reader_of_studies_refuses_in_words",
    "thresholds_answer_with_the_number",
    "thresholds_tell_each_protocol_apart",
];

/// The steps of `--quick`: without documentation, the slow tests and Python.
#[rustfmt::skip]
const QUICK: &[Step] = &[
    FORMATTING,
    ARROWS,
    Step {
        name: "tests but the slow ones",
        action: Action::Quick,
        advice: "the failing test is named above",
    },
];

/// Runs every step in the workspace at `root`, or those of `--quick`.
///
/// # Errors
/// The name of the first step that failed, and what to do about it.
pub(crate) fn run(root: &Path, quick: bool) -> Result<(), String> {
    let steps = if quick { QUICK } else { STEPS };
    until_failure(steps, |action| match action {
        Action::Quick => {
            let skipped = SLOW.iter().flat_map(|name| ["--skip", name]);
            let words: Vec<&str> =
                ["test", "--workspace", "--"].into_iter().chain(skipped).collect();
            cargo(root, &words)
        }
        Action::Cargo(arguments) => cargo(root, arguments),
        Action::Layers => layers::run(root),
        Action::Licences => licences::run(root),
        Action::Python => python::run(root),
    })
}

/// Runs the steps with `act` and stops at the first that fails.
fn until_failure(
    steps: &[Step],
    mut act: impl FnMut(&Action) -> Result<(), String>,
) -> Result<(), String> {
    for (index, step) in steps.iter().enumerate() {
        let command = match step.action {
            Action::Cargo(arguments) => format!("cargo {}", arguments.join(" ")),
            Action::Quick => "cargo test --workspace -- --skip …".to_owned(),
            Action::Layers => "cargo xtask layers".to_owned(),
            Action::Licences => "cargo xtask licences".to_owned(),
            Action::Python => "cargo xtask python".to_owned(),
        };
        eprintln!("[{}/{}] {}: {command}", index + 1, steps.len(), step.name);
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
        let done = until_failure(STEPS, |_| {
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
            let done = until_failure(STEPS, |_| {
                count += 1;
                if count == broken + 1 { Err("planted".to_owned()) } else { Ok(()) }
            });
            let said = done.expect_err("planted");
            assert!(said.contains(step.name) && said.contains("planted"), "{said}");
            assert_eq!(count, broken + 1);
        }
    }

    /// A test that was renamed would be run by `--quick` again, unseen.
    #[test]
    fn slow_tests_exist() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
        let mut text = String::new();
        for crates in std::fs::read_dir(root.join("crates")).expect("crates") {
            let tests = crates.expect("a crate").path().join("tests");
            for file in std::fs::read_dir(tests).into_iter().flatten() {
                let path = file.expect("a file").path();
                if path.is_file() {
                    text += &std::fs::read_to_string(path).expect("text");
                }
            }
        }
        for name in SLOW {
            assert!(text.contains(&format!("fn {name}()")), "{name}");
        }
    }
}
