//! `quell simulate`: one trajectory with its events.

use clap::{Args, ValueHint};
use quell::kind::verbs;
use quell::run::simulate::Options;
use quell::run::system::simulate::MotionRequest;
use quell::run::system::start::read_state;
use quell::study::SystemStudy;
use quell::{Complaint, Failure, Fault, Origin, Study, quantity};
use serde_json::Value as Json;

use super::numbers::duration;
use crate::answer::Answer;
use crate::arguments::{
    Gathered, OutputArguments, Plot, PlotArguments, StudyArguments, answer, inputs,
};

/// Simulates one run and locates every event at the contact
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    study: StudyArguments,
    /// Duration: τ of a belt, or time in the units of a system; in a study in SI in seconds, or a time such as 50ms [default, for
    /// systems: 100 periods of the slowest oscillation]
    #[arg(long, value_name = "T", allow_hyphen_values = true)]
    until: Option<String>,
    /// Start of a system: numbers that replace those of the study's start, such as x=0.1,velocity.x=-2
    #[arg(long, value_name = "NAME=VALUE,…", allow_hyphen_values = true, value_hint = ValueHint::Other)]
    start: Option<String>,
    /// Lists every event; with --save also writes them to a second file, such as run_events.csv next to run.csv
    #[arg(long)]
    events: bool,
    #[command(flatten)]
    plot: PlotArguments,
    #[command(flatten)]
    output: OutputArguments,
}

impl Arguments {
    /// The run of a system.
    fn request(&self, study: &SystemStudy, plot: Option<&Plot>) -> Result<MotionRequest, Failure> {
        let mut complaints = Gathered::default();
        let read = |text: &str| quantity::duration_of_system(text, study.units(), "--until");
        let until = complaints.take(self.until.as_deref().map(read).transpose());
        let start = self.start.as_deref().map(|text| read_state(study, text));
        let start = complaints.take(start.transpose());
        let (until, start) = complaints.finish(until.zip(start))?;
        Ok(MotionRequest {
            until,
            start: start.unwrap_or_default(),
            events: self.events,
            samples: self.output.saves() || plot.is_some_and(Plot::wanted),
        })
    }

    /// The duration of the run of a study of another kind, which must be given.
    fn until_of_belt(&self, study: Option<&Study>) -> Result<f64, Failure> {
        let mut complaints = Gathered::default();
        if let Some(text) = &self.start {
            let origin = Origin::Argument("--start");
            let allowed =
                "left out: the start of a belt is that of [belt.initial], which --set changes";
            let complaint =
                Complaint::new(Fault::Conflict, "--start", origin, text.as_str(), allowed);
            complaints.take::<()>(Err(complaint));
        }
        let until = match &self.until {
            Some(text) => duration("--until", text, study),
            None => Err(Box::new(Complaint::new(
                Fault::Missing,
                "--until",
                Origin::Argument("--until"),
                Json::Null,
                "a duration, such as 50",
            ))),
        };
        let until = complaints.take(until);
        complaints.finish(until)
    }
}

/// Runs the verb.
pub(crate) fn run(arguments: &Arguments) -> Result<Answer, Failure> {
    let mut complaints = Gathered::default();
    let study = complaints.take(arguments.study.read());
    let inputs = inputs(study.as_ref());
    let parts: &[&str] = if arguments.events { &["events"] } else { &[] };
    let outputs = complaints.take(arguments.output.prepare(parts, &inputs));
    let plot = complaints.take(arguments.plot.prepare(&inputs));
    if let Some(Ok(system)) = study.as_ref().map(Study::system) {
        let request = complaints.take(arguments.request(&system, plot.as_ref()));
        let (request, (outputs, plot)) = complaints.finish(request.zip(outputs.zip(plot)))?;
        let done = verbs(&(&system).into()).simulate_from(&request)?;
        return answer(arguments.study.json, done.as_ref(), outputs, plot);
    }
    let until = complaints.take(arguments.until_of_belt(study.as_ref()));
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
