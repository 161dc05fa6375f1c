//! `quell stability`: averaged stability of steady sliding; eigenvalues or Floquet exponents of a disc.

use std::fmt::Write as _;

use clap::Args;
use quell::picture;
use quell::run::disc;
use quell::run::stability::{Averaged, LOOKED_AT, Stability, becomes, kind, run as stability};
use quell::{DiscStudy, Failure, Study, Subject};
use quell_model::units::Quantity;

use crate::answer::Answer;
use crate::arguments::{Complaints, Plot, PlotArguments, StudyArguments, inputs};
use crate::table::{Table, figure};

/// Most marginal frictions that are told in words.
const MOST_CHANGES: usize = 6;

/// Says whether steady sliding (by averaging) or a disc (eigenvalues, Floquet exponents) is stable, and what changes that
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
    let study = complaints.take(arguments.study.read_any());
    let inputs = inputs(study.as_ref(), Subject::inputs);
    let plot = complaints.take(arguments.plot.prepare(&inputs));
    let (study, plot) = complaints.finish(study.zip(plot))?;
    let study = match study {
        Subject::Belt(study) => *study,
        Subject::Disc(study) => return of_disc(&study, plot, arguments.study.json),
    };

    let done = stability(&study);
    let mut object = done.json(&study);
    plot.write(|| picture::stability(&study, &done), &mut object)?;
    Ok(Answer::new(arguments.study.json, &object, || text(&study, &done)))
}

fn of_disc(study: &DiscStudy, plot: Plot, json: bool) -> Result<Answer, Failure> {
    let done = disc::stability::run(study)?;
    let mut object = done.json(study);
    let last = disc::campbell::usual_end(study);
    let figure = || {
        let campbell = disc::campbell::run(study, last)?;
        Ok(picture::disc::stability(study, &done, &campbell))
    };
    plot.try_write(figure, &mut object)?;
    Ok(Answer::new(json, &object, || text_of_disc(study, &done)))
}

fn text_of_disc(study: &DiscStudy, done: &disc::stability::Stability) -> String {
    let mut table = Table::new(None);
    table.word("verdict", done.growth.verdict().name());
    table.word("growth rate", &format!("{} ω_ref", figure(done.growth.rate)));
    table.word("  error at most", &format!("{} ω_ref", figure(done.growth.error)));
    table.word("frequency", &format!("{} ω_ref", figure(done.growth.frequency)));
    table.word("growth rate without dither", &format!("{} ω_ref", figure(done.undithered.rate)));
    match &done.changes {
        Ok(changes) => {
            for change in changes.iter().take(MOST_CHANGES) {
                let words = format!(
                    "{} at frequency {}",
                    figure(change.friction),
                    figure(change.frequency)
                );
                table.word("marginal at friction f*", &words);
            }
        }
        Err(why) => table.word("marginal frictions", &format!("unknown: {why}")),
    }
    if done.out_of_reach {
        table.word(
            "out of reach",
            "a motion that the load does not reach is marginal at any friction",
        );
    }
    let without = study.without();
    if !without.is_empty() {
        table.word("without", &without.join(", "));
    }
    format!("{}\n{}", done.sentence(study), table.text())
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
                let lower = figure(band.lower);
                match band.upper {
                    Some(upper) => format!("{lower} to {}", figure(upper)),
                    None => format!("{lower} upwards, no end met {LOOKED_AT}"),
                }
            })
            .collect();
        let bands = if bands.is_empty() { "none".to_owned() } else { bands.join(", ") };
        table.word("unstable belt velocities", &bands);
    }
    table.text()
}
