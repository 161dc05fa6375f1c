//! Contacts with a state of their own and noise, in every verb: refusals, and warnings where the law without its state is not a good
//! model.

use quell_linear::averaging::DitheredContact;
use quell_model::{Belt, Contact, Direction, Friction, System};
use serde_json::Value as Json;

use crate::complaint::{Complaint, Failure, Fault, Origin};
use crate::study::SystemStudy;
use crate::words::digits;

/// Ratio of the dither displacement to the breakaway displacement, and Π of bristles, from which the average of the rigid law is good:
/// its error is about the reciprocal.
const LARGE: f64 = 30.0;

/// Rejects a verb that knows averages alone on a system with a contact that has a state of its own.
///
/// # Errors
/// A complaint about the key that gives the contact its state.
pub(crate) fn refused_where_averaged(study: &SystemStudy, verb: &str) -> Result<(), Failure> {
    let system = study.system();
    let Some(contact) = system.contacts.iter().find(|contact| contact.has_state()) else {
        return Ok(());
    };
    // The system of a belt has the document of the belt.
    let of_system = [format!("contact.{}", contact.name), format!("contact.{}.", contact.name)];
    let of_belt = ["belt".to_owned(), String::new()];
    let is_belt = study.document().get("belt").is_some();
    let [surface, friction] = if is_belt { of_belt } else { of_system };
    let (key, value) = match contact.tangential_stiffness {
        Some(stiffness) => (format!("{surface}.tangential_stiffness"), Json::from(stiffness)),
        None => (format!("{friction}friction.law"), Json::from(contact.friction.kind().name())),
    };
    let allowed = format!(
        "a rigid contact with a law of the slip velocity alone for `{verb}`, which compares with averages; `design` and `thresholds` know \
         contacts with a state of their own"
    );
    Err(Complaint::new(Fault::Conflict, key, Origin::Whole, value, allowed).into())
}

/// Warnings where the average of the law without its state differs from that of the contact of a belt.
pub(crate) fn rigid_average(belt: &Belt, slip_velocity: f64) -> Option<String> {
    let law = belt.friction();
    let total = |value: fn(&quell_model::Dither) -> f64, direction| {
        belt.dithers_along(direction).map(value).fold(0.0, f64::max)
    };
    let displacement =
        total(|dither| dither.amplitude_ratio() / dither.frequency_ratio, Direction::Tangential);
    if let Some(bristles) = law.bristles() {
        // Π = σ₀a/(F_c ω), a the amplitude of the velocity, is the displacement over that of the bristles.
        let ratio = displacement * bristles.stiffness / saturated(law);
        return (displacement > 0.0 && ratio < LARGE).then(|| bristles_follow(ratio, ""));
    }
    let stiffness = belt.tangential_stiffness()?;
    let breakaway = letting_go(law, belt.fast_velocity()) * belt.normal_load() / stiffness;
    if displacement > 0.0 && displacement < LARGE * breakaway {
        return Some(slider_follows(displacement / breakaway, ""));
    }
    let rate = total(|dither| dither.amplitude * dither.frequency_ratio, Direction::Normal);
    let reached = stiffness * slip_velocity.abs() / (law.static_coefficient() * rate);
    (rate > 0.0 && reached < 1.0).then(|| {
        format!(
            "the elastic contact adheres for a part of each period of the load, because k_t v/(μ_s dN/dt) = {} is below 1: the average \
             of the rigid law does not hold (Popov et al. 2017)",
            digits(reached)
        )
    })
}

/// The largest coefficient at which an elastic slider lets go under slip speeds up to `speed`: its static level, or that of sliding where
/// the law rises above it.
fn letting_go(law: &Friction, speed: f64) -> f64 {
    law.static_coefficient().max(law.coefficient(speed))
}

/// The level at which bristles saturate at high slip.
fn saturated(law: &Friction) -> f64 {
    law.values().first().copied().unwrap_or_else(|| law.static_coefficient())
}

fn bristles_follow(ratio: f64, of: &str) -> String {
    format!(
        "the bristles{of} follow the dither without slipping for a part of each period, because Π = σ₀a/(F_c ω) = {} is not large: the \
         average of the law without its state does not hold",
        digits(ratio)
    )
}

fn slider_follows(ratio: f64, of: &str) -> String {
    format!(
        "the elastic contact{of} follows the dither without slipping for a part of each period, because the dither displacement is {} \
         times the breakaway displacement, not many times: the average of the rigid law does not hold",
        digits(ratio)
    )
}

/// Warnings where the averages and the small motions of the contacts of a system differ from those of the laws without their states.
/// `fast` has the amplitude of the fast slip velocity of each contact, and the lowest frequency of the dither.
pub(crate) fn without_states(system: &System, fast: Option<(&[f64], f64)>) -> Vec<String> {
    let mut warnings = Vec::new();
    for (index, contact) in system.contacts.iter().enumerate() {
        let of = format!(" of contact {}", contact.name);
        let displacement = fast.map_or(0.0, |(slip, frequency)| {
            slip.get(index).map_or(0.0, |amplitude| amplitude / frequency)
        });
        let law = &contact.friction;
        if let Some(bristles) = law.bristles() {
            let ratio = displacement * bristles.stiffness / saturated(law);
            if displacement > 0.0 && ratio < LARGE {
                warnings.push(bristles_follow(ratio, &of));
            }
            if !system.inputs.is_empty() {
                warnings.push(small_motions(&of));
            }
        } else if let Some(stiffness) = contact.tangential_stiffness {
            let speed = fast.and_then(|(slip, _)| slip.get(index).copied()).unwrap_or_default();
            let breakaway = letting_go(law, speed) * contact.normal_load / stiffness;
            if displacement > 0.0 && displacement < LARGE * breakaway {
                warnings.push(slider_follows(displacement / breakaway, &of));
            }
        }
    }
    warnings
}

/// The warnings of [`without_states`] about averages of a system under its dither.
pub(crate) fn averaged_without_states(
    system: &System,
    contacts: &[DitheredContact],
) -> Vec<String> {
    if !system.contacts.iter().any(Contact::has_state) {
        return Vec::new();
    }
    let lowest = system.acting_frequencies().fold(f64::INFINITY, f64::min);
    let fast: Vec<f64> = contacts.iter().map(|contact| contact.slip_amplitude).collect();
    without_states(system, Some((&fast, lowest)))
}

/// The warning that averages are a start alone, where the exact answers next to them know the state of the contact.
pub(crate) fn averages_are_a_start(because: &str) -> String {
    format!(
        "averaged amplitudes are those of the law without the state of its contact, from which the exact ones, which know it, are \
         sought: {because}"
    )
}

/// The warning about small motions of bristles.
pub(crate) fn small_motions(of: &str) -> String {
    format!(
        "averaged small motions are those of the steady friction{of}: the bristles are taken to follow the slip at once, which holds for \
         motions slower than σ₀v/g"
    )
}
