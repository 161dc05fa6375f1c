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
use crate::table::{Table, figure};

/// Computes one trajectory with every event at the contact
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    study: StudyArguments,
    /// How long: τ, or a time such as 0.5s in a study in SI
    #[arg(long, value_name = "T", allow_hyphen_values = true)]
    until: String,
    /// Lists every event
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
    let outputs = complaints.take(arguments.output.prepare(&[], &inputs));
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
    outputs.write(&[done.dataset(&study)], &mut object)?;
    plot.write(|| picture::simulate(&study, &done), &mut object)?;
    Ok(Answer::new(arguments.study.json, &object, || text(&study, &done)))
}

fn text(study: &Study, done: &Simulation) -> String {
    let mut text = done.sentence(study) + "\n";
    if let Some(events) = &done.events {
        text.push('\n');
        let _ = writeln!(text, "  {:>14}  {:<8}  {:>4}  {:>14}", "τ", "event", "slip", "x");
        for event in events {
            let (time, place) = (figure(event.time), figure(event.displacement));
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
