//! `cargo xtask snapshot` and `cargo xtask twins`: the tests of what the answers mean, asked for more than every run of the tests asks.
//!
//! Both are tests of the command line (`crates/quell-cli/tests/meaning`), which read what is wanted from the environment.

use std::path::Path;

use crate::programs::{cargo, command};

/// Studies that `twins` asks.
const TWINS: &str = "200";

/// Runs the test of a task; `bless`: whether it records what it finds.
///
/// # Errors
/// The test fails, as it has printed.
pub(crate) fn run(root: &Path, task: &str, bless: bool) -> Result<(), String> {
    let mut tests = cargo();
    tests.args(["test", "--workspace", "--test", "meaning", "--", "--nocapture", task]);
    match task {
        "twins" => tests.env("QUELL_TWINS", TWINS),
        _ => tests.env("QUELL_SNAPSHOT", "all"),
    };
    if bless {
        tests.env("QUELL_BLESS", "1");
    }
    command(tests.current_dir(root))
}
