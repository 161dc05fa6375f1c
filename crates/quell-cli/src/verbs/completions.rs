//! `quell completions`: shell scripts that complete verbs and options.

use clap::Args;
use clap_complete::{Shell, generate};
use quell::Failure;
use serde_json::Value as Json;

use crate::answer::Answer;
use crate::help;

/// Prints a script that completes verbs and options in a shell
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// Name of the shell
    #[arg(value_name = "SHELL")]
    shell: Shell,
}

/// Runs the verb.
pub(crate) fn run(arguments: &Arguments) -> Result<Answer, Failure> {
    let mut script = Vec::new();
    generate(arguments.shell, &mut help::command(), "quell", &mut script);
    let script = String::from_utf8(script)
        .map_err(|why| Failure::Failed { key: "completions".to_owned(), why: why.to_string() })?;
    Ok(Answer::new(false, &Json::Null, || script))
}
