//! `quell response`: the steady response, the effect of the dither on it, and the cost of the dither.

use clap::{Args, ValueHint};
use quell::complaint::Complaints;
use quell::kind::verbs;
use quell::run::moment::moment;
use quell::run::system::response::ResponseRequest;
use quell::study::SystemStudy;
use quell::{Complaint, Failure, Fault, Origin, Study, quantity};

use crate::answer::Answer;
use crate::arguments::{Gathered, OutputArguments, PlotArguments, StudyArguments, answer, inputs};

/// Measures the steady response with and without dither, and the cost of the dither
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    study: StudyArguments,
    /// System: time before the record, in its units or with a unit such as 50ms [default: 200 periods of the slowest oscillation]
    #[arg(long, value_name = "T", allow_hyphen_values = true, value_hint = ValueHint::Other)]
    settle: Option<String>,
    /// System: length of the record, in its units or with a unit such as 50ms [default: 60 periods of the slowest oscillation]
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
    /// The times of a system's response.
    fn request(&self, study: &SystemStudy) -> Result<ResponseRequest, Failure> {
        let mut complaints = Gathered::default();
        let mut read = |option, text: &Option<String>| {
            let read = |text: &str| quantity::duration_of_system(text, study.units(), option);
            complaints.take(text.as_deref().map(read).transpose())
        };
        let settle = read("--settle", &self.settle);
        let record = read("--record", &self.record);
        let (settle, record) = complaints.finish(settle.zip(record))?;
        Ok(ResponseRequest { settle, record })
    }

    /// The times of --window.
    fn window(&self, study: &Study) -> Result<Option<(f64, f64)>, Failure> {
        const OPTION: &str = "--window";
        let Some(text) = &self.window else { return Ok(None) };
        let Some((from, to)) = text.split_once(':') else {
            let allowed = "two times with a colon between them, such as 100:200";
            return Err(Complaint::option(OPTION, text.as_str(), allowed).into());
        };
        Ok(Some((moment(study, from, OPTION)?, moment(study, to, OPTION)?)))
    }

    /// Rejects the options that only systems have.
    fn without_times(&self) -> Result<(), Complaints> {
        let given = [("--settle", &self.settle), ("--record", &self.record)];
        let allowed = "left out: [solver] of the study has settle and record_periods";
        let wrong: Vec<Complaint> = given
            .into_iter()
            .filter_map(|(option, text)| {
                let origin = Origin::Argument(option);
                Some(Complaint::new(Fault::Conflict, option, origin, text.as_deref()?, allowed))
            })
            .collect();
        if wrong.is_empty() { Ok(()) } else { Err(wrong.into()) }
    }
}

/// Runs the verb.
pub(crate) fn run(arguments: &Arguments) -> Result<Answer, Failure> {
    let mut complaints = Gathered::default();
    let study = complaints.take(arguments.study.read());
    let inputs = inputs(study.as_ref());
    let outputs = complaints.take(arguments.output.prepare(&["spectrum"], &inputs));
    let plot = complaints.take(arguments.plot.prepare(&inputs));
    let request = match study.as_ref().map(Study::system) {
        Some(Ok(system)) => complaints.take(arguments.request(&system)).map(Some),
        Some(Err(_)) => complaints.take(arguments.without_times()).map(|()| None),
        // Which options apply depends on the kind of the study, which is unknown.
        None => Some(None),
    };
    let ((study, request), (outputs, plot)) =
        complaints.finish(study.zip(request).zip(outputs.zip(plot)))?;

    if let Some(window) = arguments.window(&study)? {
        let done = verbs(&study).response_within(window)?;
        return answer(arguments.study.json, done.as_ref(), outputs, plot);
    }
    if let Some(seeds) = arguments.seeds {
        let done = verbs(&study).response_of_seeds(Some(seeds), request.unwrap_or_default())?;
        return answer(arguments.study.json, done.as_ref(), outputs, plot);
    }
    let done = match request {
        Some(request) => verbs(&study).response_after(request)?,
        None => verbs(&study).response()?,
    };
    answer(arguments.study.json, done.as_ref(), outputs, plot)
}
