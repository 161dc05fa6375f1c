//! The plane of starts: two numbers of the state, their windows, and how a door reads them.

use quell_dynamics::orbit::sliding_state;
use quell_dynamics::response::vibration_frequency;
use quell_model::System;
use quell_numerics::interval::RealInterval;

use super::StartLayout;
use crate::complaint::{Complaint, Complaints, Failure};
use crate::nearest;
use crate::quantity;
use crate::study::SystemStudy;

/// An axis of the plane of starts.
#[derive(Clone, Debug, PartialEq)]
pub struct PlaneAxis {
    /// Name of the number of the state.
    pub name: String,
    /// Its least and largest value; derived from the system if `None`.
    pub window: Option<RealInterval>,
}

/// The places of the axes in the state.
pub(super) fn places(
    study: &SystemStudy,
    axes: &[PlaneAxis; 2],
    layout: StartLayout,
) -> Result<[usize; 2], Failure> {
    let names = study.system().state_names();
    let mut wrong = Vec::new();
    let places = axes.each_ref().map(|axis| {
        let place = names.iter().position(|name| *name == axis.name);
        if place.is_none() {
            let allowed = "two names of the state, such as x,velocity.x";
            let complaint = Complaint::option("--plane", axis.name.as_str(), allowed);
            wrong.push(
                complaint.suggesting(nearest::word(&axis.name, names.iter().map(String::as_str))),
            );
        }
        if let Some(RealInterval { lower: from, upper: to }) = axis.window
            && !(from.is_finite() && to.is_finite() && from < to)
        {
            let allowed = "FROM:TO, two finite numbers, the first below the second";
            wrong.push(Complaint::option("--plane", format!("{from}:{to}"), allowed));
        }
        place.unwrap_or(0)
    });
    if wrong.is_empty() && places[0] == places[1] {
        let allowed = "two different names of the state";
        wrong.push(Complaint::option("--plane", axes[1].name.as_str(), allowed));
    }
    wrong.extend(layout.refused("41x31"));
    if wrong.is_empty() { Ok(places) } else { Err(wrong.into()) }
}

/// The window of a number of the state: centred on steady sliding. Of one mass it reaches as far as its static friction holds it and one
/// and a half times as far as the surface takes it in 1/ω₀, in displacement and velocity alike. Of others its reach is the largest
/// displacement of steady sliding, or one and a half times what the fastest surface covers in 1/ω of the vibration; that of a velocity is
/// this reach, or a fifth of the displacement, times ω. Where nothing vibrates ω is 1 in the units of the study: the window is printed, and
/// given with `--plane` where it does not suit.
pub(super) fn window(system: &System, start: &[f64], place: usize) -> RealInterval {
    let size = system.structure.size();
    let is_velocity = system.structure.mechanical().is_some() && place >= size;
    let state = sliding_state(system).unwrap_or_else(|_| start.to_vec());
    let reach = if let Some(mass) = system.one_mass() {
        let belt = mass.belt();
        let hold = belt.friction().static_coefficient() * belt.normal_load();
        let reach = 1.5f64.mul_add(belt.belt_velocity(), hold);
        (mass.state(reach, reach)[place] - mass.state(0.0, 0.0)[place]).abs()
    } else {
        let speeds = system.contacts.iter().map(|contact| contact.surface_velocity.mean().abs());
        let speed = speeds.fold(0.0, f64::max);
        let displacements = state.iter().take(size);
        let largest = displacements.fold(0.0, |m: f64, value| m.max(value.abs()));
        // A displacement in the time scale of the slowest oscillation.
        let rate = vibration_frequency(system).unwrap_or(1.0);
        let reach = (1.5 * speed / rate).max(0.2 * largest);
        if is_velocity { rate * reach } else { reach.max(largest) }
    };
    let reach = if reach > 0.0 { reach } else { 1.0 };
    RealInterval::new(state[place] - reach, state[place] + reach)
}

/// The plane of the first displacement and its velocity, with windows where they are given.
///
/// # Errors
/// First-order equations with a single number, which have no plane.
pub fn default_plane(
    study: &SystemStudy,
    [across, up]: [Option<RealInterval>; 2],
) -> Result<[PlaneAxis; 2], Failure> {
    let names = study.system().state_names();
    let size = study.system().structure.size();
    let second = if study.system().structure.mechanical().is_some() { size } else { 1 };
    let (Some(first), Some(second)) = (names.first(), names.get(second)) else {
        let allowed = "a state with two numbers";
        return Err(Complaint::option("--plane", names.len(), allowed).into());
    };
    let axis = |name: &String, window| PlaneAxis { name: name.clone(), window };
    Ok([axis(first, across), axis(second, up)])
}

/// Reads a plane: `x,velocity.x`, or with windows `x=-1:1,velocity.x=-2:2`.
///
/// # Errors
/// Complaints about its parts.
pub fn read_plane(study: &SystemStudy, text: &str) -> Result<[PlaneAxis; 2], Complaints> {
    let option = "--plane";
    let names = study.system().state_names();
    let axis = |part: &str| -> Result<PlaneAxis, Box<Complaint>> {
        let Some((name, window)) = part.split_once('=') else {
            return Ok(PlaneAxis { name: part.trim().to_owned(), window: None });
        };
        let name = name.trim().to_owned();
        let place = names.iter().position(|known| *known == name);
        let quantity = place.and_then(|place| study.system().state_quantity(place));
        let read = |text: &str| quantity::number(text, quantity, study.units(), option);
        let Some((from, to)) = window.split_once(':') else {
            let allowed = "NAME=FROM:TO, such as x=-1:1";
            return Err(Box::new(Complaint::option(option, part, allowed)));
        };
        Ok(PlaneAxis { name, window: Some(RealInterval::new(read(from)?, read(to)?)) })
    };
    let Some((first, second)) = text.split_once(',').filter(|(_, rest)| !rest.contains(',')) else {
        let allowed = "two names of the state, such as x,velocity.x or x=-1:1,velocity.x=-2:2";
        return Err(Complaint::option(option, text, allowed).into());
    };
    match (axis(first), axis(second)) {
        (Ok(first), Ok(second)) => Ok([first, second]),
        (first, second) => {
            let wrong = [first.err(), second.err()].into_iter().flatten();
            Err(wrong.map(|complaint| *complaint).collect::<Vec<_>>().into())
        }
    }
}
