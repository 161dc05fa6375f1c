//! `quell simulate`: one trajectory with its events.

use std::fmt::Write as _;

use clap::Args;
use quell::picture;
use quell::run::simulate::{Options, Simulation, run as simulate};
use quell::{Failure, Study};
use quell_model::units::Quantity;

use super::numbers::duration;
use crate::answer::Answer;
use crate::arguments::{Complaints, OutputArguments, PlotArguments, StudyArguments, inputs};
use crate::table::{Table, figure_of};

/// Simulates one run with every event at the contact
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    study: StudyArguments,
    /// Duration τ; in a study in SI seconds, or a time such as 50ms
    #[arg(long, value_name = "T", allow_hyphen_values = true)]
    until: String,
    /// Lists every event; with --save also as a file of its own, such as run_events.csv beside run.csv
    #[arg(long)]
    events: bool,
    #[command(flatten)]
    plot: PlotArguments,
    #[command(flatten)]
    output: OutputArguments,
}

/// Answers.
pub(crate) fn run(arguments: &Arguments) -> Result<Answer, Failure> {
    let mut complaints = Complaints::default();
    let study = complaints.take(arguments.study.read());
    let inputs = inputs(study.as_ref(), Study::inputs);
    let until = complaints.take(duration("--until", &arguments.until, study.as_ref()));
    let parts: &[&str] = if arguments.events { &["events"] } else { &[] };
    let outputs = complaints.take(arguments.output.prepare(parts, &inputs));
    let plot = complaints.take(arguments.plot.prepare(&inputs));
    let ((study, until), (outputs, plot)) =
        complaints.finish(study.zip(until).zip(outputs.zip(plot)))?;

    let options = Options {
        events: arguments.events,
        samples: arguments.output.saves() || plot.wanted(),
        undithered: plot.wanted(),
    };
    let done = simulate(&study, until, options)?;
    let mut object = done.json(&study);
    outputs.write(&[done.dataset(&study), done.events_dataset(&study)], &mut object)?;
    plot.write(|| picture::simulate(&study, &done), &mut object)?;
    Ok(Answer::new(arguments.study.json, &object, || text(&study, &done)))
}

fn text(study: &Study, done: &Simulation) -> String {
    let mut text = done.sentence(study) + "\n";
    if let Some(events) = &done.events {
        text.push('\n');
        let symbol = if study.scales().is_some() { "t" } else { "τ" };
        let _ = writeln!(text, "  {symbol:>14}  {:<8}  {:>4}  {:>14}", "event", "slip", "x");
        for event in events {
            let time = figure_of(study, Quantity::Time, event.time);
            let place = figure_of(study, Quantity::Displacement, event.displacement);
            let _ = writeln!(
                text,
                "  {time:>14}  {:<8}  {:>4}  {place:>14}",
                event.kind.name(),
                event.slip_sign
            );
        }
        text.push('\n');
    }
    let end = &done.end;
    let mut table = Table::new(study.scales());
    table.number("time τ", Quantity::Time, end.time);
    table.number("displacement x", Quantity::Displacement, end.displacement);
    table.number("velocity x′", Quantity::Velocity, end.velocity);
    table.word("sticking", if end.sticking { "yes" } else { "no" });
    table.word("events", &end.events.to_string());
    table.word("steps", &end.steps.to_string());
    text + &table.text()
}
