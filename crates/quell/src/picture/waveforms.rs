//! The cost of quenching over the duty cycle of bursts, with the continuous waveforms.

use super::caption::{caption, caption_of_system};
use super::ruler::Ruler;
use crate::plot::{Figure, Marker, Panel, PlotAxis, PlotRole, Points, Polyline, SharedLegend};
use crate::run::system::waveforms::{COLUMNS as SYSTEM_COLUMNS, SystemWaveforms};
use crate::run::waveforms::{COLUMNS, WaveformComparison};
use crate::study::{BeltStudy, SystemStudy};

/// A waveform as a picture shows it.
struct CostMark {
    label: String,
    /// Whether it is the carrier or a burst of it.
    of_carrier: bool,
    duty_cycle: f64,
    value: Option<f64>,
    exact: Option<f64>,
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
pub fn waveforms(study: &BeltStudy, done: &WaveformComparison) -> Figure {
    let panels = COLUMNS[..4].iter().enumerate().map(|(place, column)| {
        let marks: Vec<CostMark> = done
            .rows
            .iter()
            .map(|row| CostMark {
                label: row.label(),
                of_carrier: row.waveform.name() == done.carrier || row.duty_cycle < 1.0,
                duty_cycle: row.duty_cycle,
                value: row.value(column).ok(),
                exact: row.exact.as_ref().ok().copied().filter(|_| place == 0),
            })
            .collect();
        let ruler = Ruler::of(study, column.quantity, shown(&marks));
        let (words, carrier) = (column.words, done.carrier);
        // The stroke depends on the length of a burst too.
        panel(&CostPanel { words, ruler, carrier, marks, joined: place < 3 })
    });
    Figure::grid(2, panels)
        .legend(SharedLegend::Below)
        .title(study.title().unwrap_or_default())
        .caption(format!("{}; {SHOWN}", caption(study)))
}

/// The same for a system, whose structure responds differently to each length of a burst.
pub fn waveforms_of_system(study: &SystemStudy, done: &SystemWaveforms) -> Figure {
    let panels = SYSTEM_COLUMNS[..4].iter().map(|column| {
        let marks: Vec<CostMark> = done
            .rows
            .iter()
            .map(|row| CostMark {
                label: row.label(),
                of_carrier: row.waveform.name() == done.carrier || row.duty_cycle < 1.0,
                duty_cycle: row.duty_cycle,
                value: row.value(column).ok(),
                exact: None,
            })
            .collect();
        let ruler = Ruler::of_system(study, column.2, shown(&marks));
        panel(&CostPanel { words: column.1, ruler, carrier: done.carrier, marks, joined: false })
    });
    Figure::grid(2, panels)
        .legend(SharedLegend::Below)
        .title(study.title().unwrap_or_default())
        .caption(format!("{}; {SHOWN}", caption_of_system(study)))
}

/// What the picture shows, in a caption.
const SHOWN: &str =
    "least dither that quenches by averaging, over the share of time in which bursts act.";

fn shown(marks: &[CostMark]) -> impl Iterator<Item = f64> {
    marks.iter().flat_map(|mark| [mark.value, mark.exact]).flatten()
}

fn panel(panel: &CostPanel<'_>) -> Panel {
    let CostPanel { words, ruler, carrier, marks, joined } = panel;
    let largest = shown(marks).fold(0.0, f64::max);
    // Bursts of the carrier, and the carrier itself, which acts all the time.
    let over_duty = |of: fn(&CostMark) -> Option<f64>| {
        let own = marks.iter().filter(|mark| mark.of_carrier);
        let mut points: Vec<(f64, f64)> =
            own.filter_map(|mark| Some((mark.duty_cycle, ruler.place(of(mark)?)))).collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        points
    };
    let bursts = over_duty(|mark| mark.value);
    let top = if largest > 0.0 { 1.1 * ruler.place(largest) } else { 1.0 };
    let mut panel = Panel::new(
        PlotAxis::new("duty cycle").between(0.0, 1.08),
        ruler.axis(words, "").between(0.0, top),
    )
    .with(
        Points::new(PlotRole::Averaged, bursts.clone())
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
        let points = Points::new(PlotRole::Printed, [(1.0, ruler.place(value))]).marker(marker);
        panel = panel.with(points.size(size).label(mark.label.clone()));
    }
    let exact = over_duty(|mark| mark.exact);
    if !exact.is_empty() {
        let points = Points::new(PlotRole::Exact, exact).marker(Marker::Cross).size(8.0);
        panel = panel.with(points.label("exact, at the study's frequency"));
    }
    panel
}
