//! The cost of quenching over the duty cycle of bursts, with the continuous waveforms.

use super::caption::caption;
use super::ruler::Ruler;
use crate::plot::{Figure, Marker, Panel, PlotAxis, PlotRole, Points, Polyline, SharedLegend};
use crate::run::waveforms::{COLUMNS, CostColumn, WaveformComparison};
use crate::study::BeltStudy;

/// One panel for amplitude, rms force, power and stroke.
pub fn waveforms(study: &BeltStudy, done: &WaveformComparison) -> Figure {
    let shown = &COLUMNS[..4];
    let panels = shown.iter().enumerate().map(|(place, column)| panel(study, done, place, column));
    Figure::grid(2, panels)
        .legend(SharedLegend::Below)
        .title(study.title().unwrap_or_default())
        .caption(format!(
            "{}; least dither that quenches by averaging, over the share of time in which bursts act.",
            caption(study)
        ))
}

fn panel(study: &BeltStudy, done: &WaveformComparison, place: usize, column: &CostColumn) -> Panel {
    let values = done.rows.iter().filter_map(|row| row.value(column).ok());
    let exact = done.rows.iter().filter_map(|row| row.exact.as_ref().ok().copied());
    let largest = values.chain(exact.filter(|_| place == 0)).fold(0.0, f64::max);
    let ruler = Ruler::new(study, column.quantity, largest);
    let carrier = done.carrier;
    // Bursts of the carrier, and the carrier itself, which acts all the time.
    let mut bursts: Vec<(f64, f64)> = done
        .rows
        .iter()
        .filter(|row| row.waveform.name() == carrier || row.duty_cycle < 1.0)
        .filter_map(|row| Some((row.duty_cycle, ruler.place(row.value(column).ok()?))))
        .collect();
    bursts.sort_by(|a, b| a.0.total_cmp(&b.0));
    let top = if largest > 0.0 { 1.1 * ruler.place(largest) } else { 1.0 };
    let mut panel = Panel::new(
        PlotAxis::new("duty cycle").between(0.0, 1.08),
        ruler.axis(column.words, "").between(0.0, top),
    )
    .with(
        Points::new(PlotRole::Averaged, bursts.clone())
            .size(5.0)
            .label(format!("bursts of a {carrier}")),
    );
    // The stroke depends on the length of a burst too.
    if place < 3 {
        panel = panel.with(Polyline::new(PlotRole::Averaged, bursts));
    }
    // Distinct in grey too.
    let markers = [(Marker::Circle, 7.0), (Marker::Disc, 7.0), (Marker::Circle, 11.0)];
    let others = done.rows.iter().filter(|row| row.duty_cycle == 1.0);
    for (number, row) in others.filter(|row| row.waveform.name() != carrier).enumerate() {
        let Ok(value) = row.value(column) else { continue };
        let (marker, size) = markers[number % markers.len()];
        let points = Points::new(PlotRole::Printed, [(1.0, ruler.place(value))]).marker(marker);
        panel = panel.with(points.size(size).label(row.label()));
    }
    if place == 0 {
        let exact: Vec<(f64, f64)> = done
            .rows
            .iter()
            .filter(|row| row.waveform.name() == carrier || row.duty_cycle < 1.0)
            .filter_map(|row| Some((row.duty_cycle, ruler.place(*row.exact.as_ref().ok()?))))
            .collect();
        let points = Points::new(PlotRole::Exact, exact).marker(Marker::Cross).size(8.0);
        panel = panel.with(points.label("exact, at the study's frequency"));
    }
    panel
}
