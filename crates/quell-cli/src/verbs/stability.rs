//! `quell stability`: stability of steady sliding by averaging or eigenvalues, of a disc by Floquet exponents too.

use clap::{Args, ValueHint};
use quell::run::system::tracked::TrackRequest;
use quell::verbs::verbs;
use quell::{RealInterval, Complaint, Failure, Fault, Origin, Study};

use super::numbers::{number, window};
use crate::answer::Answer;
use crate::arguments::{Gathered, OutputArguments, PlotArguments, StudyArguments, answer, inputs};

/// Decides whether steady sliding is stable (by eigenvalues, under dither by averaging), and what would change that
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    study: StudyArguments,
    /// Follows the eigenvalues of a belt or a system over this number, such as contact.pad.friction.coefficient
    #[arg(long, value_name = "PATH", requires_all = ["from", "to"], value_hint = ValueHint::Other)]
    parameter: Option<String>,
    /// Smallest value, in the unit of the key or with a unit
    #[arg(long, value_name = "A", allow_hyphen_values = true, requires = "parameter", value_hint = ValueHint::Other)]
    from: Option<String>,
    /// Largest value, in the unit of the key or with a unit
    #[arg(long, value_name = "B", allow_hyphen_values = true, requires = "parameter", value_hint = ValueHint::Other)]
    to: Option<String>,
    /// Follows each threshold as a curve along a second number
    #[arg(long, value_name = "PATH", requires_all = ["between", "parameter"], value_hint = ValueHint::Other)]
    along: Option<String>,
    /// Range of the second number
    #[arg(long, value_name = "FROM:TO", requires = "along", allow_hyphen_values = true, value_hint = ValueHint::Other)]
    between: Option<String>,
    /// Decides by Floquet exponents of the dithered motion of a belt or a system, if that is pure slip
    #[arg(long, conflicts_with = "parameter")]
    exact: bool,
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
    let request = arguments.request(study.as_ref(), &mut complaints);
    let parts: &[&str] = if arguments.along.is_some() { &["eigenvalues"] } else { &[] };
    let outputs = complaints.take(arguments.output.prepare(parts, &inputs));
    let verb = match (&arguments.parameter, arguments.exact) {
        (Some(_), _) => "stability --parameter",
        (None, true) => "stability --exact",
        (None, false) => "stability",
    };
    let plot = arguments.plot.prepare(&inputs);
    let plot = complaints.take(plot.and_then(|plot| plot.drawn_by(study.as_ref(), verb)));
    if arguments.output.saves() && arguments.parameter.is_none() {
        let (key, allowed) =
            ("--save", "--save saves the eigenvalues of --parameter, and requires that option");
        let complaint = Complaint::new(Fault::Usage, key, Origin::Whole, key, allowed);
        complaints.take::<()>(Err(complaint));
    }
    let (study, (request, (outputs, plot))) =
        complaints.finish(study.zip(request.zip(outputs.zip(plot))))?;
    let verbs = verbs(&study);
    let done = match request {
        Some(request) => verbs.tracked_stability(&request)?,
        None if arguments.exact => verbs.exact_stability()?,
        None => verbs.stability()?,
    };
    answer(arguments.study.json, done.as_ref(), outputs, plot)
}

impl Arguments {
    /// What to follow; the inner option is empty if nothing is.
    #[expect(clippy::option_option, reason = "not given, and given but invalid, differ")]
    fn request(
        &self,
        study: Option<&Study>,
        complaints: &mut Gathered,
    ) -> Option<Option<TrackRequest>> {
        let (Some(parameter), Some(from), Some(to)) = (&self.parameter, &self.from, &self.to)
        else {
            return Some(None);
        };
        let from = complaints.take(number("--from", from, parameter, study));
        let to = complaints.take(number("--to", to, parameter, study));
        let along = match (&self.along, &self.between) {
            (Some(path), Some(text)) => {
                let between = complaints.take(window("--between", text, path, study));
                Some((path.clone(), between?))
            }
            _ => None,
        };
        Some(Some(TrackRequest { parameter: parameter.clone(), window: RealInterval::new(from?, to?), along }))
    }
}
