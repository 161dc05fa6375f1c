//! `quell thresholds`: exact parameter values at which the response changes.

use clap::Args;
use quell::kind::verbs;
use quell::run::curves::CurvesRequest;
use quell::run::protocol::Protocol;
use quell::run::thresholds::ThresholdsRequest;
use quell::{Complaint, Failure, Fault, Origin};

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
    /// Ramps the dither of these runs up over this time τ, in steps of its period, instead of switching it on; in a study in SI
    /// in seconds, or a time such as 50ms
    #[arg(long, value_name = "T", default_value = "0", allow_hyphen_values = true)]
    ramp: String,
    /// Follows each local threshold as a curve along a second parameter, such as belt.belt_velocity
    #[arg(long, value_name = "PATH", requires = "between", conflicts_with_all = ["from_rest", "from_sliding", "from_squeal", "start", "ramp"])]
    along: Option<String>,
    /// Range of the second parameter, in the unit of its key or with units
    #[arg(long, value_name = "FROM:TO", requires = "along", allow_hyphen_values = true)]
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
    let range = arguments.varied.ends(study.as_ref(), &mut complaints);
    let along = arguments.along.as_deref().unwrap_or_default();
    let between =
        arguments.between.as_deref().map(|text| window(study.as_ref(), "--between", text, along));
    let between = complaints.take(between.transpose());
    let start = arguments.start.as_deref().map(|text| state("--start", text, study.as_ref()));
    let start = complaints.take(start.transpose());
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
