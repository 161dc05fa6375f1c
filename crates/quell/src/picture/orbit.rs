//! A periodic response in the phase plane, and its multipliers with the unit circle.

use std::f64::consts::TAU;

use quell_dynamics::orbit::Orbit;
use quell_model::units::Quantity;

use super::caption::caption;
use super::ruler::Ruler;
use crate::complaint::Failure;
use crate::plot::{
    Figure, Marker, Panel, PlotAxis, PlotRole, Points, Polyline, ReferenceLine, Size,
};
use crate::run::orbit::{PeriodicResponse, samples, sentence};
use crate::study::BeltStudy;

/// Number of points of the unit circle.
const CIRCLE: u32 = 180;

/// The picture of the periodic response that `orbit` found.
///
/// # Errors
/// [`Failure::Failed`] if no periodic response was found.
pub fn response(study: &BeltStudy, found: &PeriodicResponse) -> Result<Figure, Failure> {
    let why = || Failure::Failed { key: "--plot".to_owned(), why: found.sentence(study) };
    found.orbit.as_ref().map(|found| orbit(study, found)).ok_or_else(why)
}

/// The picture of a periodic response.
pub fn orbit(study: &BeltStudy, found: &Orbit) -> Figure {
    let belt = study.belt();
    let samples = samples(study, found);
    let largest = |of: fn(&quell_dynamics::simulation::Sample) -> f64| {
        samples.iter().map(|sample| of(sample).abs()).fold(0.0, f64::max)
    };
    let x = Ruler::new(study, Quantity::Displacement, largest(|sample| sample.displacement));
    let speed = largest(|sample| sample.velocity).max(belt.belt_velocity());
    let v = Ruler::new(study, Quantity::Velocity, speed);
    let curve =
        samples.iter().map(|sample| (x.place(sample.displacement), v.place(sample.velocity)));
    let phase = Panel::new(x.axis("displacement", "x"), v.axis("velocity", "x′"))
        .with(Polyline::new(PlotRole::Dithered, curve))
        .with(ReferenceLine::horizontal(v.place(belt.belt_velocity())).label("belt"));
    let circle = (0..=CIRCLE).map(|k| {
        let angle = TAU * f64::from(k) / f64::from(CIRCLE);
        (libm::cos(angle), libm::sin(angle))
    });
    let reach = 1.1_f64.max(1.1 * found.radius());
    let axis = |name: &str| PlotAxis::new(name).symbol("λ").between(-reach, reach);
    let multipliers = Panel::new(axis("Re"), axis("Im"))
        .with(Polyline::new(PlotRole::Guide, circle))
        .with(Points::new(PlotRole::Exact, found.multipliers).marker(Marker::Disc).size(7.0))
        .equal_scales();
    Figure::grid(2, [phase, multipliers])
        .size(Size::Frame(280.0, 260.0))
        .title(study.title().unwrap_or_default())
        .caption(format!("{} {}.", sentence(study, found), caption(study)))
}
