//! `quell schema`: the JSON Schema of a study file.

use clap::Args;
use quell::schema::schema;

use crate::answer::Answer;

/// Prints the JSON Schema of a study file
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// Prints the schema on one line
    #[arg(long)]
    json: bool,
}

/// Runs the verb.
pub(crate) fn run(arguments: &Arguments) -> Answer {
    Answer::new(arguments.json, &schema(), || format!("{:#}\n", schema()))
}
