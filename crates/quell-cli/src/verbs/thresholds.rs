//! `quell thresholds`: exact parameter values at which the response changes.

use clap::{Args, ValueHint};
use quell::kind::verbs;
use quell::run::curves::CurvesRequest;
use quell::run::protocol::Protocol;
use quell::run::system::protocol::{SystemProtocol, read_state_of};
use quell::run::system::start;
use quell::run::system::thresholds::MotionThresholdsRequest;
use quell::run::thresholds::ThresholdsRequest;
use quell::study::SystemStudy;
use quell::{Complaint, Failure, Fault, Origin, Study};

use super::numbers::{VariedArguments, duration, state, window};
use crate::answer::Answer;
use crate::arguments::{Gathered, OutputArguments, PlotArguments, StudyArguments, answer, inputs};

/// Finds the values of a parameter at which dither starts or stops quenching
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    study: StudyArguments,
    #[command(flatten)]
    varied: VariedArguments,
    /// Also finds the thresholds of runs from rest
    #[arg(long)]
    from_rest: bool,
    /// Also finds the thresholds of runs from steady sliding without dither
    #[arg(long)]
    from_sliding: bool,
    /// Also finds the thresholds of runs that squeal fully when the dither is switched on
    #[arg(long)]
    from_squeal: bool,
    /// Also finds the thresholds of runs from this state; in a study in SI metres and m/s, or with units such as 1um,50mm/s
    #[arg(long, value_name = "X,V", allow_hyphen_values = true)]
    start: Option<String>,
    /// System: follows the periodic motion near this state at the first value, such as x=0.1,velocity.x=-2, instead of the base
    /// response; numbers that are not given are those of the study's start
    #[arg(long, value_name = "NAME=VALUE,…", conflicts_with_all = ["from_rest", "from_sliding", "from_squeal", "start", "ramp", "along"], allow_hyphen_values = true, value_hint = ValueHint::Other)]
    near: Option<String>,
    /// System: number of common periods of the dithers in one period of the motion of --near
    #[arg(long, value_name = "N", requires = "near", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=1000))]
    periods: u32,
    /// Ramps the dither of these runs up over this time τ, in steps of its period, instead of switching it on; in a study in SI
    /// in seconds, or a time such as 50ms; of a system in its own unit of time
    #[arg(long, value_name = "T", default_value = "0", allow_hyphen_values = true)]
    ramp: String,
    /// Follows each local threshold as a curve along a second parameter, such as belt.belt_velocity
    #[arg(long, value_name = "PATH", requires = "between", conflicts_with_all = ["from_rest", "from_sliding", "from_squeal", "start", "ramp"], value_hint = ValueHint::Other)]
    along: Option<String>,
    /// Range of the second parameter, in the unit of its key or with units
    #[arg(long, value_name = "FROM:TO", requires = "along", allow_hyphen_values = true, value_hint = ValueHint::Other)]
    between: Option<String>,
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
    if let (Some(Ok(system)), None) = (study.as_ref().map(Study::system), &arguments.along) {
        return run_of_system(arguments, &system, complaints);
    }
    let range = arguments.varied.ends(study.as_ref(), &mut complaints);
    let along = arguments.along.as_deref().unwrap_or_default();
    let between =
        arguments.between.as_deref().map(|text| window("--between", text, along, study.as_ref()));
    let between = complaints.take(between.transpose());
    let start = arguments.start.as_deref().map(|text| state("--start", text, study.as_ref()));
    let start = complaints.take(start.transpose());
    if let Some(text) = &arguments.near {
        let allowed = "left out: only thresholds of systems follow a motion near a state";
        complaints.take::<()>(Err(Complaint::option("--near", text.as_str(), allowed)));
    }
    let ramp = complaints.take(duration("--ramp", &arguments.ramp, study.as_ref()));
    let outputs = complaints.take(arguments.output.prepare(&[], &inputs));
    let plot = complaints.take(arguments.plot.prepare(&inputs));
    if arguments.output.saves() && arguments.along.is_none() {
        let (key, allowed) =
            ("--save", "--save saves the curves of --along, and requires that option");
        let complaint = Complaint::new(Fault::Usage, key, Origin::Whole, key, allowed);
        complaints.take::<()>(Err(complaint));
    }
    let (runs, files) = (start.zip(ramp), outputs.zip(plot));
    let (study, ((range, runs), (between, (outputs, plot)))) =
        complaints.finish(study.zip(range.zip(runs).zip(between.zip(files))))?;
    let parameter = arguments.varied.parameter.clone();
    let verbs = verbs(&study);
    let done = if let Some((along, between)) = arguments.along.clone().zip(between) {
        verbs.threshold_curves(&CurvesRequest { parameter, window: range, along, between })?
    } else {
        let ((from, to), (start, ramp)) = (range, runs);
        let protocols = arguments.protocols(start);
        verbs.thresholds(ThresholdsRequest { parameter, from, to, protocols, ramp })?
    };
    answer(arguments.study.json, done.as_ref(), outputs, plot)
}

/// Runs the verb on a system without a second parameter.
fn run_of_system(
    arguments: &Arguments,
    system: &SystemStudy,
    mut complaints: Gathered,
) -> Result<Answer, Failure> {
    let study: Study = system.into();
    let inputs = inputs(Some(&study));
    let range = arguments.varied.ends(Some(&study), &mut complaints);
    let mut read = |option, text: &Option<String>| {
        let read = |text: &str| read_state_of(system, option, text);
        complaints.take(text.as_deref().map(read).transpose())
    };
    let (near, start) = (read("--near", &arguments.near), read("--start", &arguments.start));
    let ramp = complaints.take(start::duration(system, &arguments.ramp, "--ramp"));
    let outputs = complaints.take(arguments.output.prepare(&[], &inputs));
    let plot = complaints.take(arguments.plot.prepare(&inputs));
    let ((range, ramp), ((near, start), (outputs, plot))) =
        complaints.finish(range.zip(ramp).zip(near.zip(start).zip(outputs.zip(plot))))?;
    let (from, to) = range;
    let (parameter, protocols) = (arguments.varied.parameter.clone(), arguments.protocols(None));
    let request = ThresholdsRequest { parameter, from, to, protocols, ramp };
    let mut request = MotionThresholdsRequest::of(request)?;
    request.protocols.extend(start.map(SystemProtocol::From));
    request.near = near.map(|state| (state, arguments.periods));
    let done = verbs(&study).thresholds_of_system(&request)?;
    answer(arguments.study.json, done.as_ref(), outputs, plot)
}

impl Arguments {
    /// The initial-condition protocols of the requested runs.
    fn protocols(&self, start: Option<(f64, f64)>) -> Vec<Protocol> {
        let flags = [
            (self.from_rest, Protocol::Rest),
            (self.from_sliding, Protocol::Sliding),
            (self.from_squeal, Protocol::Squeal),
        ];
        let asked = flags.into_iter().filter(|(asked, _)| *asked).map(|(_, protocol)| protocol);
        asked.chain(start.map(|(x, v)| Protocol::From(x, v))).collect()
    }
}
