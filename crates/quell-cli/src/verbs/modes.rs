//! `quell modes`: natural frequencies and shapes of a disc.

use std::fmt::Write as _;

use clap::Args;
use quell::picture;
use quell::run::disc::modes::{Modes, run as modes};
use quell::{DiscStudy, Failure};

use crate::answer::Answer;
use crate::arguments::{Complaints, OutputArguments, PlotArguments, StudyArguments, inputs};
use crate::table::figure;

/// Computes the natural frequencies, shapes and critical speeds of a disc
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    study: StudyArguments,
    #[command(flatten)]
    output: OutputArguments,
    #[command(flatten)]
    plot: PlotArguments,
}

/// Answers.
pub(crate) fn run(arguments: &Arguments) -> Result<Answer, Failure> {
    let mut complaints = Complaints::default();
    let study = complaints.take(arguments.study.read_disc());
    let inputs = inputs(study.as_ref(), DiscStudy::inputs);
    let output = complaints.take(arguments.output.prepare(&[], &inputs));
    let plot = complaints.take(arguments.plot.prepare(&inputs));
    let (study, (output, plot)) = complaints.finish(study.zip(output.zip(plot)))?;

    let done = modes(&study);
    let mut object = done.json(&study);
    output.write(&[done.dataset(&study)], &mut object)?;
    plot.try_write(|| picture::disc::modes(&study, &done), &mut object)?;
    Ok(Answer::new(arguments.study.json, &object, || text(&study, &done)))
}

fn text(study: &DiscStudy, done: &Modes) -> String {
    let mut text = String::new();
    if let Some(title) = study.title() {
        let _ = writeln!(text, "{title}");
    }
    let hertz = done.reference_hz.is_some();
    let _ =
        write!(text, "  (i, q)    {:>12}  {:>10}  {:>12}  {:>10}", "k²", "β", "φ at load", "β/q");
    let _ = writeln!(
        text,
        "{}",
        if hertz { format!("  {:>12}  {:>12}", "Hz", "rpm") } else { String::new() }
    );
    for (index, row) in done.rows.iter().enumerate() {
        let told = |value: Option<f64>| value.map_or_else(|| "-".to_owned(), figure);
        let _ = write!(
            text,
            "  ({}, {:>2})  {:>13}  {:>10}  {:>12}  {:>10}",
            row.radial,
            row.diameters,
            told(row.frequency_parameter),
            figure(row.ratio),
            figure(row.shape_at_load),
            told(row.critical_speed()),
        );
        if hertz {
            let _ = write!(
                text,
                "  {:>12}  {:>12}",
                told(row.frequency_hz),
                told(row.critical_speed_rpm())
            );
        }
        let _ = writeln!(
            text,
            "{}",
            if done.critical == Some(index) { "  lowest critical speed" } else { "" }
        );
    }
    text
}
