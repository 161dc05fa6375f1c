//! `quell cite`: what a study's computations rest on.

use clap::Args;
use quell::Failure;
use quell::kind::verbs;

use crate::answer::Answer;
use crate::arguments::StudyArguments;

/// Lists the equations and papers that a study's computations use, and corrections of the printed text
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    study: StudyArguments,
    /// Prints BibTeX entries instead
    #[arg(long)]
    bibtex: bool,
}

/// Answers.
pub(crate) fn run(arguments: &Arguments) -> Result<Answer, Failure> {
    let study = arguments.study.read()?;
    let verbs = verbs(&study)?;
    let done = verbs.cite();
    let text = || if arguments.bibtex { verbs.sources().bibtex() } else { done.text() };
    Ok(Answer::new(arguments.study.json, &done.json(), text))
}
