//! Displacement and velocity over time, with and without dither.

use quell_dynamics::simulation::Sample;
use quell_model::units::Quantity;

use super::caption::caption_of_run;
use super::manoeuvre::manoeuvre;
use super::ruler::{Ruler, time_axis};
use crate::plot::{Figure, Panel, PlotRole, Polyline, ReferenceLine, SharedLegend, Sharing};
use crate::run::simulate::Simulation;
use crate::study::BeltStudy;

/// The picture of a sampled trajectory.
pub fn simulate(study: &BeltStudy, done: &Simulation) -> Figure {
    if done.manoeuvre.is_some() {
        return manoeuvre(study, done);
    }
    let with = done.samples.as_deref().unwrap_or_default();
    let without = done.undithered_samples.as_deref().unwrap_or_default();
    let both = || with.iter().chain(without);
    let time = Ruler::of(study, Quantity::Time, both().map(|sample| sample.time));
    let place = Ruler::of(study, Quantity::Displacement, both().map(|sample| sample.displacement));
    let speed = Ruler::of(study, Quantity::Velocity, both().map(|sample| sample.velocity));
    let curve = |samples: &[Sample], role, value: &dyn Fn(&Sample) -> f64| {
        let points = samples.iter().map(|sample| (time.place(sample.time), value(sample)));
        Polyline::new(role, points.collect::<Vec<_>>())
    };
    let displacement = |sample: &Sample| place.place(sample.displacement);
    let velocity = |sample: &Sample| speed.place(sample.velocity);
    let lines = |value: &dyn Fn(&Sample) -> f64| {
        let mut lines = Vec::new();
        if !without.is_empty() {
            lines.push(curve(without, PlotRole::Undithered, value).label("without dither"));
        }
        let (role, label) = match study.belt().dithers() {
            [] => (PlotRole::Exact, "no dither"),
            _ => (PlotRole::Dithered, "with dither"),
        };
        lines.push(curve(with, role, value).label(label));
        lines
    };
    let belt_velocity = speed.place(study.belt().belt_velocity());
    let (belt_symbol, velocity_symbol) = symbols(study);
    let horizontal = || time_axis(study, &time);
    let panels = [
        Panel::new(horizontal(), place.axis("displacement", "x")).with_all(lines(&displacement)),
        Panel::new(horizontal(), speed.axis("velocity", velocity_symbol))
            .with(ReferenceLine::horizontal(belt_velocity).label(belt_symbol))
            .with_all(lines(&velocity)),
    ];
    let figure = Figure::grid(1, panels)
        .sharing_x(Sharing::All)
        .caption(caption_of_run(study))
        .title(study.title().unwrap_or_default());
    if study.belt().dithers().is_empty() { figure } else { figure.legend(SharedLegend::Above) }
}

/// Symbols of the velocities of the belt and of the mass.
fn symbols(study: &BeltStudy) -> (&'static str, &'static str) {
    if study.scales().is_some() { ("$V_0$", "v") } else { ("$v_0$", "x′") }
}
