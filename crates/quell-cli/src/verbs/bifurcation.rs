//! `quell bifurcation`: the response along a parameter, swept up and down.

use clap::{Args, ValueHint};
use quell::run::bifurcation::SweepRequest;
use quell::run::varied::Range;
use quell::running::Running;
use quell::verbs::verbs;
use quell::{RealInterval, Failure, Study};

use super::numbers::{VariedArguments, count};
use crate::answer::Answer;
use crate::arguments::{Gathered, OutputArguments, PlotArguments, StudyArguments, answer, inputs};
use crate::interrupt;
use crate::progress::Bar;

/// Sweeps a parameter up and down, continuing from the last state: sections, locking, hysteresis
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    study: StudyArguments,
    /// Path of the parameter, such as dither.amplitude
    #[arg(long, value_name = "PATH", value_hint = ValueHint::Other, required_unless_present = "ramp")]
    parameter: Option<String>,
    /// Smallest value, in the unit of the key or with a unit, such as 5kN
    #[arg(long, value_name = "A", allow_hyphen_values = true, value_hint = ValueHint::Other, required_unless_present = "ramp")]
    from: Option<String>,
    /// Largest value, in the unit of the key or with a unit, such as 5kN
    #[arg(long, value_name = "B", allow_hyphen_values = true, value_hint = ValueHint::Other, required_unless_present = "ramp")]
    to: Option<String>,
    /// Number of values of the parameter
    #[arg(long, value_name = "N", default_value = "101", allow_hyphen_values = true)]
    points: String,
    /// Sweeps up, from the initial state of the study [default: up, then down]
    #[arg(long)]
    up: bool,
    /// Sweeps down, from the final state of the sweep up; without --up, from the initial state of the study
    #[arg(long)]
    down: bool,
    /// Runs the study as it varies in time, from its first knot to its last, and compares it with the exact thresholds
    #[arg(long, conflicts_with_all = ["parameter", "from", "to", "points", "up", "down"])]
    ramp: bool,
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
    if arguments.ramp {
        return ramp(arguments, study, complaints);
    }
    let given = |text: &Option<String>| text.clone().unwrap_or_default();
    let varied = VariedArguments {
        parameter: given(&arguments.parameter),
        from: given(&arguments.from),
        to: given(&arguments.to),
    };
    let ends = varied.ends(study.as_ref(), &mut complaints);
    let points = complaints.take(count("--points", &arguments.points));
    let outputs = complaints.take(arguments.output.prepare(&[], &inputs));
    let plot = complaints.take(arguments.plot.prepare(&inputs));
    let ((study, points), (RealInterval { lower: from, upper: to }, (outputs, plot))) =
        complaints.finish(study.zip(points).zip(ends.zip(outputs.zip(plot))))?;
    let range = Range { parameter: varied.parameter, from, to, points };
    let request = SweepRequest { range, up: arguments.up, down: arguments.down };
    let bar = Bar::new();
    let running = Running { threads: None, stop: interrupt::flag(), progress: &bar };
    let done = verbs(&study).bifurcation(&request, running)?;
    answer(arguments.study.json, done.as_ref(), outputs, plot)
}

/// One run along the course of the study.
fn ramp(
    arguments: &Arguments,
    study: Option<Study>,
    mut complaints: Gathered,
) -> Result<Answer, Failure> {
    let inputs = inputs(study.as_ref());
    let outputs = complaints.take(arguments.output.prepare(&[], &inputs));
    let plot = complaints.take(arguments.plot.prepare(&inputs));
    let (study, (outputs, plot)) = complaints.finish(study.zip(outputs.zip(plot)))?;
    let done = verbs(&study).ramp()?;
    answer(arguments.study.json, done.as_ref(), outputs, plot)
}
