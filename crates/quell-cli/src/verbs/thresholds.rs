//! `quell thresholds`: exact values of a parameter at which the response changes.

use std::fmt::Write as _;

use clap::Args;
use quell::run::curves::{Curves, Question as CurveQuestion, run as curves};
use quell::run::thresholds::{
    Ending, Protocol, Question, Thresholds, becomes, run as thresholds, side,
};
use quell::{Complaint, Failure, Fault, Origin, Study, picture, quantity};

use super::numbers::{VariedArguments, state, window};
use crate::answer::Answer;
use crate::arguments::{Complaints, OutputArguments, Outputs, Plot, PlotArguments, StudyArguments};
use crate::table::figure;

/// Finds the values of a parameter at which dither begins or ceases to quench, exactly
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    study: StudyArguments,
    #[command(flatten)]
    varied: VariedArguments,
    /// Also for runs from rest
    #[arg(long)]
    from_rest: bool,
    /// Also for runs from steady sliding without dither
    #[arg(long)]
    from_sliding: bool,
    /// Also for runs that squeal when the dither is switched on
    #[arg(long)]
    from_squeal: bool,
    /// Also for runs from this state
    #[arg(long, value_name = "X,V", allow_hyphen_values = true)]
    start: Option<String>,
    /// Lets the dither of these runs grow over this time τ, in steps of its period, instead of switching it on
    #[arg(long, value_name = "T", default_value = "0", allow_hyphen_values = true)]
    ramp: String,
    /// Follows each local threshold as a curve along a second parameter, such as belt.belt_velocity
    #[arg(long, value_name = "PATH", requires = "between", conflicts_with_all = ["from_rest", "from_sliding", "from_squeal", "start", "ramp"])]
    along: Option<String>,
    /// The window of the second parameter
    #[arg(long, value_name = "C:D", requires = "along", allow_hyphen_values = true)]
    between: Option<String>,
    #[command(flatten)]
    output: OutputArguments,
    #[command(flatten)]
    plot: PlotArguments,
}

/// Answers.
pub(crate) fn run(arguments: &Arguments) -> Result<Answer, Failure> {
    let mut complaints = Complaints::default();
    let study = complaints.take(arguments.study.read());
    let range = arguments.varied.ends(&mut complaints);
    let between = arguments.between.as_deref().map(|it| window("--between", it));
    let between = complaints.take(between.transpose());
    let start = arguments.start.as_deref().map(|it| state("--start", it));
    let start = complaints.take(start.transpose());
    let ramp = complaints.take(quantity::duration(&arguments.ramp, None, "--ramp"));
    let outputs = complaints.take(arguments.output.prepare(&[]));
    let plot = complaints.take(arguments.plot.prepare());
    if arguments.output.saves() && arguments.along.is_none() {
        let (key, allowed) = ("--save", "--save is for the curves of --along: give both");
        let complaint = Complaint::new(Fault::Usage, key, Origin::Whole, key, allowed);
        complaints.take::<()>(Err(complaint));
    }
    let (begun, files) = (start.zip(ramp), outputs.zip(plot));
    let (study, ((range, begun), (between, (outputs, plot)))) =
        complaints.finish(study.zip(range.zip(begun).zip(between.zip(files))))?;
    match arguments.along.clone().zip(between) {
        Some((along, between)) => {
            let parameter = arguments.varied.parameter.clone();
            let question = CurveQuestion { parameter, window: range, along, between };
            followed(arguments, &study, question, outputs, plot)
        }
        None => on_a_line(arguments, &study, range, begun, plot),
    }
}

/// Thresholds of one parameter.
fn on_a_line(
    arguments: &Arguments,
    study: &Study,
    (from, to): (f64, f64),
    (start, ramp): (Option<(f64, f64)>, f64),
    plot: Plot,
) -> Result<Answer, Failure> {
    let flags = [
        (arguments.from_rest, Protocol::Rest),
        (arguments.from_sliding, Protocol::Sliding),
        (arguments.from_squeal, Protocol::Squeal),
    ];
    let mut protocols: Vec<Protocol> =
        flags.into_iter().filter(|(asked, _)| *asked).map(|(_, protocol)| protocol).collect();
    protocols.extend(start.map(|(x, v)| Protocol::From(x, v)));
    let parameter = arguments.varied.parameter.clone();
    let question = Question { parameter, from, to, protocols, ramp };
    let done = thresholds(study, question)?;
    let mut object = done.json();
    plot.write(|| picture::thresholds(study, &done), &mut object)?;
    Ok(Answer::new(arguments.study.json, || object, || text(&done)))
}

/// Curves of thresholds in two parameters.
fn followed(
    arguments: &Arguments,
    study: &Study,
    question: CurveQuestion,
    outputs: Outputs,
    plot: Plot,
) -> Result<Answer, Failure> {
    let done = curves(study, question)?;
    let mut object = done.json(study);
    outputs.write(&[done.dataset(study)], &mut object)?;
    plot.write(|| picture::curves(study, &done), &mut object)?;
    Ok(Answer::new(arguments.study.json, || object, || text_of_curves(&done)))
}

fn text_of_curves(done: &Curves) -> String {
    let mut text = done.sentence() + "\n";
    for curve in &done.curves {
        let [first, last] = curve.ends.map(quell::run::curves::Ending::name);
        let _ =
            writeln!(text, "\n{}, from its end ({first}) to its end ({last}):", curve.kind.name());
        let _ = writeln!(text, "  {:<14}  {:<14}", done.question.along, done.question.parameter);
        let every = curve.points.len().div_ceil(12).max(1);
        let last = curve.points.len().saturating_sub(1);
        for (number, point) in curve.points.iter().enumerate() {
            if number % every == 0 || number == last {
                let _ =
                    writeln!(text, "  {:<14}  {:<14}", figure(point.along), figure(point.value));
            }
        }
    }
    text
}

fn text(done: &Thresholds) -> String {
    let question = &done.question;
    let mut text = format!(
        "{} from {} to {}, the response that sliding becomes under dither:\n",
        question.parameter, question.from, question.to
    );
    for threshold in &done.local.thresholds {
        let _ = writeln!(
            text,
            "  {:<14}  {:<15}  {} below, {} above",
            figure(threshold.value),
            threshold.kind.name(),
            side(threshold.was),
            side(threshold.becomes)
        );
    }
    if done.local.thresholds.is_empty() {
        text.push_str("  no local threshold\n");
    }
    if done.local.ending != Ending::Covered {
        let _ = writeln!(text, "{}", done.sentence());
    }
    for change in &done.local.changes {
        let words = |it: &Option<_>| {
            it.as_ref().map_or("none".to_owned(), quell::run::thresholds::Signature::words)
        };
        let (below, above) = (words(&change.below), words(&change.above));
        let _ = writeln!(text, "  {:<14}  {below} below, {above} above", figure(change.value));
    }
    for (protocol, switches) in &done.protocols {
        let _ = writeln!(text, "runs {}:", protocol.name().replace('_', " "));
        for switch in switches {
            let _ =
                writeln!(text, "  {:<14}  {} above", figure(switch.value), becomes(switch.becomes));
        }
        if switches.is_empty() {
            text.push_str("  the same everywhere\n");
        }
    }
    text
}
