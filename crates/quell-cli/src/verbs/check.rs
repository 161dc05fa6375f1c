//! `quell check`: validation of a study.

use clap::Args;
use quell::Failure;
use quell::verbs::verbs;

use crate::answer::Answer;
use crate::arguments::{Outputs, Plot, StudyArguments, answer};

/// Checks a study file and prints its values
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    study: StudyArguments,
}

/// Runs the verb.
pub(crate) fn run(arguments: &Arguments) -> Result<Answer, Failure> {
    let study = arguments.study.read()?;
    let done = verbs(&study).check()?;
    answer(arguments.study.json, done.as_ref(), Outputs::none(), Plot::none())
}
