//! Chores of the workspace: `cargo xtask layers`, `cargo xtask test`.

use std::path::Path;
use std::process::ExitCode;

mod layers;
mod manifest;
mod test;

const USAGE: &str = "usage: cargo xtask CHORE

chores:
  layers   dependency arrows and confined dependencies against the table of layers
  test     everything that must hold before a change is merged, tests last";

fn main() -> ExitCode {
    // xtask lies directly below the root of the workspace.
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let done = match arguments.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        ["layers"] => layers::run(&root),
        ["test"] => test::run(&root),
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
