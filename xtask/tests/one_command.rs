//! The README and `.ci/run` name the same command: anyone who follows the README runs the checks
//! that every change must pass.

use std::path::Path;

/// Commands of a shell script, without its settings and comments.
fn commands(script: &str) -> Vec<&str> {
    script
        .lines()
        .map(str::trim)
        .filter(|line| !(line.is_empty() || line.starts_with('#') || line.starts_with("set -")))
        .collect()
}

/// The commands without the one block that installs a Debian package where it is missing.
fn without_installation(commands: Vec<&str>) -> Vec<&str> {
    let installs = |line: &&str| line.starts_with("if ! command -v") && line.contains("apt-get");
    let begin = commands.iter().position(installs);
    let end = commands.iter().position(|line| *line == "fi");
    match (begin, end) {
        (Some(begin), Some(end)) if begin < end => {
            [&commands[..begin], &commands[end + 1..]].concat()
        }
        _ => commands,
    }
}

/// The words before the command in the README.
const INTRODUCTION: &str = "everything that must pass:";

/// Lines of the code block that the README introduces as everything that must pass.
fn readme_test_commands(readme: &str) -> Vec<&str> {
    let mut after = readme
        .lines()
        .skip_while(|line| !line.ends_with(INTRODUCTION))
        .skip(1)
        .skip_while(|line| line.is_empty());
    if !after.next().is_some_and(|line| line.starts_with("```")) {
        return Vec::new();
    }
    after.take_while(|line| !line.starts_with("```")).collect()
}

fn read(name: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(name);
    std::fs::read_to_string(&path).unwrap_or_else(|why| panic!("{}: {why}", path.display()))
}

#[test]
fn readme_and_ci_run_the_same_one_command() {
    let (script, readme) = (read(".ci/run"), read("README.md"));
    let commands = without_installation(commands(&script));
    assert_eq!(commands, ["cargo xtask test"], ".ci/run");
    assert_eq!(readme_test_commands(&readme), commands, "README.md");
}

#[test]
fn the_script_stops_at_the_first_error() {
    let script = read(".ci/run");
    assert!(script.starts_with("#!/usr/bin/env bash\n"));
    assert!(script.lines().any(|line| line == "set -eu"));
}

#[cfg(unix)]
#[test]
fn the_script_can_be_executed() {
    use std::os::unix::fs::PermissionsExt;
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../.ci/run");
    let mode = path.metadata().expect(".ci/run exists").permissions().mode();
    assert_eq!(mode & 0o111, 0o111, "mode {mode:o}");
}

#[test]
fn planted_differences_are_found() {
    let readme = "```sh\nquell --help\n```\nand everything that must pass:\n\n\
                  ```sh\ncargo test\n```\n```\nx\n```\n";
    assert_eq!(readme_test_commands(readme), ["cargo test"]);
    let text = "Run everything that must pass:\n\nText.\n```sh\ncargo xtask test\n```\n";
    assert!(readme_test_commands(text).is_empty());
    assert!(readme_test_commands("```sh\ncargo xtask test\n```\n").is_empty());
    assert_eq!(
        commands("#!/bin/sh\nset -eu\ncargo xtask test\ntrue\n"),
        ["cargo xtask test", "true"]
    );
}
