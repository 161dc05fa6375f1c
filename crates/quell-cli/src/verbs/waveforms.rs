//! `quell waveforms`: the least dither of each waveform that quenches, and its cost.

use clap::Args;
use quell::Failure;
use quell::verbs::verbs;

use crate::answer::Answer;
use crate::arguments::{Gathered, OutputArguments, PlotArguments, StudyArguments, answer, inputs};

/// Compares waveforms of the dither: the least amplitude that quenches, and its force, power and stroke
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    study: StudyArguments,
    #[command(flatten)]
    output: OutputArguments,
    #[command(flatten)]
    plot: PlotArguments,
}

/// Runs the verb.
pub(crate) fn run(arguments: &Arguments) -> Result<Answer, Failure> {
    let mut complaints = Gathered::default();
    let study = complaints.take(arguments.study.read());
    let inputs = inputs(study.as_ref());
    let outputs = complaints.take(arguments.output.prepare(&[], &inputs));
    let plot = arguments.plot.prepare(&inputs);
    let plot = complaints.take(plot.and_then(|plot| plot.drawn_by(study.as_ref(), "waveforms")));
    let (study, (outputs, plot)) = complaints.finish(study.zip(outputs.zip(plot)))?;

    let done = verbs(&study).waveforms()?;
    answer(arguments.study.json, done.as_ref(), outputs, plot)
}
