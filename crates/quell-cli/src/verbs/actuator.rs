//! `quell actuator`: where over frequency the actuator can give the dither that quenches.

use clap::{Args, ValueHint};
use quell::verbs::verbs;
use quell::{RealInterval, Complaint, Failure, quantity};

use super::numbers::pair;
use crate::answer::Answer;
use crate::arguments::{Gathered, OutputArguments, PlotArguments, StudyArguments, answer, inputs};

/// Finds the frequencies at which [actuator] can give the dither that quenches, what limits it, and by how much it suffices
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    study: StudyArguments,
    /// Range of dither frequencies: angular frequencies in the units of the study, or with units such as 5kHz:40kHz [default:
    /// that of a measured actuator, or from a tenth, but above the vibration, to 10 times the frequency of the dither]
    #[arg(long, value_name = "FROM:TO", allow_hyphen_values = true, value_hint = ValueHint::Other)]
    frequency: Option<String>,
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
    let plot = complaints.take(plot.and_then(|plot| plot.drawn_by(study.as_ref(), "actuator")));
    let read = |text: &str| quantity::dither_frequency(text, study.as_ref(), "--frequency");
    let frequency = arguments.frequency.as_deref();
    let ascending = |text: &str| -> Result<RealInterval, Box<Complaint>> {
        let RealInterval { lower: from, upper: to } = pair("--frequency", text, read)?;
        let allowed = "two positive frequencies FROM:TO, the second above the first";
        let wrong = || Box::new(Complaint::option("--frequency", text, allowed));
        if 0.0 < from && from < to { Ok(RealInterval::new(from, to)) } else { Err(wrong()) }
    };
    let frequency = frequency.map(ascending).transpose();
    let frequency = complaints.take(frequency);
    let ((study, frequency), (outputs, plot)) =
        complaints.finish(study.zip(frequency).zip(outputs.zip(plot)))?;

    let done = verbs(&study).actuator(frequency)?;
    answer(arguments.study.json, done.as_ref(), outputs, plot)
}
