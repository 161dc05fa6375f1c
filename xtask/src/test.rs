//! `cargo xtask test`: everything that must hold before a change is merged.
//!
//! The steps run in order and stop at the first failure, which is reported with its step. The tests come last, all programs of Rust
//! and pytest side by side (`test_run.rs`); what pytest says is printed after everything else, so that a successful run ends with its
//! summary. All steps use one profile (dev, optimised in the root manifest):
//! nothing is compiled twice because of a profile.

use std::path::Path;

use crate::ratchet::RatchetMode;
use crate::{cycles, english, layers, licences, names, programs, python, test_run};

/// One step.
struct TestStep {
    /// Its name.
    name: &'static str,
    /// Its action.
    action: Action,
    /// How to correct a failure.
    advice: &'static str,
}

/// The action of a step.
enum Action {
    /// `cargo` with arguments.
    Cargo(&'static [&'static str]),
    /// Every test.
    Tests,
    /// The tests of Rust without the slow ones.
    Quick,
    /// Another task of this program, by its name.
    Task(&'static str, fn(&Path) -> Result<(), String>),
}

const FORMATTING: TestStep = TestStep {
    name: "formatting",
    action: Action::Cargo(&["fmt", "--all", "--check"]),
    advice: "run `cargo fmt --all`",
};

const LAYERS: TestStep = TestStep {
    name: "layers",
    action: Action::Task("layers", layers::run),
    advice: "reverse the dependency, or move the code",
};

const CYCLES: TestStep = TestStep {
    name: "cycles",
    action: Action::Task("cycles", |root| cycles::run(root, RatchetMode::Check)),
    advice: "move what both modules need into a third, below them",
};

const NAMES: TestStep = TestStep {
    name: "names",
    action: Action::Task("names", |root| names::run(root, RatchetMode::Check)),
    advice: "give the type a name of its own",
};

const ENGLISH: TestStep = TestStep {
    name: "english",
    action: Action::Task("english", |root| english::run(root, RatchetMode::Check)),
    advice: "replace the word, or give it an exception with a reason in xtask/src/english/words.rs",
};

#[rustfmt::skip]
const STEPS: &[TestStep] = &[
    FORMATTING,
    TestStep {
        name: "lints",
        action: Action::Cargo(&["clippy", "--workspace", "--all-targets", "--", "-D", "warnings"]),
        advice: "fix the lints that clippy reports, or add `#[expect(lint, reason = \"…\")]`",
    },
    LAYERS,
    CYCLES,
    NAMES,
    ENGLISH,
    TestStep {
        name: "licences",
        action: Action::Task("licences", licences::run),
        advice: "choose another crate, or argue for its licence in xtask/src/licences.rs",
    },
    TestStep {
        name: "documentation",
        action: Action::Cargo(&["doc", "--workspace", "--no-deps"]),
        advice: "fix the doc comments that rustdoc reports",
    },
    TestStep {
        name: "examples in the documentation",
        action: Action::Cargo(&["test", "--workspace", "--doc"]),
        advice: "see the failing example above",
    },
    TestStep {
        name: "tests",
        action: Action::Tests,
        advice: "see the failing tests above; the environment of Python is in target/python",
    },
];

/// Tests that take half a minute or more, which `--quick` omits.
const SLOW: &[&str] = &[
    "a_million_random_steps_close_the_balance_of_work",
    "data_have_the_documented_columns",
    "every_entry_is_made",
    "statements_are_counted_not_claims",
    "verdicts_are_those_on_record",
    "runs_from_rest_have_both_thresholds_in_any_window",
    "studies_commands_answers_and_pictures_are_true",
    "the_reader_of_stores_detects_damage",
    "the_reader_of_studies_rejects_with_complaints",
    "thresholds_answer_with_the_number",
    "thresholds_tell_each_protocol_apart",
];

/// The steps of `--quick`: without lints, licences, documentation, slow tests and Python.
#[rustfmt::skip]
const QUICK: &[TestStep] = &[
    FORMATTING,
    LAYERS,
    CYCLES,
    NAMES,
    ENGLISH,
    TestStep {
        name: "tests without the slow ones",
        action: Action::Quick,
        advice: "see the failing test above",
    },
];

