//! The displacement between two times of a run.

use quell_model::units::Quantity;

use super::caption::caption;
use super::ruler::Ruler;
use crate::plot::{Figure, Panel, PlotPoint, PlotRole, Polyline};
use crate::run::window::WindowedResponse;
use crate::study::SystemStudy;

/// The displacement over time.
pub(crate) fn window(study: &SystemStudy, found: &WindowedResponse) -> Figure {
    let (times, displacement) = found.samples();
    let time = Ruler::new(study, Quantity::Time, times.iter().copied());
    let place = Ruler::new(study, Quantity::Displacement, displacement.iter().copied());
    let points = times.iter().zip(displacement);
    let points = points.map(|(at, value)| PlotPoint::new(time.place(*at), place.place(*value)));
    let line = Polyline::new(PlotRole::Exact, points.collect::<Vec<_>>());
    let panel = Panel::new(time.axis("time", "t"), place.axis("observed displacement", ""));
    Figure::single(panel.with(line))
        .caption(caption(study))
        .title(study.title().unwrap_or_default())
}
