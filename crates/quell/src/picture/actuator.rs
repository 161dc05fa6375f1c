//! What an actuator can give over frequency, against what quenching needs, and the slip velocity that it reaches.

use quell_design::actuator::ActuatorAtFrequency;
use quell_model::units::Quantity;

use super::caption::caption;
use super::ruler::Ruler;
use crate::plot::{
    Figure, LineStyle, Marker, Panel, PlotAxis, PlotPoint, PlotRole, Points, Polyline,
    ReferenceLine, Region, SharedLegend,
};
use crate::run::actuator::ActuatorFound;
use crate::run::design::{FrequencyScale, StudyWithDesign};
use crate::study::SystemStudy;

/// The axes of one study.
struct ActuatorRulers {
    frequency: (PlotAxis, FrequencyScale),
    force: Ruler,
    velocity: Ruler,
}

/// The picture of a study.
pub fn actuator(study: &SystemStudy, done: &ActuatorFound) -> Figure {
    let rulers = ActuatorRulers {
        frequency: frequency(study, "ω"),
        force: Ruler::new(study, Quantity::Force, forces(done)),
        velocity: Ruler::new(study, Quantity::Velocity, velocities(done)),
    };
    figure(done, &rulers).title(study.title().unwrap_or_default()).caption(format!(
        "{} {}",
        caption(study),
        done.sentence(study)
    ))
}

/// The axis of the frequency, in hertz where the study has seconds.
fn frequency(study: &SystemStudy, symbol: &str) -> (PlotAxis, FrequencyScale) {
    let scale = study.frequency_scale();
    let axis = PlotAxis::new(scale.noun).symbol(if scale.unit.is_empty() { symbol } else { "" });
    let axis = if scale.unit.is_empty() { axis } else { axis.unit(scale.unit.trim()) };
    (axis.log(), scale)
}

/// The largest amplitude, if it is a number of the picture.
fn largest(point: &ActuatorAtFrequency) -> Option<f64> {
    point
        .reach()
        .ok()
        .map(|reach| reach.amplitude)
        .filter(|value| *value > 0.0 && value.is_finite())
}

fn needed(point: &ActuatorAtFrequency) -> Option<f64> {
    point.needed.as_ref().ok().copied().filter(|value| *value > 0.0)
}

fn forces(done: &ActuatorFound) -> impl Iterator<Item = f64> {
    done.coverage.points.iter().flat_map(|point| [largest(point), needed(point)]).flatten()
}

fn velocities(done: &ActuatorFound) -> impl Iterator<Item = f64> {
    let contacts = 0..done.contacts.len();
    contacts.flat_map(move |contact| {
        done.coverage.points.iter().filter_map(move |point| point.reached_slip(contact).ok())
    })
}

fn figure(done: &ActuatorFound, rulers: &ActuatorRulers) -> Figure {
    Figure::grid(1, [amplitudes(done, rulers), slips(done, rulers)]).legend(SharedLegend::Below)
}

/// Amplitudes over frequency, with the ranges in which the actuator suffices.
fn amplitudes(done: &ActuatorFound, rulers: &ActuatorRulers) -> Panel {
    let ActuatorRulers { frequency: (axis, scale), force, .. } = rulers;
    let curve = |value: &dyn Fn(&ActuatorAtFrequency) -> Option<f64>| -> Vec<PlotPoint> {
        let points = done.coverage.points.iter();
        points
            .map(|point| {
                let height = value(point).map_or(f64::NAN, |value| force.place(value));
                PlotPoint::new(scale.of(point.frequency), height)
            })
            .collect()
    };
    let mut panel = Panel::new(axis.clone(), force.axis("amplitude of the dither", "").log());
    for (place, band) in done.coverage.sufficient.iter().enumerate() {
        let strip = Region::across_x(
            PlotRole::Stable,
            scale.of(band.ends.lower),
            scale.of(band.ends.upper),
        );
        panel = panel.with(if place == 0 { strip.label("the actuator suffices") } else { strip });
    }
    panel = panel
        .with(
            Polyline::pieces(PlotRole::Exact, [curve(&largest)])
                .label("largest that the actuator can give"),
        )
        .with(
            Polyline::pieces(PlotRole::Averaged, [curve(&needed)])
                .label("least that quenches by averaging"),
        );
    let changes = done.notable.iter().filter(|(what, _)| what.contains('→'));
    let changes: Vec<PlotPoint> = changes
        .filter_map(|(_, at)| {
            Some(PlotPoint::new(scale.of(at.frequency), force.place(largest(at)?)))
        })
        .collect();
    if !changes.is_empty() {
        panel = panel.with(
            Points::new(PlotRole::Exact, changes)
                .marker(Marker::Circle)
                .size(7.0)
                .label("another limit binds"),
        );
    }
    let own = PlotPoint::new(scale.of(done.own.frequency), force.place(done.own_amplitude));
    if done.own_amplitude > 0.0
        && done.range.lower <= done.own.frequency
        && done.own.frequency <= done.range.upper
    {
        panel = panel.with(
            Points::new(PlotRole::Dithered, vec![own])
                .marker(Marker::Disc)
                .size(7.0)
                .label("dither of the study"),
        );
    }
    panel.title("(a) amplitude")
}

/// Slip velocities at the contacts under the largest amplitude, with the velocities of the surfaces.
fn slips(done: &ActuatorFound, rulers: &ActuatorRulers) -> Panel {
    let ActuatorRulers { frequency: (axis, scale), velocity, .. } = rulers;
    let mut panel =
        Panel::new(axis.clone(), velocity.axis("slip velocity that is reached", "").log());
    let several = done.contacts.len() > 1;
    for (contact, (name, speed)) in done.contacts.iter().enumerate() {
        let points = done.coverage.points.iter().map(|point| {
            let slip = point.reached_slip(contact).ok().filter(|slip| *slip > 0.0);
            PlotPoint::new(
                scale.of(point.frequency),
                slip.map_or(f64::NAN, |slip| velocity.place(slip)),
            )
        });
        let label = if several {
            format!("slip velocity at {name}")
        } else {
            "slip velocity at the contact".to_owned()
        };
        panel = panel.with(
            Polyline::pieces(PlotRole::Series(contact), [points.collect::<Vec<_>>()]).label(label),
        );
        if *speed > 0.0 {
            let line = ReferenceLine::horizontal(velocity.place(*speed)).style(LineStyle::Dashed);
            let label = if contact == 0 { "velocity of the surface" } else { "" };
            panel = panel.with(line.label(label));
        }
    }
    panel.title("(b) slip velocity")
}
