//! `quell stability`: stability of steady sliding by averaging, or of a disc by eigenvalues or Floquet exponents.

use clap::Args;
use quell::Failure;
use quell::kind::verbs;

use crate::answer::Answer;
use crate::arguments::{Gathered, Outputs, PlotArguments, StudyArguments, answer, inputs};

/// Decides whether steady sliding (by averaging) or a disc (by eigenvalues) is stable, and what would change that
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    study: StudyArguments,
    #[command(flatten)]
    plot: PlotArguments,
}

/// Runs the verb.
pub(crate) fn run(arguments: &Arguments) -> Result<Answer, Failure> {
    let mut complaints = Gathered::default();
    let study = complaints.take(arguments.study.read());
    let inputs = inputs(study.as_ref());
    let plot = complaints.take(arguments.plot.prepare(&inputs));
    let (study, plot) = complaints.finish(study.zip(plot))?;
    let done = verbs(&study).stability()?;
    answer(arguments.study.json, done.as_ref(), Outputs::none(), plot)
}