/// Runs every step in the workspace at `root`, or those of `--quick`.
///
/// # Errors
/// The name of the first step that failed, and how to correct it.
pub(crate) fn run(root: &Path, quick: bool) -> Result<(), String> {
    let steps = if quick { QUICK } else { STEPS };
    until_failure(steps, |action| match action {
        Action::Tests => {
            let programs = test_run::built(root, &[])?;
            test_run::run(programs, Some(python::tests(root)?))
        }
        Action::Quick => {
            let skipped: Vec<&str> = SLOW.iter().flat_map(|name| ["--skip", name]).collect();
            test_run::run(test_run::built(root, &skipped)?, None)
        }
        Action::Cargo(arguments) => cargo(root, arguments),
        Action::Task(_, run) => run(root),
    })
}

/// Runs the steps with `act` and stops at the first that fails.
fn until_failure(
    steps: &[TestStep],
    mut act: impl FnMut(&Action) -> Result<(), String>,
) -> Result<(), String> {
    for (index, step) in steps.iter().enumerate() {
        let command = match step.action {
            Action::Cargo(arguments) => format!("cargo {}", arguments.join(" ")),
            Action::Tests => "cargo test --workspace, with cargo xtask python".to_owned(),
            Action::Quick => "cargo test --workspace -- --skip …".to_owned(),
            Action::Task(name, _) => format!("cargo xtask {name}"),
        };
        eprintln!("[{}/{}] {}: {command}", index + 1, steps.len(), step.name);
        act(&step.action).map_err(|why| {
            format!("{why}\nxtask test: FAILED at {}: {}", step.name, step.advice)
        })?;
    }
    Ok(())
}

/// Runs the `cargo` that runs this task. Warnings of rustdoc are errors.
fn cargo(root: &Path, arguments: &[&str]) -> Result<(), String> {
    let mut cargo = programs::cargo();
    programs::command(cargo.args(arguments).current_dir(root).env("RUSTDOCFLAGS", "-D warnings"))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The tasks of this program among steps.
    fn tasks(steps: &[TestStep]) -> Vec<&'static str> {
        let task = |step: &TestStep| match step.action {
            Action::Task(name, _) => Some(name),
            Action::Cargo(_) | Action::Tests | Action::Quick => None,
        };
        steps.iter().filter_map(task).collect()
    }

    /// What the user reads last is the summary of the tests.
    #[test]
    fn the_tests_come_last() {
        let mut run = Vec::new();
        let done = until_failure(STEPS, |action| {
            run.push(match action {
                Action::Cargo(arguments) => arguments[0],
                Action::Tests => "tests",
                Action::Quick => "quick",
                Action::Task(name, _) => name,
            });
            Ok(())
        });
        assert_eq!((done, run.len()), (Ok(()), STEPS.len()));
        assert_eq!(run[run.len() - 2..], ["test", "tests"]);
        assert!(!run[..run.len() - 2].contains(&"test"));
    }

    /// `--quick` leaves out what takes long, and no check of the sources.
    #[test]
    fn quick_has_every_check_that_is_quick() {
        let slow = ["licences"];
        let expected: Vec<&str> =
            tasks(STEPS).into_iter().filter(|task| !slow.contains(task)).collect();
        assert_eq!(tasks(QUICK), expected);
        assert!(expected.len() > 3);
        for task in slow {
            assert!(tasks(STEPS).contains(&task), "{task}");
        }
    }

    #[test]
    fn the_first_failure_stops_the_run_and_is_reported() {
        for (broken, step) in STEPS.iter().enumerate() {
            let mut count = 0;
            let done = until_failure(STEPS, |_| {
                count += 1;
                if count == broken + 1 { Err("planted".to_owned()) } else { Ok(()) }
            });
            let report = done.expect_err("planted");
            assert!(report.contains(step.name) && report.contains("planted"), "{report}");
            assert!(report.contains(step.advice), "{report}");
            assert_eq!(count, broken + 1);
        }
    }

    /// A slow test that was renamed would run under `--quick` again without notice.
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
