//! `quell response`: the steady response, what the dither does to it, and what it costs.

use std::fmt::Write as _;

use clap::Args;
use quell::picture;
use quell::run::response::{Steady, run as respond};
use quell::{Failure, Study};
use quell_model::units::Quantity;

use crate::answer::Answer;
use crate::arguments::{Complaints, OutputArguments, PlotArguments, StudyArguments, inputs};
use crate::table::{Table, figure};

/// Most peaks in the table for people; JSON has them all.
const PEAKS: usize = 8;

/// Measures the steady response with and without dither, and the cost of the dither
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    study: StudyArguments,
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
    let outputs = complaints.take(arguments.output.prepare(&["spectrum"], &inputs));
    let plot = complaints.take(arguments.plot.prepare(&inputs));
    let (study, (outputs, plot)) = complaints.finish(study.zip(outputs.zip(plot)))?;

    let done = respond(&study)?;
    let mut object = done.json(&study);
    if arguments.output.saves() {
        outputs.write(&[done.record(&study), done.spectrum(&study)], &mut object)?;
    }
    plot.write(|| picture::response(&study, &done), &mut object)?;
    Ok(Answer::new(arguments.study.json, &object, || text(&study, &done)))
}

fn text(study: &Study, done: &Steady) -> String {
    let response = &done.response;
    let mut table = Table::new(study.scales());
    table.word("effect", response.effect.name());
    table.word("ends on", response.ending.name());
    table.known(
        "residual vibration E",
        Quantity::Ratio,
        response.efficiency.map_err(|why| why.to_string()),
    );
    table.number("amplitude M", Quantity::Displacement, response.amplitude);
    table.number("undithered amplitude M₀", Quantity::Displacement, response.undithered_amplitude);
    table.number("stick fraction", Quantity::Ratio, response.stick_fraction);
    table.word("settled", if response.settled { "yes" } else { "no" });
    table.number("mean friction", Quantity::Force, response.mean_friction);
    table.number("  steady, undithered", Quantity::Force, response.mean_friction_undithered);
    table.known("friction lost", Quantity::Ratio, done.friction_loss());
    let only_normal = || "all dither is normal".to_owned();
    table.known("dither power", Quantity::Power, response.dither_power.ok_or_else(only_normal));
    table.known(
        "dither stroke",
        Quantity::Displacement,
        response.dither_stroke.ok_or_else(only_normal),
    );
    table.number("smallest normal load", Quantity::Force, response.minimum_normal_load);
    let mut text = format!("{}\n{}", done.sentence(study), table.text());
    if !response.peaks.is_empty() {
        text.push_str("\nPeaks of the spectrum, largest first:\n");
        let mut peaks = response.peaks.clone();
        peaks.sort_by(|a, b| b.amplitude.total_cmp(&a.amplitude));
        let hertz = study.scales().map(|scales| scales.si_per_unit(Quantity::FrequencyRatio));
        for peak in peaks.iter().take(PEAKS) {
            let hertz = hertz.map(|hertz| format!(" ({} Hz)", figure(peak.frequency * hertz)));
            let unit = if study.scales().is_some() { "m" } else { "length" };
            let (frequency, amplitude) = (figure(peak.frequency), figure(peak.amplitude));
            let hertz = hertz.unwrap_or_default();
            let _ = writeln!(text, "  {amplitude:>12} {unit} at {frequency} ω₀{hertz}");
        }
    }
    text
}
