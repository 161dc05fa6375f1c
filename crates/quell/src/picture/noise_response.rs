//! The residual vibration of runs under noise, in ascending order.

use quell_numerics::order::ascending;

use super::caption::caption;
use crate::plot::{Figure, Panel, PlotAxis, PlotPoint, PlotRole, Polyline, ReferenceLine};
use crate::run::noise_response::{NoiseResponse, QUIET};
use crate::study::SystemStudy;

/// E of the runs against the share of runs that do not exceed it.
pub(crate) fn figure(study: &SystemStudy, done: &NoiseResponse) -> Figure {
    let mut each = done.residual_vibrations().unwrap_or_default();
    ascending(&mut each);
    let count = each.len().max(1) as f64;
    let mut points = vec![PlotPoint::new(0.0, 0.0)];
    for (place, residual_vibration) in each.iter().enumerate() {
        points.extend([
            PlotPoint::new(*residual_vibration, place as f64 / count),
            PlotPoint::new(*residual_vibration, (place + 1) as f64 / count),
        ]);
    }
    let vertical = PlotAxis::new("share of runs").between(0.0, 1.0);
    let panel = Panel::new(PlotAxis::new("residual vibration").symbol("E"), vertical)
        .with(Polyline::new(PlotRole::Exact, points))
        .with(ReferenceLine::vertical(QUIET).label("quiet"));
    Figure::single(panel).caption(caption(study)).title(study.title().unwrap_or_default())
}
