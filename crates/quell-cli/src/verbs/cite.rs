//! `quell cite`: sources of a study's computations.

use clap::Args;
use quell::Failure;
use quell::outcome::named;
use quell::verbs::verbs;

use crate::answer::Answer;
use crate::arguments::StudyArguments;

/// Lists the equations and papers that a study's computations use, and corrections to the printed text
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    study: StudyArguments,
    /// Prints BibTeX entries instead
    #[arg(long)]
    bibtex: bool,
}

/// Runs the verb.
pub(crate) fn run(arguments: &Arguments) -> Result<Answer, Failure> {
    let study = arguments.study.read()?;
    let verbs = verbs(&study);
    let done = verbs.cite();
    let text = || if arguments.bibtex { verbs.sources().bibtex() } else { done.text() };
    Ok(Answer::new(arguments.study.json, &named(done.as_ref(), done.json()), text))
}
