//! `quell attractor`: the motion on which a run ends, and its Lyapunov exponents.

use clap::{Args, ValueHint};
use quell::kind::verbs;
use quell::run::exponents::ExponentTimes;
use quell::run::found_attractor::AttractorRequest;
use quell::run::system::found_attractor::MotionAttractorRequest;
use quell::run::system::protocol::read_state_of;
use quell::study::SystemStudy;
use quell::{Complaint, Failure, Study, quantity};

use super::numbers::{duration, state};
use crate::answer::Answer;
use crate::arguments::{Gathered, OutputArguments, PlotArguments, StudyArguments, answer, inputs};

/// Finds the motion on which a run ends, and measures its Lyapunov exponents
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    study: StudyArguments,
    /// Starts from this state x,v; in a study in SI in metres and m/s, or with units such as 1um,50mm/s [default: that of the
    /// study]. Of a system, numbers that replace those of the study's start, such as x=0.1,velocity.x=-2
    #[arg(long, value_name = "X,V", allow_hyphen_values = true)]
    start: Option<String>,
    /// Measures the Lyapunov exponents: mean rates at which small changes of the motion grow
    #[arg(long)]
    lyapunov: bool,
    /// Time before the record of the exponents, such as 50 or 50ms [default: 50 periods of the slowest oscillation]
    #[arg(long, value_name = "T", requires = "lyapunov", allow_hyphen_values = true, value_hint = ValueHint::Other)]
    settle: Option<String>,
    /// Length of the record of the exponents [default: 1000 periods of the slowest oscillation]
    #[arg(long, value_name = "T", requires = "lyapunov", allow_hyphen_values = true, value_hint = ValueHint::Other)]
    record: Option<String>,
    #[command(flatten)]
    output: OutputArguments,
    #[command(flatten)]
    plot: PlotArguments,
}

impl Arguments {
    /// The times of the exponents; `read` reads a duration.
    fn times(
        &self,
        complaints: &mut Gathered,
        read: impl Fn(&'static str, &str) -> Result<f64, Box<Complaint>>,
    ) -> Option<ExponentTimes> {
        let mut time = |option, text: &Option<String>| {
            let found = text.as_deref().map(|text| read(option, text)).transpose();
            complaints.take(found)
        };
        let settle = time("--settle", &self.settle);
        let record = time("--record", &self.record);
        let (settle, record) = settle.zip(record)?;
        Some(ExponentTimes { settle, record })
    }
}

/// Runs the verb.
pub(crate) fn run(arguments: &Arguments) -> Result<Answer, Failure> {
    let mut complaints = Gathered::default();
    let study = complaints.take(arguments.study.read());
    if let Some(Ok(system)) = study.as_ref().map(Study::system) {
        return run_on_system(arguments, &system, complaints);
    }
    let inputs = inputs(study.as_ref());
    let times =
        arguments.times(&mut complaints, |option, text| duration(option, text, study.as_ref()));
    let start = arguments.start.as_deref().map(|text| state("--start", text, study.as_ref()));
    let start = complaints.take(start.transpose());
    let outputs = complaints.take(arguments.output.prepare(&[], &inputs));
    let plot = complaints.take(arguments.plot.prepare(&inputs));
    let ((study, times), (start, (outputs, plot))) =
        complaints.finish(study.zip(times).zip(start.zip(outputs.zip(plot))))?;
    let done = verbs(&study)
        .attractor(&AttractorRequest { start, lyapunov: arguments.lyapunov.then_some(times) })?;
    answer(arguments.study.json, done.as_ref(), outputs, plot)
}

/// Runs the verb on a system.
fn run_on_system(
    arguments: &Arguments,
    system: &SystemStudy,
    mut complaints: Gathered,
) -> Result<Answer, Failure> {
    let study: Study = system.into();
    let inputs = inputs(Some(&study));
    let times = arguments.times(&mut complaints, |option, text| {
        quantity::duration_of_system(text, system.units(), option)
    });
    let start = arguments.start.as_deref().map(|text| read_state_of(system, "--start", text));
    let start = complaints.take(start.transpose());
    let outputs = complaints.take(arguments.output.prepare(&[], &inputs));
    let plot = complaints.take(arguments.plot.prepare(&inputs));
    let ((times, start), (outputs, plot)) =
        complaints.finish(times.zip(start).zip(outputs.zip(plot)))?;
    let request = MotionAttractorRequest {
        start: start.unwrap_or_default(),
        lyapunov: arguments.lyapunov.then_some(times),
    };
    let done = verbs(&study).attractor_of_system(&request)?;
    answer(arguments.study.json, done.as_ref(), outputs, plot)
}
