//! `quell stability`: averaged stability of steady sliding.

use std::fmt::Write as _;

use clap::Args;
use quell::picture;
use quell::run::stability::{Averaged, Stability, becomes, kind, run as stability};
use quell::{Failure, Study};
use quell_model::units::Quantity;

use crate::answer::Answer;
use crate::arguments::{Complaints, PlotArguments, StudyArguments};
use crate::table::{Table, figure};

/// Says whether steady sliding is stable by averaging, and which dither changes that
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    study: StudyArguments,
    #[command(flatten)]
    plot: PlotArguments,
}

/// Answers.
pub(crate) fn run(arguments: &Arguments) -> Result<Answer, Failure> {
    let mut complaints = Complaints::default();
    let study = complaints.take(arguments.study.read());
    let plot = complaints.take(arguments.plot.prepare());
    let (study, plot) = complaints.finish(study.zip(plot))?;

    let done = stability(&study);
    let mut object = done.json(&study);
    plot.write(|| picture::stability(&study, &done), &mut object)?;
    let answer = Answer::new(arguments.study.json, || object, || text(&study, &done));
    Ok(answer.warning(done.warnings(&study)))
}

fn text(study: &Study, done: &Stability) -> String {
    let mut text = format!("{}\n", done.sentence(study));
    text += &averaged(study, &done.limit);
    match &done.sharper {
        Ok(sharper) => {
            text.push_str("\nSharper, with the oscillator's own response to the dither:\n");
            text += &averaged(study, sharper);
        }
        Err(why) => {
            let _ = writeln!(text, "\nNo sharper averaging: {why}.");
        }
    }
    text
}

fn averaged(study: &Study, found: &Averaged) -> String {
    let mut table = Table::new(study.scales());
    table.word("verdict", found.verdict());
    let value = found.criterion.as_ref().map(|criterion| criterion.value);
    table.known("criterion 2ζ + Fμ̄′", Quantity::Ratio, value.map_err(ToString::to_string));
    if let Ok(criterion) = &found.criterion {
        table.number("  error", Quantity::Ratio, criterion.error);
    }
    match &found.critical_amplitudes {
        Ok(list) => {
            for critical in list {
                let label = format!("{} from α", becomes(critical.becomes));
                table.number(&label, Quantity::Velocity, critical.amplitude_ratio);
                table.number(
                    &format!("  D, by a {}", kind(critical.crossing)),
                    Quantity::Force,
                    critical.amplitude,
                );
            }
        }
        Err(why) => table.word("critical amplitudes", &format!("unknown: {why}")),
    }
    let label = "stable at every v₀ from α";
    match &found.everywhere_stable {
        Ok(ratio) => table.number(label, Quantity::Velocity, *ratio),
        Err(why) => table.word(label, &format!("none: {why}")),
    }
    if let Ok(bands) = &found.unstable_bands {
        let bands: Vec<String> = bands
            .iter()
            .map(|band| {
                let upper = band.upper.map_or_else(|| "∞".to_owned(), figure);
                format!("{} to {upper}", figure(band.lower))
            })
            .collect();
        let bands = if bands.is_empty() { "none".to_owned() } else { bands.join(", ") };
        table.word("unstable belt velocities", &bands);
    }
    table.text()
}
