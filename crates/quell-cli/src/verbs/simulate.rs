//! `quell simulate`: one trajectory with its events.

use clap::Args;
use quell::Failure;
use quell::kind::verbs;
use quell::run::simulate::Options;

use super::numbers::duration;
use crate::answer::Answer;
use crate::arguments::{Gathered, OutputArguments, PlotArguments, StudyArguments, answer, inputs};

/// Simulates one run and locates every event at the contact
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    study: StudyArguments,
    /// Duration τ; in a study in SI in seconds, or a time such as 50ms
    #[arg(long, value_name = "T", allow_hyphen_values = true)]
    until: String,
    /// Lists every event; with --save also writes them to a second file, such as run_events.csv next to run.csv
    #[arg(long)]
    events: bool,
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
    let until = complaints.take(duration("--until", &arguments.until, study.as_ref()));
    let parts: &[&str] = if arguments.events { &["events"] } else { &[] };
    let outputs = complaints.take(arguments.output.prepare(parts, &inputs));
    let plot = complaints.take(arguments.plot.prepare(&inputs));
    let ((study, until), (outputs, plot)) =
        complaints.finish(study.zip(until).zip(outputs.zip(plot)))?;

    let options = Options {
        events: arguments.events,
        samples: arguments.output.saves() || plot.wanted(),
        undithered: plot.wanted(),
    };
    let done = verbs(&study).simulate(until, options)?;
    answer(arguments.study.json, done.as_ref(), outputs, plot)
}
