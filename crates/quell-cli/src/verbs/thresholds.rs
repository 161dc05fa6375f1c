//! `quell thresholds`: exact parameter values at which the response changes.

use clap::{Args, ValueHint};
use quell::{RealInterval, Failure};
use quell::run::protocol::{Protocol, read_state_of};
use quell::run::system::start;
use quell::run::thresholds::curves::CurvesRequest;
use quell::run::thresholds::{AMPLITUDE, ThresholdsRequest, window_of};
use quell::study::SystemStudy;
use quell::verbs::{system_of, verbs};

use super::numbers::{number, window};
use crate::answer::Answer;
use crate::arguments::{Gathered, OutputArguments, PlotArguments, StudyArguments, answer, inputs};

/// Finds the values of a parameter at which dither starts or stops quenching
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    study: StudyArguments,
    /// Path of the parameter, such as belt.belt_velocity
    #[arg(long, value_name = "PATH", default_value = AMPLITUDE, value_hint = ValueHint::Other)]
    parameter: String,
    /// Smallest value, in the unit of the key or with a unit, such as 5kN [default: of an amplitude, 0]
    #[arg(long, value_name = "A", allow_hyphen_values = true, value_hint = ValueHint::Other)]
    from: Option<String>,
    /// Largest value, in the unit of the key or with a unit, such as 5kN [default: of an amplitude, the limit of quench-amplitude]
    #[arg(long, value_name = "B", allow_hyphen_values = true, value_hint = ValueHint::Other)]
    to: Option<String>,
    /// Also finds the thresholds of runs from rest
    #[arg(long)]
    from_rest: bool,
    /// Also finds the thresholds of runs from steady sliding without dither
    #[arg(long)]
    from_sliding: bool,
    /// Also finds the thresholds of runs that squeal fully when the dither is switched on
    #[arg(long)]
    from_squeal: bool,
    /// Also finds the thresholds of runs from this state: numbers that replace those of the study's start, such as
    /// x=0.1,velocity.x=-2, of one mass also x,v alone; in a study in SI in metres and m/s, or with units such as 1um,50mm/s
    #[arg(long, value_name = "X,V", allow_hyphen_values = true)]
    start: Option<String>,
    /// Follows the periodic motion near this state at the first value, such as x=0.1,velocity.x=-2, instead of the base response; numbers
    /// that are not given are those of the study's start
    #[arg(long, value_name = "NAME=VALUE,…", conflicts_with_all = ["from_rest", "from_sliding", "from_squeal", "start", "ramp", "along"], allow_hyphen_values = true, value_hint = ValueHint::Other)]
    near: Option<String>,
    /// Number of common periods of the dithers in one period of the motion of --near
    #[arg(long, value_name = "N", requires = "near", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=1000))]
    periods: u32,
    /// Ramps the dither of these runs up over this time, in steps of its period, instead of switching it on; in a study with units
    /// in seconds, or a time such as 50ms
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

impl Arguments {
    /// The request over a window, with the runs and the motion to follow; `None` after a complaint.
    fn request(
        &self,
        system: &SystemStudy,
        (from, to): (Option<f64>, Option<f64>),
        between: Option<RealInterval>,
        complaints: &mut Gathered,
    ) -> Option<ThresholdsRequest> {
        let mut read = |option, text: &Option<String>| {
            let read = |text: &str| read_state_of(system, option, text);
            complaints.take(text.as_deref().map(read).transpose())
        };
        let (near, start) = (read("--near", &self.near), read("--start", &self.start));
        let ramp = complaints.take(start::duration(system, &self.ramp, "--ramp"));
        let flags = [
            (self.from_rest, Protocol::Rest),
            (self.from_sliding, Protocol::Sliding),
            (self.from_squeal, Protocol::Squeal),
        ];
        let asked = flags.into_iter().filter(|(asked, _)| *asked).map(|(_, protocol)| protocol);
        let protocols = asked.chain(start?.map(Protocol::From)).collect();
        let near = near?.map(|state| (state, self.periods));
        let along = self.along.as_deref().zip(between);
        let window = complaints.take(window_of(system, &self.parameter, (from, to), along))?;
        let parameter = self.parameter.clone();
        Some(ThresholdsRequest { parameter, window, near, protocols, ramp: ramp? })
    }
}

/// Runs the verb.
pub(crate) fn run(arguments: &Arguments) -> Result<Answer, Failure> {
    let mut complaints = Gathered::default();
    let study = complaints.take(arguments.study.read());
    let inputs = inputs(study.as_ref());
    let mut end = |option, text: &Option<String>| {
        let read = |text: &str| number(option, text, &arguments.parameter, study.as_ref());
        complaints.take(text.as_deref().map(read).transpose())
    };
    let ends = end("--from", &arguments.from).zip(end("--to", &arguments.to));
    let along = arguments.along.as_deref().unwrap_or_default();
    let between =
        arguments.between.as_deref().map(|text| window("--between", text, along, study.as_ref()));
    let between = complaints.take(between.transpose());
    let system = study.as_ref().map(|study| system_of(study, "thresholds"));
    let request = match (complaints.take(system.transpose()), ends) {
        (Some(Some(system)), Some(ends)) => {
            arguments.request(&system, ends, between.flatten(), &mut complaints)
        }
        _ => None,
    };
    let outputs = complaints.take(arguments.output.prepare(&[], &inputs));
    let plot = complaints.take(arguments.plot.prepare(&inputs));
    let ((study, request), (between, (outputs, plot))) =
        complaints.finish(study.zip(request).zip(between.zip(outputs.zip(plot))))?;
    let verbs = verbs(&study);
    let done = match arguments.along.clone().zip(between) {
        Some((along, between)) => {
            let ThresholdsRequest { parameter, window, .. } = request;
            verbs.threshold_curves(&CurvesRequest { parameter, window, along, between })?
        }
        None => verbs.thresholds(&request)?,
    };
    answer(arguments.study.json, done.as_ref(), outputs, plot)
}
