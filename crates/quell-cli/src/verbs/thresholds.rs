//! `quell thresholds`: exact values of a parameter at which the response changes.

use std::fmt::Write as _;

use clap::Args;
use quell::run::thresholds::{Protocol, Question, Thresholds, becomes, run as thresholds};
use quell::{Complaint, Failure};

use super::orbit::state;
use crate::answer::Answer;
use crate::arguments::{Complaints, StudyArguments};
use crate::table::figure;

/// Finds the values of a parameter at which dither begins or ceases to quench, exactly
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    study: StudyArguments,
    /// Path of the parameter, such as dither.amplitude
    #[arg(long, value_name = "PATH")]
    parameter: String,
    /// First value
    #[arg(long, value_name = "A", allow_hyphen_values = true)]
    from: String,
    /// Last value
    #[arg(long, value_name = "B", allow_hyphen_values = true)]
    to: String,
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
}

/// Answers.
pub(crate) fn run(arguments: &Arguments) -> Result<Answer, Failure> {
    let mut complaints = Complaints::default();
    let study = complaints.take(arguments.study.read());
    let from = complaints.take(number("--from", &arguments.from));
    let to = complaints.take(number("--to", &arguments.to));
    let start =
        complaints.take(arguments.start.as_deref().map(|it| state("--start", it)).transpose());
    let (study, (range, start)) = complaints.finish(study.zip(from.zip(to).zip(start)))?;
    let (from, to) = range;
    if from >= to {
        let allowed = format!("a number above --from {from}");
        return Err(Complaint::option("--to", to, allowed).into());
    }
    let flags = [
        (arguments.from_rest, Protocol::Rest),
        (arguments.from_sliding, Protocol::Sliding),
        (arguments.from_squeal, Protocol::Squeal),
    ];
    let mut protocols: Vec<Protocol> =
        flags.into_iter().filter(|(asked, _)| *asked).map(|(_, protocol)| protocol).collect();
    protocols.extend(start.map(|(x, v)| Protocol::From(x, v)));
    let question = Question { parameter: arguments.parameter.clone(), from, to, protocols };
    let done = thresholds(&study, question)?;
    Ok(Answer::new(arguments.study.json, || done.json(), || text(&done)))
}

fn number(option: &'static str, text: &str) -> Result<f64, Failure> {
    text.trim().parse::<f64>().ok().filter(|it| it.is_finite()).ok_or_else(|| {
        Complaint::option(option, text, "a finite number in the numbers of the equations").into()
    })
}

fn text(done: &Thresholds) -> String {
    let question = &done.question;
    let mut text = format!(
        "{} from {} to {}, the response that sliding becomes under dither:\n",
        question.parameter, question.from, question.to
    );
    for threshold in &done.local {
        let _ = writeln!(
            text,
            "  {:<14}  {:<15}  {} above",
            figure(threshold.value),
            threshold.kind.name(),
            threshold.becomes.name()
        );
    }
    if done.local.is_empty() {
        text.push_str("  no local threshold\n");
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
