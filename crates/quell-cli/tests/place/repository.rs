//! The real binary in the repository, for tests of its studies.

use std::path::Path;
use std::process::Command;

use serde_json::Value as Json;

/// Runs a verb with `--json`: the object and the exit status.
pub(crate) fn quell(arguments: &[&str]) -> (Json, i32) {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let done = Command::new(env!("CARGO_BIN_EXE_quell"))
        .args(arguments)
        .arg("--json")
        .current_dir(root)
        .output()
        .expect("the binary runs");
    let text = String::from_utf8(done.stdout).expect("text");
    (serde_json::from_str(&text).expect("one object"), done.status.code().expect("a status"))
}
