//! Chores of the workspace: `cargo xtask test` and its parts, `cargo xtask book`.

use std::path::Path;
use std::process::ExitCode;

mod book;
mod coverage;
mod layers;
mod licences;
mod manifest;
mod package;
mod python;
mod source;
mod test;

const USAGE: &str = "usage: cargo xtask CHORE

chores:
  book      the book with its pictures, in target/book
  coverage  the lines that no test reaches, in target/coverage
  layers    dependency arrows and confined dependencies against the table of layers
  licences  licences of all dependencies against the accepted ones
  package   every crate packed for publication, in order
  python    the wheel, in an environment of its own (target/python), and the tests of Python
  test      everything that must hold before a change is merged, tests last;
            --quick: without documentation, the slow tests and Python";

fn main() -> ExitCode {
    if std::env::var_os(coverage::COMPILES).is_some() {
        return coverage::compile(std::env::args_os().skip(1));
    }
    // xtask lies directly below the root of the workspace.
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let done = match arguments.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        ["book"] => book::run(&root),
        ["coverage"] => coverage::run(&root, None),
        ["layers"] => layers::run(&root),
        ["licences"] => licences::run(&root),
        ["package"] => package::run(&root),
        ["python"] => python::run(&root),
        ["test"] => test::run(&root, false),
        ["test", "--quick"] => test::run(&root, true),
        _ => {
            eprintln!("{USAGE}");
            return ExitCode::from(2);
        }
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(why) => {
            eprintln!("{why}");
            ExitCode::FAILURE
        }
    }
}
