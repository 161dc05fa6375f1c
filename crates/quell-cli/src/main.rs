//! The command line of Quell: parse, hand to the front door, show. No physics.

use std::process::ExitCode;

mod answer;
mod arguments;
mod cli;
mod help;
mod interrupt;
mod progress;
mod verbs;

fn main() -> ExitCode {
    interrupt::handle();
    cli::run(std::env::args_os())
}
