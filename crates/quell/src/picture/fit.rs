//! Measured friction with the fitted laws, the confidence band of the best one, and its residuals.

use super::ruler::Ruler;
use crate::plot::{
    Figure, Marker, Panel, PlotAxis, PlotRole, Points, Polyline, ReferenceLine, Region,
    SharedLegend, Sharing,
};
use crate::run::fit::FrictionFit;
use quell_design::fit::FitPoint;

/// Number of slip speeds of a curve.
const CURVE: usize = 201;

/// Two panels over the slip speed: coefficients and residuals.
pub fn fit(done: &FrictionFit) -> Figure {
    let best = done.best();
    let largest = done.points.iter().map(FitPoint::speed).fold(0.0, f64::max);
    let ruler = Ruler::of_unit(if done.data.is_si() { "m/s" } else { "" }, largest);
    let axis = || ruler.axis("slip speed", "|v_r|");
    let curve = done.curve(best, CURVE);
    let line = |values: &[f64]| -> Vec<(f64, f64)> {
        curve.speeds.iter().zip(values).map(|(v, value)| (ruler.place(*v), *value)).collect()
    };
    let mut upper = Panel::new(axis(), PlotAxis::new("friction coefficient").symbol("μ")).with(
        Region::between(PlotRole::Stable, line(&curve.low), line(&curve.high))
            .label("95 % confidence"),
    );
    for (place, fit) in done.fits.iter().enumerate() {
        let values: Vec<f64> = curve.speeds.iter().map(|v| fit.coefficient(*v)).collect();
        upper = upper.with(Polyline::new(PlotRole::Series(place), line(&values)).label(fit.name()));
    }
    let measured = done.points.iter().map(|point| (ruler.place(point.speed()), point.coefficient));
    upper = upper.with(
        Points::new(PlotRole::Printed, measured).marker(Marker::Circle).size(5.0).label("measured"),
    );
    let residuals = done
        .points
        .iter()
        .zip(&best.residuals)
        .map(|(point, residual)| (ruler.place(point.speed()), *residual));
    let lower = Panel::new(axis(), PlotAxis::new("residual").symbol("μ − μ_{fit}"))
        .with(ReferenceLine::horizontal(0.0))
        .with(Points::new(PlotRole::Printed, residuals).marker(Marker::Circle).size(5.0));
    Figure::grid(1, [upper, lower]).sharing_x(Sharing::All).legend(SharedLegend::Below).caption(
        format!(
            "Measured friction, the law {} with its 95 % confidence band, and its residuals.",
            best.name()
        ),
    )
}
