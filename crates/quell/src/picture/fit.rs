//! Measured friction with the fitted laws, the confidence band of the best one, and its residuals.

use super::ruler::Ruler;
use crate::plot::{
    Figure, Marker, Panel, PlotAxis, PlotPoint, PlotRole, Points, Polyline, ReferenceLine, Region,
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
    let ruler = Ruler::of_unit(done.data.velocity_unit().unwrap_or_default(), largest);
    let axis = || ruler.axis("slip speed", "|v_r|");
    let curve = done.curve(best, CURVE);
    let line = |values: &[f64]| -> Vec<PlotPoint> {
        curve
            .speeds
            .iter()
            .zip(values)
            .map(|(v, value)| PlotPoint::new(ruler.place(*v), *value))
            .collect()
    };
    let friction = match done.force_unit() {
        _ if done.friction_is() == "coefficient" => {
            PlotAxis::new("friction coefficient").symbol("μ")
        }
        None => PlotAxis::new(format!("friction {}", done.friction_is())),
        Some(unit) => PlotAxis::new(format!("friction {}", done.friction_is())).unit(unit),
    };
    let mut upper = Panel::new(axis(), friction).with(
        Region::between(PlotRole::Stable, line(&curve.low), line(&curve.high))
            .label("95 % confidence"),
    );
    for (place, fit) in done.fits.iter().enumerate() {
        let values: Vec<f64> = curve.speeds.iter().map(|v| fit.coefficient(*v)).collect();
        upper = upper.with(Polyline::new(PlotRole::Series(place), line(&values)).label(fit.name()));
    }
    let measured = done
        .points
        .iter()
        .map(|point| PlotPoint::new(ruler.place(point.speed()), point.coefficient));
    upper = upper.with(
        Points::new(PlotRole::Printed, measured).marker(Marker::Circle).size(5.0).label("measured"),
    );
    let residuals = done
        .points
        .iter()
        .zip(&best.residuals)
        .map(|(point, residual)| PlotPoint::new(ruler.place(point.speed()), *residual));
    let residual = match done.force_unit() {
        _ if done.friction_is() == "coefficient" => PlotAxis::new("residual").symbol("μ − μ_{fit}"),
        None => PlotAxis::new("residual"),
        Some(unit) => PlotAxis::new("residual").unit(unit),
    };
    let lower = Panel::new(axis(), residual)
        .with(ReferenceLine::horizontal(0.0))
        .with(Points::new(PlotRole::Printed, residuals).marker(Marker::Circle).size(5.0));
    Figure::grid(1, [upper, lower]).sharing_x(Sharing::All).legend(SharedLegend::Below).caption(
        format!(
            "Measured friction, the law {} with its 95 % confidence band, and its residuals.",
            best.name()
        ),
    )
}
