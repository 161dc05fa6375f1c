//! The cost of quenching over the duty cycle of bursts, with the continuous waveforms.

use quell_numerics::order::ascending_by;

use super::caption::caption;
use super::ruler::Ruler;
use crate::plot::{
    Figure, Marker, Panel, PlotAxis, PlotPoint, PlotRole, Points, Polyline, SharedLegend,
};
use crate::run::waveforms::{COLUMNS, CostColumn, RankedBy, WaveformComparison};
use crate::study::SystemStudy;

/// A waveform as a picture shows it.
struct CostMark {
    label: String,
    /// Whether it is the carrier or a burst of it.
    of_carrier: bool,
    duty_cycle: f64,
    /// At the amplitude that ranks the waveform.
    value: Option<f64>,
    /// By averaging, where exact amplitudes rank.
    averaged: Option<f64>,
}

/// What one panel shows.
struct CostPanel<'a> {
    words: &'static str,
    ruler: Ruler,
    carrier: &'a str,
    marks: Vec<CostMark>,
    /// Whether the values of bursts depend on the duty cycle alone, so that a line may join them.
    joined: bool,
}

/// One panel for amplitude, rms force, power and stroke.
pub fn waveforms(study: &SystemStudy, done: &WaveformComparison) -> Figure {
    let ruler =
        |column: &CostColumn, marks: &[CostMark]| Ruler::new(study, column.quantity, shown(marks));
    figure(done, ruler, study.system().one_mass().is_some())
        .title(study.title().unwrap_or_default())
        .caption(format!("{}; {}", caption(study), shown_in_words(done)))
}

/// The panels; `is_mass` of a mass, whose response to bursts depends on the duty cycle alone.
fn figure(
    done: &WaveformComparison,
    ruler: impl Fn(&CostColumn, &[CostMark]) -> Ruler,
    is_mass: bool,
) -> Figure {
    let is_exact = done.ranked_by() == RankedBy::Exact;
    let panels = COLUMNS[..4].iter().enumerate().map(|(place, column)| {
        let marks = done.rows.iter().map(|row| CostMark {
            label: row.label(),
            of_carrier: row.waveform.name() == done.carrier || row.duty_cycle < 1.0,
            duty_cycle: row.duty_cycle,
            value: done.ranked(row, column),
            averaged: row.averaged_value(column).ok().filter(|_| is_exact && place == 0),
        });
        let marks: Vec<CostMark> = marks.collect();
        // The stroke depends on the length of a burst too, and so do exact amplitudes.
        let joined = is_mass && place < 3 && !is_exact;
        let (words, carrier) = (column.words, done.carrier);
        panel(&CostPanel { words, ruler: ruler(column, &marks), carrier, marks, joined })
    });
    Figure::grid(2, panels).legend(SharedLegend::Below)
}

/// What the picture shows, in a caption.
fn shown_in_words(done: &WaveformComparison) -> &'static str {
    match done.ranked_by() {
        RankedBy::Exact => {
            "exact least dither that quenches, over the share of time in which bursts act."
        }
        RankedBy::Averaging => {
            "least dither that quenches by averaging, over the share of time in which bursts act."
        }
    }
}

fn shown(marks: &[CostMark]) -> impl Iterator<Item = f64> {
    marks.iter().flat_map(|mark| [mark.value, mark.averaged]).flatten()
}

fn panel(panel: &CostPanel<'_>) -> Panel {
    let CostPanel { words, ruler, carrier, marks, joined } = panel;
    let largest = shown(marks).fold(0.0, f64::max);
    // Bursts of the carrier, and the carrier itself, which acts all the time.
    let over_duty = |of: fn(&CostMark) -> Option<f64>| {
        let own = marks.iter().filter(|mark| mark.of_carrier);
        let mut points: Vec<PlotPoint> = own
            .filter_map(|mark| Some(PlotPoint::new(mark.duty_cycle, ruler.place(of(mark)?))))
            .collect();
        ascending_by(&mut points, |a| a.x);
        points
    };
    let bursts = over_duty(|mark| mark.value);
    let top = if largest > 0.0 { 1.1 * ruler.place(largest) } else { 1.0 };
    let mut panel = Panel::new(
        PlotAxis::new("duty cycle").between(0.0, 1.08),
        ruler.axis(words, "").between(0.0, top),
    )
    .with(
        Points::new(if *joined { PlotRole::Averaged } else { PlotRole::Exact }, bursts.clone())
            .size(5.0)
            .label(format!("bursts of a {carrier}")),
    );
    if *joined {
        panel = panel.with(Polyline::new(PlotRole::Averaged, bursts));
    }
    // Distinct in grey too.
    let markers = [(Marker::Circle, 7.0), (Marker::Disc, 7.0), (Marker::Circle, 11.0)];
    for (number, mark) in marks.iter().filter(|mark| !mark.of_carrier).enumerate() {
        let Some(value) = mark.value else { continue };
        let (marker, size) = markers[number % markers.len()];
        let points = Points::new(PlotRole::Printed, [PlotPoint::new(1.0, ruler.place(value))])
            .marker(marker);
        panel = panel.with(points.size(size).label(mark.label.clone()));
    }
    let averaged = over_duty(|mark| mark.averaged);
    if !averaged.is_empty() {
        let points = Points::new(PlotRole::Averaged, averaged).marker(Marker::Cross).size(8.0);
        panel = panel.with(points.label("by averaging"));
    }
    panel
}
