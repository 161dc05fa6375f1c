//! A record with the curve that is fitted to it, and the residuals.

use super::caption::caption_of;
use super::ruler::Ruler;
use crate::plot::{
    Figure, Marker, Panel, PlotAxis, PlotPoint, PlotRole, Points, Polyline, ReferenceLine, Region,
    SharedLegend, Sharing,
};
use crate::run::decay::FreeDecay;
use crate::run::record_fit::RecordFit;
use quell_input::record::TimeSeries;

/// Samples that are drawn as points; more of them are a line.
const POINTS: usize = 400;

/// A fitted curve at the samples of a record.
pub(super) struct FittedRecord<'a> {
    pub(super) record: &'a TimeSeries,
    /// The curve.
    pub(super) fitted: &'a [f64],
    /// Half of the width of its confidence band.
    pub(super) band: Option<Vec<f64>>,
    pub(super) label: &'a str,
}

/// Two panels over time: readings with the curve, and residuals.
pub(super) fn figure(shown: &FittedRecord<'_>) -> Figure {
    let record = shown.record;
    let largest = |values: &[f64]| values.iter().map(|value| value.abs()).fold(0.0, f64::max);
    let time = Ruler::of_unit(record.time_unit.unwrap_or(""), largest(&record.times));
    let place = Ruler::of_unit(record.unit.unwrap_or(""), largest(&record.values));
    let residuals: Vec<f64> = record.values.iter().zip(shown.fitted).map(|(y, f)| y - f).collect();
    let small = Ruler::of_unit(record.unit.unwrap_or(""), largest(&residuals));
    let line = |values: &[f64], ruler: &Ruler| -> Vec<PlotPoint> {
        record
            .times
            .iter()
            .zip(values)
            .map(|(t, value)| PlotPoint::new(time.place(*t), ruler.place(*value)))
            .collect()
    };
    let name = record.quantity.name();
    let mut upper = Panel::new(time.axis("time", "t"), place.axis(name, ""));
    if let Some(band) = &shown.band {
        let side = |sign: f64| -> Vec<f64> {
            shown.fitted.iter().zip(band).map(|(f, half)| f + sign * half).collect()
        };
        let region =
            Region::between(PlotRole::Stable, line(&side(-1.0), &place), line(&side(1.0), &place));
        upper = upper.with(region.label("95 % confidence"));
    }
    upper = measured(upper, &line(&record.values, &place), "measured");
    upper = upper
        .with(Polyline::new(PlotRole::Dithered, line(shown.fitted, &place)).label(shown.label));
    let lower =
        Panel::new(time.axis("time", "t"), small_axis(&small)).with(ReferenceLine::horizontal(0.0));
    let lower = measured(lower, &line(&residuals, &small), "");
    Figure::grid(1, [upper, lower]).sharing_x(Sharing::All).legend(SharedLegend::Below)
}

fn small_axis(ruler: &Ruler) -> PlotAxis {
    ruler.axis("residual", "")
}

/// Few samples as circles, many as a grey line.
fn measured(panel: Panel, points: &[PlotPoint], label: &str) -> Panel {
    if points.len() <= POINTS {
        let circles = Points::new(PlotRole::Printed, points.to_vec());
        return panel.with(circles.marker(Marker::Circle).size(3.5).label(label));
    }
    panel.with(Polyline::new(PlotRole::Undecided, points.to_vec()).label(label))
}

/// The picture of a free decay.
pub fn decay(done: &FreeDecay) -> Figure {
    let best = done.best();
    let t = quell_design::fit::student_quantile(
        crate::run::fit::CONFIDENCE,
        best.estimates.count.saturating_sub(best.estimates.free).max(1),
    );
    let band = best.deviations.iter().map(|deviation| t * deviation).collect();
    let label = format!("fit: {}", best.law.name());
    figure(&FittedRecord {
        record: &done.record,
        fitted: &best.values,
        band: Some(band),
        label: &label,
    })
    .caption(format!(
        "A free decay with the exact motion under {}, its 95 % confidence band, and the residuals.",
        match best.law {
            quell_design::decay::DecayLaw::Viscous => "viscous damping",
            quell_design::decay::DecayLaw::Coulomb => "Coulomb friction",
            quell_design::decay::DecayLaw::ViscousCoulomb => "viscous damping and Coulomb friction",
        }
    ))
}

/// The picture of a study fitted to a record.
pub fn record_fit(done: &RecordFit) -> Figure {
    figure(&FittedRecord { record: &done.record, fitted: &done.values, band: None, label: "fit" })
        .title(done.study.picture_title().unwrap_or_default())
        .caption(format!(
            "{} A measured record with the exact motion fitted to it, and the residuals.",
            caption_of(&done.fitted_study)
        ))
}
