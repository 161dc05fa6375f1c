//! The binary in the repository, for tests of its studies.

use std::path::Path;
use std::process::Command;

use serde_json::Value as Json;

fn run(arguments: &[&str]) -> (String, i32) {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let done = Command::new(env!("CARGO_BIN_EXE_quell"))
        .args(arguments)
        .current_dir(root)
        .output()
        .expect("the binary runs");
    (String::from_utf8(done.stdout).expect("text"), done.status.code().expect("a status"))
}

/// Runs a verb with `--json`: the object and the exit status.
pub(crate) fn quell(arguments: &[&str]) -> (Json, i32) {
    let (text, status) = run(&[arguments, &["--json"]].concat());
    (serde_json::from_str(&text).expect("one object"), status)
}

/// Runs a verb and returns its text output.
pub(crate) fn words(arguments: &[&str]) -> String {
    let (text, status) = run(arguments);
    assert_eq!(status, 0, "{text}");
    text
}
