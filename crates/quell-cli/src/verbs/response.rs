//! `quell response`: the steady response, the effect of the dither on it, and the cost of the dither.

use clap::Args;
use quell::Failure;
use quell::kind::verbs;

use crate::answer::Answer;
use crate::arguments::{Gathered, OutputArguments, PlotArguments, StudyArguments, answer, inputs};

/// Measures the steady response with and without dither, and the cost of the dither
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    study: StudyArguments,
    #[command(flatten)]
    plot: PlotArguments,
    #[command(flatten)]
    output: OutputArguments,
}

/// Runs the verb.
pub(crate) fn run(arguments: &Arguments) -> Result<Answer, Failure> {
    let mut complaints = Gathered::default();
    let study = complaints.take(arguments.study.read());
    let inputs = inputs(study.as_ref());
    let outputs = complaints.take(arguments.output.prepare(&["spectrum"], &inputs));
    let plot = complaints.take(arguments.plot.prepare(&inputs));
    let (study, (outputs, plot)) = complaints.finish(study.zip(outputs.zip(plot)))?;

    let done = verbs(&study).response()?;
    answer(arguments.study.json, done.as_ref(), outputs, plot)
}
