//! `quell attractor`: the motion on which a run ends, and its Lyapunov exponents.

use clap::{Args, ValueHint};
use quell::run::exponents::ExponentTimes;
use quell::run::found_attractor::AttractorRequest;
use quell::run::protocol::read_state_of;
use quell::study::SystemStudy;
use quell::verbs::{system_of, verbs};
use quell::{Failure, quantity};

use crate::answer::Answer;
use crate::arguments::{Gathered, OutputArguments, PlotArguments, StudyArguments, answer, inputs};

/// Finds the motion on which a run ends, and measures its Lyapunov exponents
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    study: StudyArguments,
    /// Starts from this state: numbers that replace those of the study's start, such as x=0.1,velocity.x=-2, of one mass also x,v
    /// alone; in a study in SI in metres and m/s, or with units such as 1um,50mm/s [default: that of the study]
    #[arg(long, value_name = "X,V", allow_hyphen_values = true)]
    start: Option<String>,
    /// Measures the Lyapunov exponents: mean rates at which small changes of the motion grow
    #[arg(long)]
    lyapunov: bool,
    /// Time before the record of the exponents, such as 50 or 50ms [default: 50 periods of the slowest oscillation]
    #[arg(long, value_name = "T", requires = "lyapunov", allow_hyphen_values = true, value_hint = ValueHint::Other)]
    settle: Option<String>,
    /// Length of the run over which the exponents are averaged [default: 1000 periods of the slowest oscillation]
    #[arg(long, value_name = "T", requires = "lyapunov", allow_hyphen_values = true, value_hint = ValueHint::Other)]
    record: Option<String>,
    #[command(flatten)]
    output: OutputArguments,
    #[command(flatten)]
    plot: PlotArguments,
}

impl Arguments {
    /// The request of a system.
    fn request(&self, study: &SystemStudy) -> Result<AttractorRequest, Failure> {
        let mut complaints = Gathered::default();
        let mut time = |option, text: &Option<String>| {
            let read = |text: &str| quantity::duration(text, study.units(), option);
            complaints.take(text.as_deref().map(read).transpose())
        };
        let settle = time("--settle", &self.settle);
        let record = time("--record", &self.record);
        let start = self.start.as_deref().map(|text| read_state_of(study, "--start", text));
        let start = complaints.take(start.transpose());
        let ((settle, record), start) = complaints.finish(settle.zip(record).zip(start))?;
        let lyapunov = self.lyapunov.then_some(ExponentTimes { settle, record });
        Ok(AttractorRequest { start: start.unwrap_or_default(), lyapunov })
    }
}

/// Runs the verb.
pub(crate) fn run(arguments: &Arguments) -> Result<Answer, Failure> {
    let mut complaints = Gathered::default();
    let study = complaints.take(arguments.study.read());
    let inputs = inputs(study.as_ref());
    let system = study.as_ref().map(|study| system_of(study, "attractor"));
    let request = match complaints.take(system.transpose()) {
        Some(Some(system)) => complaints.take(arguments.request(&system)),
        _ => None,
    };
    let outputs = complaints.take(arguments.output.prepare(&[], &inputs));
    let plot = complaints.take(arguments.plot.prepare(&inputs));
    let ((study, request), (outputs, plot)) =
        complaints.finish(study.zip(request).zip(outputs.zip(plot)))?;
    let done = verbs(&study).attractor(&request)?;
    answer(arguments.study.json, done.as_ref(), outputs, plot)
}
