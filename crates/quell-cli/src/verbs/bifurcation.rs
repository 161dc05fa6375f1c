//! `quell bifurcation`: the response along a parameter, swept up and down.

use std::fmt::Write as _;

use clap::Args;
use quell::run::attractor::words;
use quell::run::bifurcation::{Bifurcation, Branch, Question, run as bifurcation};
use quell::run::varied::Range;
use quell::sweep::Running;
use quell::{Failure, Study, picture};

use super::numbers::{VariedArguments, count};
use crate::answer::Answer;
use crate::arguments::{Complaints, OutputArguments, PlotArguments, StudyArguments, inputs};
use crate::interrupt;
use crate::progress::Bar;
use crate::table::figure;

/// Sweeps a parameter up and down and carries the state along: sections, locking, hysteresis
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    study: StudyArguments,
    #[command(flatten)]
    varied: VariedArguments,
    /// Number of values
    #[arg(long, value_name = "N", default_value = "101", allow_hyphen_values = true)]
    points: String,
    /// Sweeps up, from the start of the study [default: up, then down]
    #[arg(long)]
    up: bool,
    /// Sweeps down, from the end of the sweep up; without --up, from the start of the study
    #[arg(long)]
    down: bool,
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
    let ends = arguments.varied.ends(&mut complaints);
    let points = complaints.take(count("--points", &arguments.points));
    let output = complaints.take(arguments.output.prepare(&[], &inputs));
    let plot = complaints.take(arguments.plot.prepare(&inputs));
    let ((study, points), ((from, to), (output, plot))) =
        complaints.finish(study.zip(points).zip(ends.zip(output.zip(plot))))?;
    let range = Range { parameter: arguments.varied.parameter.clone(), from, to, points };
    let question = Question { range, up: arguments.up, down: arguments.down };
    let bar = Bar::new();
    let running = Running { threads: None, stop: interrupt::flag(), progress: &bar };
    let done = bifurcation(&study, &question, running)?;
    let mut object = done.json(&study);
    output.write(&[done.dataset(&study)], &mut object)?;
    plot.write(|| picture::bifurcation(&study, &done), &mut object)?;
    Ok(Answer::new(arguments.study.json, &object, || text(&study, &done)))
}

fn text(study: &Study, done: &Bifurcation) -> String {
    let mut text = String::new();
    if let Some(title) = study.title() {
        let _ = writeln!(text, "{title}");
    }
    let _ = writeln!(text, "{}", done.sentence(study));
    for branch in &done.branches {
        let _ = writeln!(text, "\n{}:", branch.direction.name());
        for stretch in stretches(branch) {
            let _ = writeln!(text, "  {stretch}");
        }
    }
    text
}

/// Neighbouring values at which the same is to be said, one line each.
fn stretches(branch: &Branch) -> Vec<String> {
    let told = |place: usize| {
        let point = &branch.points[place];
        match &point.response {
            // The frequency of a curve changes from value to value: the kind is what a stretch has in common.
            Ok(attractor) if attractor.rotation.is_some_and(|it| it.ratio.is_none()) => {
                attractor.kind.words()
            }
            Ok(attractor) => words(point.scales, attractor, point.period),
            Err(_) => "not settled".to_owned(),
        }
    };
    let mut lines = Vec::new();
    let mut from = 0;
    for place in 0..branch.points.len() {
        let last = place + 1 == branch.points.len();
        if last || told(place + 1) != told(from) {
            let value = |place: usize| figure(branch.points[place].value);
            let ends = if from == place {
                value(place)
            } else {
                format!("{} to {}", value(from), value(place))
            };
            lines.push(format!("{ends:<22}  {}", told(from)));
            from = place + 1;
        }
    }
    lines
}
