//! The residual vibration of runs under noise, in ascending order.

use quell_model::units::Quantity;

use super::caption::caption_of_run;
use super::ruler::Ruler;
use crate::plot::{Figure, Panel, PlotAxis, PlotRole, Polyline, ReferenceLine};
use crate::run::noise_response::{NoiseResponse, QUIET};
use crate::study::BeltStudy;

/// E of the runs against the share of runs that do not exceed it.
pub fn noise_response(study: &BeltStudy, done: &NoiseResponse) -> Figure {
    let mut each = done.efficiencies().unwrap_or_default();
    each.sort_by(f64::total_cmp);
    let ruler = Ruler::of(study, Quantity::Ratio, each.iter().copied().chain([QUIET]));
    let count = each.len().max(1) as f64;
    let mut points = vec![(0.0, 0.0)];
    for (place, efficiency) in each.iter().enumerate() {
        let at = ruler.place(*efficiency);
        points.extend([(at, place as f64 / count), (at, (place + 1) as f64 / count)]);
    }
    let horizontal = ruler.axis("residual vibration", "E");
    let vertical = PlotAxis::new("share of runs").between(0.0, 1.0);
    let panel = Panel::new(horizontal, vertical)
        .with(Polyline::new(PlotRole::Exact, points))
        .with(ReferenceLine::vertical(ruler.place(QUIET)).label("quiet"));
    Figure::single(panel).caption(caption_of_run(study)).title(study.title().unwrap_or_default())
}
