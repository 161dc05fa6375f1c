//! `quell resonances`: speeds at which waves of a disc meet, and dither frequencies that keep a range of speeds clear.

use clap::{Args, ValueEnum, ValueHint};
use quell::run::disc::resonances::{Order, ResonancesRequest};
use quell::run::system::reach::without_waves;
use quell::verbs::verbs;
use quell::{RealInterval, Failure, Study, quantity};

use super::numbers::pair;
use crate::answer::Answer;
use crate::arguments::{Gathered, OutputArguments, PlotArguments, StudyArguments, answer, inputs};

/// Finds the speeds at which a disc can squeal and clear dither frequencies, or how far the dither of a belt or a system reaches its contacts
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    study: StudyArguments,
    /// Range of speeds, in units of ω_ref or with units such as 0rpm:900rpm [default: 0:1]
    #[arg(long, value_name = "FROM:TO", allow_hyphen_values = true, value_hint = ValueHint::Other)]
    speeds: Option<String>,
    /// Order of the expansion; second takes friction to second order (f of the order of √m, √c, √k)
    #[arg(long, value_name = "ORDER", default_value = "first")]
    order: Expansion,
    /// Range of speeds of a disc to keep clear; needs --frequency
    #[arg(long, value_name = "FROM:TO", allow_hyphen_values = true, value_hint = ValueHint::Other, requires = "frequency")]
    clear: Option<String>,
    /// Range of dither frequencies: of a disc ratios R or with units such as 2kHz:20kHz, with --clear; otherwise angular
    /// frequencies or with units
    #[arg(long, value_name = "FROM:TO", allow_hyphen_values = true, value_hint = ValueHint::Other)]
    frequency: Option<String>,
    #[command(flatten)]
    output: OutputArguments,
    #[command(flatten)]
    plot: PlotArguments,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Expansion {
    First,
    Second,
}

impl From<Expansion> for Order {
    fn from(expansion: Expansion) -> Self {
        match expansion {
            Expansion::First => Self::First,
            Expansion::Second => Self::Second,
        }
    }
}

/// Runs the verb.
pub(crate) fn run(arguments: &Arguments) -> Result<Answer, Failure> {
    let mut complaints = Gathered::default();
    let study = complaints.take(arguments.study.read());
    let inputs = inputs(study.as_ref());
    let outputs = complaints.take(arguments.output.prepare(&[], &inputs));
    let plot = complaints.take(arguments.plot.prepare(&inputs));
    if let Some(study) = study.as_ref().filter(|study| study.disc().is_err()) {
        let frequencies = complaints.take(frequencies(arguments, study));
        let (frequencies, (outputs, plot)) =
            complaints.finish(frequencies.zip(outputs.zip(plot)))?;
        let done = verbs(study).reach(frequencies)?;
        return answer(arguments.study.json, done.as_ref(), outputs, plot);
    }
    let request = request(arguments, study.as_ref(), &mut complaints);
    let ((study, request), (outputs, plot)) =
        complaints.finish(study.zip(request).zip(outputs.zip(plot)))?;

    let done = verbs(&study).resonances(request)?;
    answer(arguments.study.json, done.as_ref(), outputs, plot)
}

/// The range of dither frequencies of a system.
fn frequencies(arguments: &Arguments, study: &Study) -> Result<Option<RealInterval>, Failure> {
    let (speeds, clear) = (arguments.speeds.as_deref(), arguments.clear.as_deref());
    without_waves(speeds, arguments.order.into(), clear)?;
    let text = arguments.frequency.as_deref();
    let read = |text: &str| quantity::dither_frequency(text, Some(study), "--frequency");
    Ok(text.map(|text| pair("--frequency", text, read)).transpose()?)
}

fn request(
    arguments: &Arguments,
    study: Option<&Study>,
    complaints: &mut Gathered,
) -> Option<ResonancesRequest> {
    let disc = study.and_then(|study| study.disc().ok());
    let mut range = |option, text: &Option<String>| {
        let read = |text: &str| quantity::frequency(text, disc.as_ref(), option);
        complaints.take(text.as_deref().map(|text| pair(option, text, read)).transpose())
    };
    let speeds = range("--speeds", &arguments.speeds).map(|speeds| speeds.unwrap_or(RealInterval::new(0.0, 1.0)));
    let clear = range("--clear", &arguments.clear);
    let frequency = range("--frequency", &arguments.frequency);
    let order = arguments.order.into();
    complaints.take(ResonancesRequest::new(speeds?, order, clear?, frequency?))
}
