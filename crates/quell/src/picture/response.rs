//! The end of the record and the spectra, with and without dither.

use quell_dynamics::response::SettledRecord;
use quell_model::units::Quantity;
use quell_numerics::interval::RealInterval;

use super::caption::caption;
use super::ruler::{Ruler, time_between};
use super::system::frequency_axis;
use crate::plot::{Figure, Panel, PlotPoint, PlotRole, Polyline, ReferenceLine, SharedLegend};
use crate::run::response::MeasuredResponse;
use crate::run::system::start::start_in_words;
use crate::study::SystemStudy;
use crate::words::capital;

/// Number of periods of the strongest slow line of the record that are shown.
const PERIODS_SHOWN: f64 = 8.0;

/// Number of decades of the spectrum that are shown below its largest line.
const DECADES: i32 = 5;

/// The picture of a steady response: the end of the record and the spectrum, with and without dither.
pub fn response(study: &SystemStudy, done: &MeasuredResponse) -> Figure {
    let (with, without) = (&done.response.dithered, &done.response.undithered);
    let dithered = done.response.has_dither();
    let start = start_in_words(study, &Vec::new());
    Figure::grid(
        1,
        [record(study, done, dithered), spectra(study, [with, without], dithered, done)],
    )
    .legend(if dithered { SharedLegend::Above } else { SharedLegend::default() })
    .title(study.title().unwrap_or_default())
    .caption(format!("{} {}.", caption(study), capital(&start)))
}

/// The records with and without dither, or one of them.
fn both(panel: Panel, dithered: bool, curves: [Vec<PlotPoint>; 2]) -> Panel {
    let [with, without] = curves;
    if !dithered {
        return panel.with(Polyline::new(PlotRole::Exact, without));
    }
    panel
        .with(Polyline::new(PlotRole::Undithered, without).label("without dither"))
        .with(Polyline::new(PlotRole::Dithered, with).label("with dither"))
}

fn record(study: &SystemStudy, done: &MeasuredResponse, dithered: bool) -> Panel {
    let (with, without) = (&done.response.dithered, &done.response.undithered);
    let lines = without.spectrum.frequencies().zip(without.spectrum.amplitudes()).skip(1);
    let low = lines.take_while(|(frequency, _)| *frequency <= done.response.band_end);
    let strongest = low.max_by(|a, b| a.1.total_cmp(b.1)).map_or(0.0, |(frequency, _)| frequency);
    let shown = PERIODS_SHOWN * std::f64::consts::TAU / strongest;
    let end = done.plan.settle + done.plan.length;
    let first = (end - shown.min(done.plan.length)).max(done.plan.settle);
    let (time, clock) = time_between(study, RealInterval::new(first, end));
    let values = [with, without].map(|record| record.samples.iter().copied());
    let x = Ruler::new(study, Quantity::Displacement, values.into_iter().flatten());
    let points = |record: &SettledRecord| -> Vec<PlotPoint> {
        let samples = record.samples.iter().enumerate();
        let times = samples
            .map(|(number, value)| (f64::mul_add(number as f64, record.step, record.from), *value));
        let shown = times.filter(|(time, _)| *time >= first);
        shown.map(|(time, value)| PlotPoint::new(clock.place(time), x.place(value))).collect()
    };
    let panel = Panel::new(time, x.axis("observed displacement", ""));
    both(panel, dithered, [points(with), points(without)])
}

fn spectra(
    study: &SystemStudy,
    records: [&SettledRecord; 2],
    dithered: bool,
    done: &MeasuredResponse,
) -> Panel {
    let (across, factor) = frequency_axis(study, "ω");
    let largest =
        |record: &SettledRecord| record.spectrum.amplitudes().iter().copied().fold(0.0, f64::max);
    let top = largest(records[0]).max(largest(records[1]));
    let floor = top * 10f64.powi(-DECADES);
    let size = Ruler::new(study, Quantity::Displacement, [top]);
    let end = 1.3 * fastest_line(records, floor);
    let points = records.map(|record| -> Vec<PlotPoint> {
        let lines = record.spectrum.frequencies().zip(record.spectrum.amplitudes());
        let shown = lines.skip(1).take_while(|(frequency, _)| *frequency <= end);
        shown
            .map(|(frequency, amplitude)| {
                PlotPoint::new(factor * frequency, size.place(amplitude.max(0.1 * floor)))
            })
            .collect()
    });
    let mut up = size.axis("spectral amplitude", "").log();
    if top > 0.0 {
        up = up.between(size.place(floor), size.place(2.0 * top));
    }
    let mut panel = Panel::new(across.between(0.0, factor * end), up);
    if dithered {
        let band = factor * done.response.band_end;
        panel = panel.with(ReferenceLine::vertical(band).label("band of $E$"));
    }
    both(panel, dithered, points)
}

/// The highest frequency of a line above a hundred times the floor.
fn fastest_line(records: [&SettledRecord; 2], floor: f64) -> f64 {
    let highest = |record: &SettledRecord| {
        let lines = record.spectrum.frequencies().zip(record.spectrum.amplitudes()).skip(1);
        let high = lines.filter(|(_, amplitude)| **amplitude > 100.0 * floor);
        high.map(|(frequency, _)| frequency).last()
    };
    let all = records.map(highest).into_iter().flatten().fold(0.0, f64::max);
    let last = records[0].spectrum.frequencies().last().unwrap_or(1.0);
    if all > 0.0 { all } else { last }
}
