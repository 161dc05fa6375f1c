//! The displacement between two times of a run.

use quell_model::units::Quantity;

use super::caption::{caption_of_run, caption_of_system};
use super::ruler::{Ruler, time_axis};
use crate::plot::{Figure, Panel, PlotRole, Polyline};
use crate::run::window::WindowedResponse;
use crate::study::{BeltStudy, SystemStudy};

/// Of a belt.
pub(crate) fn of_belt(study: &BeltStudy, found: &WindowedResponse) -> Figure {
    let (times, displacement) = found.samples();
    let time = Ruler::of(study, Quantity::Time, times.iter().copied());
    let place = Ruler::of(study, Quantity::Displacement, displacement.iter().copied());
    let axes = (time_axis(study, &time), place.axis("displacement", "x"));
    figure((times, displacement), axes, (&time, &place))
        .caption(caption_of_run(study))
        .title(study.title().unwrap_or_default())
}

/// Of a system.
pub(crate) fn of_system(study: &SystemStudy, found: &WindowedResponse) -> Figure {
    let (times, displacement) = found.samples();
    let time = Ruler::of_system(study, Quantity::Time, times.iter().copied());
    let place = Ruler::of_system(study, Quantity::Displacement, displacement.iter().copied());
    let axes = (time.axis("time", "t"), place.axis("observed displacement", ""));
    figure((times, displacement), axes, (&time, &place))
        .caption(caption_of_system(study))
        .title(study.title().unwrap_or_default())
}

fn figure(
    (times, displacement): (Vec<f64>, &[f64]),
    (horizontal, vertical): (crate::plot::PlotAxis, crate::plot::PlotAxis),
    (time, place): (&Ruler, &Ruler),
) -> Figure {
    let points = times.into_iter().zip(displacement);
    let points = points.map(|(at, value)| (time.place(at), place.place(*value)));
    let line = Polyline::new(PlotRole::Exact, points.collect::<Vec<_>>());
    Figure::single(Panel::new(horizontal, vertical).with(line))
}
