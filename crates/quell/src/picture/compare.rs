//! Measured and computed spectra, before and after the dither.

use super::caption::caption_of;
use super::ruler::Ruler;
use crate::plot::{Figure, Panel, PlotAxis, PlotPoint, PlotRole, Polyline, SharedLegend, Sharing};
use crate::run::compare::{ComparedRecord, ComparedSpectrum, Comparison};
use crate::study::Study;

/// Decibels that are shown below the largest line.
const SHOWN: f64 = 100.0;

/// One panel for each record.
pub fn compare(study: &Study, done: &Comparison) -> Figure {
    let records: Vec<&ComparedRecord> = std::iter::once(&done.before).chain(&done.after).collect();
    let top = records
        .iter()
        .flat_map(|record| [&record.measured, &record.computed])
        .flat_map(ComparedSpectrum::lines)
        .map(|(_, amplitude)| amplitude)
        .fold(f64::MIN_POSITIVE, f64::max);
    let panels: Vec<Panel> = records.iter().map(|record| panel(record, top)).collect();
    Figure::grid(1, panels)
        .sharing_x(Sharing::All)
        .legend(SharedLegend::Above)
        .title(study.picture_title().unwrap_or_default())
        .caption(format!(
            "{} Measured and computed spectra of the {} under a Hann window{}.",
            caption_of(study),
            done.before.quantity.name(),
            if done.after.is_some() { ", before and after the dither" } else { "" }
        ))
}

fn panel(record: &ComparedRecord, top: f64) -> Panel {
    let ruler = Ruler::of_unit(record.frequency_unit.unwrap_or(""), record.highest);
    let level = |amplitude: f64| 20.0 * libm::log10(amplitude / top);
    let name = match (record.dithered, record.quantity.name()) {
        (true, name) => format!("{name}, with dither"),
        (false, name) => format!("{name}, without dither"),
    };
    let curve = |spectrum: &ComparedSpectrum, role| {
        // Points below the visible range are clipped slightly below it, so that the line continues to the edge.
        let points = spectrum.lines().into_iter().skip(1).map(|(frequency, amplitude)| {
            PlotPoint::new(ruler.place(frequency), level(amplitude).max(-1.1 * SHOWN))
        });
        Polyline::new(role, points.collect::<Vec<_>>())
    };
    Panel::new(
        ruler.axis("frequency", "f").between(0.0, ruler.place(record.highest)),
        PlotAxis::new("level").unit("dB").between(-SHOWN, 5.0),
    )
    .title(name)
    .with(curve(&record.measured, PlotRole::Undecided).label("measured"))
    .with(curve(&record.computed, PlotRole::Dithered).label("computed"))
}
