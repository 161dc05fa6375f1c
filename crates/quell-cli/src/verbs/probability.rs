//! `quell probability`: how probable it is that a study with uncertain numbers vibrates.

use clap::Args;
use quell::Failure;
use quell::run::probability::{ProbabilityRequest, ProbabilityStart};
use quell::running::Running;
use quell::verbs::verbs;

use super::map::threads;
use super::numbers::count;
use crate::answer::Answer;
use crate::arguments::{Gathered, OutputArguments, PlotArguments, StudyArguments, answer, inputs};
use crate::interrupt;
use crate::progress::Bar;

/// Estimates the probability that a study with uncertain numbers vibrates, from random samples of [uncertainty]
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    study: StudyArguments,
    /// What decides: averaged, local (multipliers of the base response), rest or squeal (the end of a run)
    #[arg(long, value_name = "START", default_value = "averaged")]
    start: String,
    /// Number of samples [default: 100000, of exact motions 1000]
    #[arg(long, value_name = "N", allow_hyphen_values = true)]
    samples: Option<String>,
    /// Seed of the random numbers
    #[arg(long, value_name = "SEED", default_value = "1", allow_hyphen_values = true)]
    seed: String,
    /// Number of threads [default: all cores]
    #[arg(long, value_name = "N", allow_hyphen_values = true)]
    threads: Option<String>,
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
    let start = complaints.take(ProbabilityStart::named(&arguments.start));
    let samples = arguments.samples.as_deref().map(|text| count("--samples", text)).transpose();
    let samples = complaints.take(samples);
    let seed = complaints.take(count("--seed", &arguments.seed));
    let threads = complaints.take(threads(arguments.threads.as_deref()));
    let outputs = complaints.take(arguments.output.prepare(&[], &inputs));
    let plot = arguments.plot.prepare(&inputs);
    let plot = complaints.take(plot.and_then(|plot| plot.drawn_by(study.as_ref(), "probability")));
    let asked = start.zip(samples.zip(seed));
    let ((study, (start, (samples, seed))), (threads, (outputs, plot))) =
        complaints.finish(study.zip(asked).zip(threads.zip(outputs.zip(plot))))?;
    let bar = Bar::new();
    let running = Running { threads, stop: interrupt::flag(), progress: &bar };
    let request = ProbabilityRequest { samples, seed: seed as u64, start };
    let done = verbs(&study).probability(request, running)?;
    answer(arguments.study.json, done.as_ref(), outputs, plot)
}
