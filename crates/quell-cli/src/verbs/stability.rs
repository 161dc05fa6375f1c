//! `quell stability`: averaged stability of steady sliding; eigenvalues or Floquet exponents of a disc.

use std::fmt::Write as _;

use clap::Args;
use quell::picture;
use quell::run::disc;
use quell::run::stability::{
    Averaged, DECIBELS, LOOKED_AT, SlopeSide, Stability, becomes, growth_rate, kind,
    run as stability,
};
use quell::{DiscStudy, Failure, Study, Subject};
use quell_model::units::Quantity;

use crate::answer::Answer;
use crate::arguments::{Complaints, Plot, PlotArguments, StudyArguments, inputs};
use crate::table::{Table, figure, figure_of, in_hertz, in_rpm};

/// Most marginal frictions that are told in words.
const MOST_CHANGES: usize = 6;

/// Decides whether steady sliding (by averaging) or a disc (by eigenvalues) is stable, and what changes that
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
    let hertz = study.reference_hz();
    let rate = |rate: f64| {
        let per_second = hertz.map(|hertz| std::f64::consts::TAU * hertz * rate);
        let si = per_second
            .map(|rate| format!(" ({} 1/s, {} dB/s)", figure(rate), figure(DECIBELS * rate)));
        format!("{} ω_ref{}", figure(rate), si.unwrap_or_default())
    };
    let frequency =
        |frequency: f64| format!("{} ω_ref{}", figure(frequency), in_hertz(study, &[frequency]));
    if hertz.is_some() {
        table.word("speed Ω", &speed_in_words(study));
    }
    table.word("growth rate", &rate(done.growth.rate));
    table.word("  error at most", &format!("{} ω_ref", figure(done.growth.error)));
    table.word("frequency", &frequency(done.growth.frequency));
    table.word("growth rate without dither", &rate(done.undithered.rate));
    for mode in &done.unstable {
        let words = format!("{}, growth rate {}", frequency(mode.frequency), rate(mode.rate));
        table.word("unstable mode", &words);
    }
    let newtons = study.scales(0).and_then(|it| it.si_per_unit(Quantity::LoadFriction));
    match &done.changes {
        Ok(changes) => {
            for change in changes.iter().take(MOST_CHANGES) {
                let force = newtons.map(|unit| format!(" ({} N)", figure(change.friction * unit)));
                let words = format!(
                    "{}{} at frequency {}",
                    figure(change.friction),
                    force.unwrap_or_default(),
                    frequency(change.frequency)
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

/// The speed of the loads, in rpm and, where the radius of the first load is known, in km/h.
fn speed_in_words(study: &DiscStudy) -> String {
    let speed = study.disc().speed();
    let radius = study.scales(0).and_then(|scales| scales.load_radius_m);
    let along = study.reference_hz().zip(radius).map(|(hertz, radius)| {
        format!(
            ", {} km/h at the load",
            figure(3.6 * std::f64::consts::TAU * hertz * radius * speed)
        )
    });
    format!("{} ω_ref{}{}", figure(speed), in_rpm(study, speed), along.unwrap_or_default())
}

fn text(study: &Study, done: &Stability) -> String {
    let mut text = format!("{}\n", done.sentence(study));
    match &done.sharper {
        Ok(sharper) => {
            text.push_str(
                "\nFinite-R averaging, with the oscillator's own response to the dither:\n",
            );
            text += &averaged(study, sharper);
            text.push_str("\nIn the limit of high dither frequency:\n");
            text += &averaged(study, &done.limit);
        }
        Err(why) => {
            text += &averaged(study, &done.limit);
            let _ = writeln!(text, "\nNo finite-R averaging: {why}.");
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
        table.rate("growth rate", growth_rate(criterion.value));
        table.number("effective friction μ̄", Quantity::Ratio, criterion.effective.coefficient);
        if criterion.effective.side == SlopeSide::Outer {
            table.word("  one-sided", "the slope is that for slightly faster belts");
        }
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
                if !critical.contact_stays_closed {
                    table.word("  contact", "would be pulled apart");
                }
            }
        }
        Err(why) => table.word("critical amplitudes", &format!("unknown: {why}")),
    }
    let label = "stable at every v₀ from α";
    match &found.everywhere_stable {
        Ok(ratio) => {
            table.number(label, Quantity::Velocity, *ratio);
            let rate = study.belt().dithers().first().map_or(0.0, |it| it.frequency_ratio);
            table.number("  D", Quantity::Force, ratio * rate);
        }
        Err(why) => table.word(label, &format!("none: {why}")),
    }
    if let Ok(bands) = &found.unstable_bands {
        let bands: Vec<String> = bands
            .iter()
            .map(|band| {
                let lower = figure_of(study, Quantity::Velocity, band.lower);
                match band.upper {
                    Some(upper) => {
                        format!("{lower} to {}", figure_of(study, Quantity::Velocity, upper))
                    }
                    None => format!("{lower} upwards, no end met {LOOKED_AT}"),
                }
            })
            .collect();
        let bands = if bands.is_empty() { "none".to_owned() } else { bands.join(", ") };
        table.word("unstable belt velocities", &bands);
    }
    table.text()
}
