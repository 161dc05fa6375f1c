//! `quell thresholds`: exact values of a parameter at which the response changes.

use std::fmt::Write as _;

use clap::Args;
use quell::run::curves::{Curves, Question as CurveQuestion, run as curves};
use quell::run::thresholds::{
    Protocol, Question, TRIED, Thresholds, becomes, path_in_words, quantity_of, run as thresholds,
    side, value_in_words,
};
use quell::{Complaint, Failure, Fault, Origin, Study, picture};

use super::numbers::{VariedArguments, duration, state, window};
use crate::answer::Answer;
use crate::arguments::{
    Complaints, OutputArguments, Outputs, Plot, PlotArguments, StudyArguments, inputs,
};
use crate::table::figure_of;

/// Finds the values of a parameter at which dither begins or ceases to quench
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    study: StudyArguments,
    #[command(flatten)]
    varied: VariedArguments,
    /// Also finds them for runs from rest
    #[arg(long)]
    from_rest: bool,
    /// Also finds them for runs from steady sliding without dither
    #[arg(long)]
    from_sliding: bool,
    /// Also finds them for runs in full squeal when the dither is switched on
    #[arg(long)]
    from_squeal: bool,
    /// Also finds them for runs from this state; in a study in SI metres and m/s, or with units such as 1um,50mm/s
    #[arg(long, value_name = "X,V", allow_hyphen_values = true)]
    start: Option<String>,
    /// Raises the dither of these runs over this time τ, in steps of its period, instead of switching it on; in a study in SI
    /// seconds, or a time such as 50ms
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

/// Answers.
pub(crate) fn run(arguments: &Arguments) -> Result<Answer, Failure> {
    let mut complaints = Complaints::default();
    let study = complaints.take(arguments.study.read());
    let inputs = inputs(study.as_ref(), Study::inputs);
    let range = arguments.varied.ends(&mut complaints);
    let along = arguments.along.as_deref().unwrap_or_default();
    let between = arguments.between.as_deref().map(|it| window("--between", it, along));
    let between = complaints.take(between.transpose());
    let start = arguments.start.as_deref().map(|it| state("--start", it, study.as_ref()));
    let start = complaints.take(start.transpose());
    let ramp = complaints.take(duration("--ramp", &arguments.ramp, study.as_ref()));
    let outputs = complaints.take(arguments.output.prepare(&[], &inputs));
    let plot = complaints.take(arguments.plot.prepare(&inputs));
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
            followed(arguments, &study, &question, outputs, plot)
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
    let mut object = done.json(study);
    plot.write(|| picture::thresholds(study, &done), &mut object)?;
    Ok(Answer::new(arguments.study.json, &object, || text(study, &done)))
}

/// Curves of thresholds in two parameters.
fn followed(
    arguments: &Arguments,
    study: &Study,
    question: &CurveQuestion,
    outputs: Outputs,
    plot: Plot,
) -> Result<Answer, Failure> {
    let done = curves(study, question)?;
    let mut object = done.json(study);
    outputs.write(&[done.dataset(study)], &mut object)?;
    plot.write(|| picture::curves(study, &done), &mut object)?;
    Ok(Answer::new(arguments.study.json, &object, || text_of_curves(study, &done)))
}

fn text_of_curves(study: &Study, done: &Curves) -> String {
    let mut text = done.sentence(study) + "\n";
    let (parameter, across) = (&done.question.parameter, &done.question.along);
    for curve in &done.curves {
        let [first, last] = curve.ends.map(quell::run::curves::Ending::name);
        let _ =
            writeln!(text, "\n{}, from its end ({first}) to its end ({last}):", curve.kind.name());
        let [x, y] = [across, parameter].map(|path| path_in_words(study, path));
        let _ = writeln!(text, "  {x:<14}  {y:<14}");
        let every = curve.points.len().div_ceil(12).max(1);
        let last = curve.points.len().saturating_sub(1);
        for (number, point) in curve.points.iter().enumerate() {
            if number % every == 0 || number == last {
                let along = figure_at(study, across, point.along);
                let value = figure_at(study, parameter, point.value);
                let _ = writeln!(text, "  {along:<14}  {value:<14}");
            }
        }
    }
    text
}

/// A value of a number of the equations, in SI where the study is.
fn figure_at(study: &Study, path: &str, value: f64) -> String {
    figure_of(study, quantity_of(study, path), value)
}

fn text(study: &Study, done: &Thresholds) -> String {
    let question = &done.question;
    let given = question.parameter.as_str();
    let path = path_in_words(study, given);
    let figure = |value: f64| figure_at(study, given, value);
    let whole = |value: f64| value_in_words(study, given, value);
    let response =
        if study.belt().dithers().is_empty() { "steady sliding" } else { "the base response" };
    let mut text = format!(
        "{}\n\n{path} from {} to {}, {response}:\n",
        done.sentence(study),
        whole(question.from),
        whole(question.to)
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
    for change in &done.local.changes {
        let words = |it: &Option<_>| {
            it.as_ref().map_or("none".to_owned(), quell::run::thresholds::Signature::words)
        };
        let (below, above) = (words(&change.below), words(&change.above));
        let _ = writeln!(text, "  {:<14}  {below} below, {above} above", figure(change.value));
    }
    for (protocol, switches) in &done.protocols {
        let _ = writeln!(
            text,
            "runs {} (at {} values; pairs of changes between two of them are not seen):",
            protocol.name().replace('_', " "),
            TRIED + 1
        );
        let first = becomes(switches.first, done.in_band);
        if switches.changes.is_empty() {
            let _ = writeln!(text, "  {first} at every value of the range");
        } else {
            let _ = writeln!(text, "  {:<14}  {first}", figure(question.from));
        }
        for switch in &switches.changes {
            let value = figure(switch.value);
            let error = if switch.is_close() {
                String::new()
            } else {
                format!(", to ± {}", figure(switch.error))
            };
            let _ = writeln!(
                text,
                "  {value:<14}  {} above{error}",
                becomes(switch.becomes, done.in_band)
            );
        }
    }
    text
}
