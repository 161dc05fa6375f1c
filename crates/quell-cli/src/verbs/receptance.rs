//! `quell receptance`: displacement over force between rows of a belt or a system, over frequency.

use clap::{Args, ValueHint};
use quell::run::system::receptance::{ContactsAre, ReceptanceRequest};
use quell::verbs::verbs;
use quell::{Failure, Study, quantity};

use super::numbers::{count, pair};
use crate::answer::Answer;
use crate::arguments::{Gathered, OutputArguments, PlotArguments, StudyArguments, answer, inputs};

/// Computes the receptances of a belt or a system, displacement over force, as a modal test measures them
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    study: StudyArguments,
    /// Rows whose displacements are asked, separated by commas: coordinates, points, CONTACT.tangent or CONTACT.normal
    /// [default: those of the contacts]
    #[arg(long, value_name = "ROW,…", value_delimiter = ',', value_hint = ValueHint::Other)]
    outputs: Vec<String>,
    /// Rows along which forces act, separated by commas [default: those of the contacts]
    #[arg(long, value_name = "ROW,…", value_delimiter = ',', value_hint = ValueHint::Other)]
    inputs: Vec<String>,
    /// What the contacts are: sliding with friction, springs without friction, or none, the structure alone
    #[arg(long, value_name = "sliding|springs|none", default_value = "sliding")]
    contacts: String,
    /// Range of angular frequencies, or with units such as 0Hz:5kHz [default: from rest beyond the fastest motion]
    #[arg(long, value_name = "FROM:TO", allow_hyphen_values = true, value_hint = ValueHint::Other)]
    frequency: Option<String>,
    /// Number of frequencies at equal distances [default: 401, and more around each resonance]
    #[arg(long, value_name = "N", allow_hyphen_values = true)]
    points: Option<String>,
    /// Frequencies that are asked alone, ascending, separated by commas, such as 950Hz,1kHz
    #[arg(long, value_name = "FREQUENCY,…", value_delimiter = ',', value_hint = ValueHint::Other, allow_hyphen_values = true)]
    at: Vec<String>,
    #[command(flatten)]
    output: OutputArguments,
    #[command(flatten)]
    plot: PlotArguments,
}

/// Runs the verb.
pub(crate) fn run(arguments: &Arguments) -> Result<Answer, Failure> {
    let mut complaints = Gathered::default();
    let study = complaints.take(arguments.study.read());
    let files = inputs(study.as_ref());
    let request = request(arguments, study.as_ref(), &mut complaints);
    let outputs = complaints.take(arguments.output.prepare(&[], &files));
    let plot = arguments.plot.prepare(&files);
    let plot = complaints.take(plot.and_then(|plot| plot.drawn_by(study.as_ref(), "receptance")));
    let ((study, request), (outputs, plot)) =
        complaints.finish(study.zip(request).zip(outputs.zip(plot)))?;

    let done = verbs(&study).receptance(&request)?;
    answer(arguments.study.json, done.as_ref(), outputs, plot)
}

fn request(
    arguments: &Arguments,
    study: Option<&Study>,
    complaints: &mut Gathered,
) -> Option<ReceptanceRequest> {
    let read = |text: &str| quantity::dither_frequency(text, study, "--frequency");
    let range = |text: &str| pair("--frequency", text, read);
    let frequency = complaints.take(arguments.frequency.as_deref().map(range).transpose());
    let points = arguments.points.as_deref().map(|text| count("--points", text));
    let points = complaints.take(points.transpose());
    let contacts = complaints.take(ContactsAre::from_name(&arguments.contacts));
    let listed = |text: &String| quantity::dither_frequency(text, study, "--at");
    let at: Result<Vec<f64>, _> = arguments.at.iter().map(listed).collect();
    let at = complaints.take(at);
    Some(ReceptanceRequest {
        outputs: arguments.outputs.clone(),
        inputs: arguments.inputs.clone(),
        contacts: contacts?,
        frequency: frequency?,
        points: points?,
        at: at?,
    })
}
