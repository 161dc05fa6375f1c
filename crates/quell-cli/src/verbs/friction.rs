//! `quell friction`: the friction law and the effective friction under the dither.

use clap::Args;
use quell::kind::verbs;
use quell::{Failure, Study};

use super::numbers::velocity;
use crate::answer::Answer;
use crate::arguments::{Gathered, OutputArguments, PlotArguments, StudyArguments, answer, inputs};

/// Computes the friction law and the effective friction under the dither
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    study: StudyArguments,
    /// Slip velocities, separated by commas; in a study in SI in m/s, or with a unit such as 20mm/s
    #[arg(long, value_name = "V,…", value_delimiter = ',', allow_hyphen_values = true)]
    at: Vec<String>,
    /// Belt: also measures the friction on steady responses, stick included, instead of averaging
    #[arg(long)]
    measured: bool,
    /// Gives the describing function of averaged friction at the velocity of the belt, or of every surface, for slow sinusoids up to
    /// this velocity amplitude, and the limit cycles that it predicts
    #[arg(long, value_name = "AMPLITUDE", conflicts_with_all = ["at", "measured"])]
    describing: Option<String>,
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
    let at = velocities(&arguments.at, study.as_ref(), &mut complaints);
    let largest = arguments
        .describing
        .as_deref()
        .and_then(|text| complaints.take(velocity("--describing", text, study.as_ref())));
    let outputs = complaints.take(arguments.output.prepare(&[], &inputs));
    let plot = complaints.take(arguments.plot.prepare(&inputs));
    let (study, (outputs, plot)) = complaints.finish(study.zip(outputs.zip(plot)))?;

    let verbs = verbs(&study);
    let done = match largest {
        Some(largest) => verbs.describing(largest)?,
        None => verbs.friction((!at.is_empty()).then_some(at), arguments.measured)?,
    };
    answer(arguments.study.json, done.as_ref(), outputs, plot)
}

fn velocities(texts: &[String], study: Option<&Study>, complaints: &mut Gathered) -> Vec<f64> {
    texts.iter().filter_map(|text| complaints.take(velocity("--at", text, study))).collect()
}
