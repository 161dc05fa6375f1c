//! The end of the record and the spectra, with and without dither.

use std::f64::consts::TAU;

use quell_dynamics::response::BAND_END;
use quell_dynamics::simulation::Sample;
use quell_model::units::Quantity;
use quell_numerics::spectrum::Spectrum;

use super::both;
use super::caption::caption_of_run;
use super::ruler::{Ruler, time_axis};
use crate::plot::{Figure, Panel, Polyline, ReferenceLine, SharedLegend};
use crate::run::response::MeasuredResponse;
use crate::study::BeltStudy;

/// Number of slow periods of the record that are shown.
const PERIODS: f64 = 6.0;

/// Number of decades of the spectrum that are shown below its largest line.
const DECADES: i32 = 5;

/// The picture of a steady response.
pub fn response(study: &BeltStudy, done: &MeasuredResponse) -> Figure {
    let panels = [record(study, done), spectrum(study, done)];
    Figure::grid(1, panels)
        .legend(SharedLegend::Above)
        .title(study.title().unwrap_or_default())
        .caption(caption_of_run(study))
}

fn record(study: &BeltStudy, done: &MeasuredResponse) -> Panel {
    let end = |samples: &[Sample]| -> Vec<Sample> {
        let last = samples.last().map_or(0.0, |sample| sample.time);
        samples.iter().copied().filter(|sample| sample.time >= last - PERIODS * TAU).collect()
    };
    let with = end(&done.response.record.samples);
    let without = end(&done.response.undithered_record.samples);
    let samples = || with.iter().chain(&without);
    let time = Ruler::of(study, Quantity::Time, samples().map(|sample| sample.time));
    let place =
        Ruler::of(study, Quantity::Displacement, samples().map(|sample| sample.displacement));
    let curve = |samples: &[Sample], role| {
        let points = samples
            .iter()
            .map(|sample| (time.place(sample.time), place.place(sample.displacement)));
        Polyline::new(role, points.collect::<Vec<_>>())
    };
    let panel = Panel::new(time_axis(study, &time), place.axis("displacement", "x"));
    both(panel, study, |role, dithered| curve(if dithered { &with } else { &without }, role))
}

fn spectrum(study: &BeltStudy, done: &MeasuredResponse) -> Panel {
    let with = &done.response.record.spectrum;
    let without = &done.response.undithered_record.spectrum;
    let largest = |spectrum: &Spectrum| spectrum.amplitudes().iter().copied().fold(0.0, f64::max);
    let top = largest(with).max(largest(without));
    let fastest = study
        .belt()
        .dithers()
        .iter()
        .fold(0.0_f64, |rate, dither| rate.max(dither.frequency_ratio));
    let end = (1.3 * fastest).max(4.0);
    let rate = Ruler::new(study, Quantity::FrequencyRatio, end);
    let size = Ruler::new(study, Quantity::Displacement, top);
    let floor = top * 10f64.powi(-DECADES);
    let curve = |spectrum: &Spectrum, role| {
        let lines = spectrum.frequencies().zip(spectrum.amplitudes().iter().copied());
        let shown = lines.skip(1).take_while(|(frequency, _)| *frequency <= end);
        // Points below the visible range are clipped slightly below it, so that the line continues to the edge.
        let points = shown.map(|(frequency, amplitude)| {
            (rate.place(frequency), size.place(amplitude.max(0.1 * floor)))
        });
        Polyline::new(role, points.collect::<Vec<_>>())
    };
    let symbol = if study.scales().is_some() { "f" } else { "ω/ω_0" };
    let mut vertical = size.axis("spectral amplitude", "|x|").log();
    if top > 0.0 {
        vertical = vertical.between(size.place(floor), size.place(2.0 * top));
    }
    let panel = Panel::new(rate.axis("frequency", symbol).between(0.0, rate.place(end)), vertical)
        .with(ReferenceLine::vertical(rate.place(BAND_END)).label("band of $E$"));
    both(panel, study, |role, dithered| curve(if dithered { with } else { without }, role))
}
