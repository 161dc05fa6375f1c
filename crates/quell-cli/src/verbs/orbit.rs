//! `quell orbit`: the periodic response and its Floquet multipliers.

use clap::Args;
use quell::Failure;
use quell::run::orbit::Wanted;
use quell::run::protocol::{Protocol, read_state_of};
use quell::study::SystemStudy;
use quell::verbs::{system_of, verbs};

use crate::answer::Answer;
use crate::arguments::{Gathered, OutputArguments, PlotArguments, StudyArguments, answer, inputs};

/// Options for the response that a run reaches, which determines the state and the number of periods.
const STARTS: [&str; 4] = ["from_rest", "from_sliding", "from_squeal", "start"];

/// Computes the periodic response and its stability by Floquet multipliers
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    study: StudyArguments,
    /// Searches near this state: numbers that replace those of the study's start, such as x=0.1,velocity.x=-2, of one mass also x,v
    /// alone; in a study in SI in metres and m/s, or with units such as 1um,50mm/s [default: the base response, continued from
    /// steady sliding; without dither the limit cycle; where no base response exists the one that a run reaches]
    #[arg(long, value_name = "X,V", conflicts_with_all = STARTS, allow_hyphen_values = true)]
    near: Option<String>,
    /// Number of common periods of the dithers in one period of the response
    #[arg(long, value_name = "N", conflicts_with_all = STARTS, default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=1000))]
    periods: u32,
    /// Finds the response that a run from rest reaches, with any number of periods
    #[arg(long, group = "run")]
    from_rest: bool,
    /// Finds the response that a run from steady sliding without dither reaches
    #[arg(long, group = "run")]
    from_sliding: bool,
    /// Finds the response that a run from the undithered limit cycle reaches
    #[arg(long, group = "run")]
    from_squeal: bool,
    /// Starts a run from this state, written as for --near, and finds the response that it reaches
    #[arg(long, group = "run", value_name = "X,V", allow_hyphen_values = true)]
    start: Option<String>,
    #[command(flatten)]
    output: OutputArguments,
    #[command(flatten)]
    plot: PlotArguments,
}

impl Arguments {
    /// The response that is requested of a system.
    fn wanted(&self, study: &SystemStudy) -> Result<Wanted, Failure> {
        let mut complaints = Gathered::default();
        let mut read = |option, text: &Option<String>| {
            let read = |text: &str| read_state_of(study, option, text);
            complaints.take(text.as_deref().map(read).transpose())
        };
        let near = read("--near", &self.near);
        let start = read("--start", &self.start);
        let (near, start) = complaints.finish(near.zip(start))?;
        let flags = [
            (self.from_rest, Protocol::Rest),
            (self.from_sliding, Protocol::Sliding),
            (self.from_squeal, Protocol::Squeal),
        ];
        let flag = flags.into_iter().find_map(|(asked, protocol)| asked.then_some(protocol));
        let periods = self.periods;
        Ok(match (flag.or(start.map(Protocol::From)), near) {
            (Some(protocol), _) => Wanted::After(protocol),
            (None, Some(state)) => Wanted::Near { state, periods },
            (None, None) => Wanted::Base { periods },
        })
    }
}

/// Runs the verb.
pub(crate) fn run(arguments: &Arguments) -> Result<Answer, Failure> {
    let mut complaints = Gathered::default();
    let study = complaints.take(arguments.study.read());
    let inputs = inputs(study.as_ref());
    let system = study.as_ref().map(|study| system_of(study, "orbit"));
    let wanted = match complaints.take(system.transpose()) {
        Some(Some(system)) => complaints.take(arguments.wanted(&system)),
        _ => None,
    };
    let outputs = complaints.take(arguments.output.prepare(&[], &inputs));
    let plot = complaints.take(arguments.plot.prepare(&inputs));
    let ((study, wanted), (outputs, plot)) =
        complaints.finish(study.zip(wanted).zip(outputs.zip(plot)))?;
    let done = verbs(&study).orbit(&wanted)?;
    answer(arguments.study.json, done.as_ref(), outputs, plot)
}
