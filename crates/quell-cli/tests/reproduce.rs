//! `quell reproduce` as a process.

use std::process::{Command, Output};

use serde_json::Value;

fn quell(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_quell")).args(arguments).output().expect("quell runs")
}

#[test]
fn figures_are_written() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("figures");
    let out = out.to_str().expect("a path");
    let done = quell(&["reproduce", "2.2", "table-5.1", "--out", out, "--json"]);
    assert_eq!(done.status.code(), Some(0), "{}", String::from_utf8_lossy(&done.stderr));
    let object: Value = serde_json::from_slice(&done.stdout).expect("one JSON object");
    assert_eq!(object["ok"], true);
    assert_eq!(object["entries"][0]["name"], "2.2");
    assert_eq!(object["entries"][1]["name"], "table-5.1");
    for entry in object["entries"].as_array().expect("entries") {
        for file in entry["files"].as_array().expect("files") {
            let path = file.as_str().expect("a path");
            assert!(std::fs::metadata(path).expect(path).len() > 1000, "{path}");
        }
    }
}

#[test]
fn unknown_names_and_unwritable_directories_are_rejected() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("file");
    std::fs::write(&file, "").expect("written");
    let done = quell(&["reproduce", "2.9x", "--out", "anywhere", "--json"]);
    assert_eq!(done.status.code(), Some(2));
    let object: Value = serde_json::from_slice(&done.stdout).expect("one JSON object");
    assert!(object["errors"][0]["allowed"].as_str().expect("text").contains("2.2, 2.3"));
    let done = quell(&["reproduce", "2.2", "--out", file.to_str().expect("a path")]);
    assert_eq!(done.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&done.stderr).contains("--out"));
    assert!(!folder.path().join("file/figure-2.2.svg").exists());
}

#[test]
fn a_figure_with_ones_own_numbers_is_one_command() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("mine");
    let out = out.to_str().expect("a path");
    let set = "friction.reference_velocity=0.3";
    let done = quell(&["reproduce", "2.4", "--set", set, "--no-title", "--out", out, "--json"]);
    assert_eq!(done.status.code(), Some(0), "{}", String::from_utf8_lossy(&done.stderr));
    let object: Value = serde_json::from_slice(&done.stdout).expect("one JSON object");
    assert_eq!(object["changes"][0], "friction.reference_velocity=0.3");
    assert_eq!(object["entries"][0]["own"], true);
    let svg =
        std::fs::read_to_string(folder.path().join("mine/own-figure-2.4.svg")).expect("a picture");
    assert!(svg.contains("Own numbers") && !svg.contains("Figure 2.4"), "{}", &svg[..600]);
    let report = std::fs::read_to_string(folder.path().join("mine/report.html")).expect("a report");
    assert!(
        report.contains("None of them is a figure of the dissertation")
            && !report.contains("<h3>Figure 2.4")
    );
    let done = quell(&["reproduce", "--set", set, "--out", out]);
    assert_eq!(done.status.code(), Some(2));
}
