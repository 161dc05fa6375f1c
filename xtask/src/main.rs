//! Development tasks of the workspace: `cargo xtask test` and its parts, `cargo xtask book` and others.

use std::path::Path;
use std::process::ExitCode;

mod book;
mod coverage;
mod cycles;
mod dist;
mod english;
mod layers;
mod licences;
mod manifest;
mod meaning;
mod names;
mod package;
mod places;
mod platforms;
mod programs;
mod python;
mod ratchet;
mod source;
mod test;
mod test_run;

use ratchet::RatchetMode;

const USAGE: &str = "usage: cargo xtask TASK

tasks:
  book               build the book with its pictures in target/book
  coverage [CRATE]   list the lines that no test reaches in target/coverage [default: all crates]
  cycles [OPTION]    check that no modules of a crate use each other in a ring
  dist               build what a release consists of for this platform: program, wheel, checksums
  english [OPTION]   check that texts avoid the words of xtask/src/english/words.rs
  layers             check dependencies between crates, and confined dependencies, against the table of layers
  licences           check the licences of all dependencies against the accepted ones
  names [OPTION]     check that the names of types are unique in the workspace
  package            pack every crate for publication, in order
  platforms [NAME]   compare the answers on Windows and 64-bit ARM, under wine and qemu, with those here byte by byte
  python             build the wheel, install it into target/python, and run the Python tests
  snapshot [OPTION]  compare the answers of every study in studies/, through every verb, with those on record
  test               check everything that must hold before a change is merged, tests last;
                     --quick omits lints, documentation, licences, slow tests and Python
  twins [OPTION]     ask 200 studies, written as a kind of their own and as a system, for differences beyond the known ones

options of cycles, english and names:
  --bless            record counts that have fallen, in xtask/TASK.toml
  --list             print all that is counted, with files and lines

option of snapshot and twins:
  --bless            write the answers again, or remove differences that are gone  --list             print all that is counted, with files and lines";

fn main() -> ExitCode {
    if std::env::var_os(coverage::COMPILES).is_some() {
        return coverage::compile(std::env::args_os().skip(1));
    }
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    // xtask is directly below the root of the workspace.
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    match run(&root, &arguments) {
        Some(Ok(())) => ExitCode::SUCCESS,
        Some(Err(why)) => {
            eprintln!("{why}");
            ExitCode::FAILURE
        }
        None => {
            eprintln!("{USAGE}");
            ExitCode::from(2)
        }
    }
}

/// Runs a task; `None` if there is no such task, or not with these arguments.
fn run(root: &Path, arguments: &[&str]) -> Option<Result<(), String>> {
    let (task, options) = arguments.split_first()?;
    let option = match options {
        [] => None,
        [option] => Some(*option),
        _ => return None,
    };
    let mode = RatchetMode::from_option(option);
    let done = match (*task, option) {
        ("coverage", name) if !name.is_some_and(|name| name.starts_with('-')) => {
            coverage::run(root, name)
        }
        ("platforms", name) if !name.is_some_and(|name| name.starts_with('-')) => {
            platforms::run(root, name)
        }
        ("cycles", _) => cycles::run(root, mode?),
        ("english", _) => english::run(root, mode?),
        ("names", _) => names::run(root, mode?),
        ("snapshot" | "twins", None | Some("--bless")) => {
            meaning::run(root, task, option.is_some())
        }
        ("test", Some("--quick")) => test::run(root, true),
        ("dist", None) => dist::run(root),
        ("book", None) => book::run(root),
        ("layers", None) => layers::run(root),
        ("licences", None) => licences::run(root),
        ("package", None) => package::run(root),
        ("python", None) => python::run(root),
        ("test", None) => test::run(root, false),
        _ => return None,
    };
    Some(done)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn unknown_tasks_and_options_are_refused() {
        for arguments in [
            &[][..],
            &["no-such-task"],
            &["layers", "--bless"],
            &["cycles", "--all"],
            &["coverage", "--all"],
            &["platforms", "--all"],
            &["twins", "--list"],
            &["test", "--quick", "more"],
        ] {
            assert!(run(Path::new("."), arguments).is_none(), "{arguments:?}");
        }
    }
}
