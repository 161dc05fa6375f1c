//! The command line of Quell: parses arguments, calls the library `quell`, and prints answers. It contains no physics.

use std::process::ExitCode;

mod answer;
mod arguments;
mod cli;
mod help;
mod hint;
mod interrupt;
mod progress;
mod verbs;

fn main() -> ExitCode {
    interrupt::handle();
    cli::run(std::env::args_os())
}
