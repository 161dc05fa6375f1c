//! Convergence of Lyapunov exponents: their means over the time up to which they are averaged.

use crate::plot::{Figure, Legend, Panel, PlotAxis, PlotPoint, PlotRole, Polyline, ReferenceLine};
use crate::run::exponents::MeasuredExponents;

/// Units of time and of rates, each with its value in a unit of the equations.
#[derive(Clone, Copy, Debug)]
pub struct ExponentUnits<'a> {
    /// Of the time.
    pub time: (Option<&'a str>, f64),
    /// Of the exponents.
    pub rate: (Option<&'a str>, f64),
}

/// The picture of the exponents.
pub fn exponents(
    title: Option<&str>,
    found: &MeasuredExponents,
    units: &ExponentUnits<'_>,
    caption: String,
) -> Figure {
    let with_unit = |axis: PlotAxis, unit: Option<&str>| match unit {
        Some(unit) => axis.unit(unit),
        None => axis,
    };
    let across = with_unit(PlotAxis::new("time of the record"), units.time.0);
    let up = with_unit(PlotAxis::new("mean rate of growth").symbol("λ"), units.rate.0);
    let mut panel = Panel::new(across, up).with(ReferenceLine::horizontal(0.0));
    let known = found.found.means.iter().enumerate().filter(|(_, means)| !means.is_empty());
    for (index, means) in known {
        let points = found.times().zip(means);
        let points: Vec<PlotPoint> = points
            .map(|(time, mean)| PlotPoint::new(units.time.1 * time, units.rate.1 * mean))
            .collect();
        let line = Polyline::pieces(PlotRole::Exact, vec![points]);
        panel = panel.with(line.label(format!("exponent {}", index + 1)));
    }
    Figure::single(panel.legend(Legend::Above)).title(title.unwrap_or_default()).caption(caption)
}
