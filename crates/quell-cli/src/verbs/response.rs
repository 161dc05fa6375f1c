//! `quell response`: the steady response, the effect of the dither on it, and the cost of the dither.

use clap::{Args, ValueHint};
use quell::run::response::{ResponseRequest, ResponseTexts};
use quell::verbs::verbs;
use quell::{Complaint, Failure, Study};

use crate::answer::Answer;
use crate::arguments::{Gathered, OutputArguments, PlotArguments, StudyArguments, answer, inputs};

/// Measures the steady response with and without dither, and the cost of the dither
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    study: StudyArguments,
    /// Time before the record, in the units of the study or with a unit such as 50ms [default: that of solver.settle; of a system 200 periods
    /// of the slowest oscillation]
    #[arg(long, value_name = "T", allow_hyphen_values = true, value_hint = ValueHint::Other)]
    settle: Option<String>,
    /// Length of the record, in the units of the study or with a unit such as 50ms [default: that of solver.record_periods; of a system 60
    /// periods of the slowest oscillation]
    #[arg(long, value_name = "T", allow_hyphen_values = true, value_hint = ValueHint::Other)]
    record: Option<String>,
    /// Measures the run between two of its times instead of a steady response, such as 100:200
    #[arg(long, value_name = "A:B", allow_hyphen_values = true, value_hint = ValueHint::Other,
        conflicts_with_all = ["settle", "record"])]
    window: Option<String>,
    /// Under noise: number of runs, each with another seed, of which the share that ends quiet is counted [default: 16]
    #[arg(long, value_name = "N", value_hint = ValueHint::Other, conflicts_with = "window")]
    seeds: Option<usize>,
    #[command(flatten)]
    plot: PlotArguments,
    #[command(flatten)]
    output: OutputArguments,
}

impl Arguments {
    /// The two times of --window.
    fn window(&self) -> Result<Option<(&str, &str)>, Failure> {
        let Some(text) = &self.window else { return Ok(None) };
        text.split_once(':').map(Some).ok_or_else(|| {
            let allowed = "two times with a colon between them, such as 100:200";
            Complaint::option("--window", text.as_str(), allowed).into()
        })
    }
}

/// Runs the verb.
pub(crate) fn run(arguments: &Arguments) -> Result<Answer, Failure> {
    let mut complaints = Gathered::default();
    let study = complaints.take(arguments.study.read());
    let inputs = inputs(study.as_ref());
    let outputs = complaints.take(arguments.output.prepare(&["spectrum"], &inputs));
    let plot = complaints.take(arguments.plot.prepare(&inputs));
    let window = complaints.take(arguments.window());
    let moving = study.as_ref().map(Study::system);
    let texts = ResponseTexts {
        settle: arguments.settle.as_deref(),
        record: arguments.record.as_deref(),
        window: window.flatten(),
    };
    let request = complaints.take(moving.as_ref().map(|system| texts.read(system)).transpose());
    let ((study, request), (outputs, plot)) =
        complaints.finish(study.zip(request).zip(outputs.zip(plot)))?;
    let request = ResponseRequest { seeds: arguments.seeds, ..request.unwrap_or_default() };
    let done = verbs(&study).response(&request)?;
    answer(arguments.study.json, done.as_ref(), outputs, plot)
}
