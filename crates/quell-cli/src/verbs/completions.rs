//! `quell completions`: shell scripts that complete verbs and options.

use clap::{Args, Command};
use clap_complete::{Shell, generate};
use quell::Failure;
use serde_json::Value as Json;

use crate::answer::Answer;

/// Prints a script that completes verbs and options in a shell
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// Name of the shell
    #[arg(value_name = "SHELL")]
    shell: Shell,
}

/// Prints the script for the command line `command`.
pub(crate) fn run(arguments: &Arguments, command: &mut Command) -> Result<Answer, Failure> {
    let mut script = Vec::new();
    generate(arguments.shell, command, "quell", &mut script);
    let script = String::from_utf8(script).map_err(|why| Failure::Failed {
        key: "completions".to_owned(),
        why: why.to_string().into(),
    })?;
    Ok(Answer::new(false, &Json::Null, || script))
}
