//! Contacts with a state of their own and noise, in every verb: refusals, and warnings where the law without its state is not a good
//! model.

use quell_linear::averaging::DitheredContact;
use quell_model::system::InputTarget;
use quell_model::{Friction, System};
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
    let by_contact = [format!("contact.{}", contact.name), format!("contact.{}.", contact.name)];
    let by_table = ["belt".to_owned(), String::new()];
    let is_belt = study.document().get("belt").is_some();
    let [surface, friction] = if is_belt { by_table } else { by_contact };
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

fn adheres(reached: f64, of: &str) -> String {
    format!(
        "the elastic contact{of} adheres for a part of each period of the load, because k_t v/(μ_s dN/dt) = {} is below 1: the average \
         of the rigid law does not hold (Popov et al. 2017)",
        digits(reached)
    )
}

/// The fast motion of a contact.
#[derive(Clone, Copy, Debug)]
pub struct FastContact {
    /// Amplitude of the fast slip velocity.
    pub slip: f64,
    /// The slip speed about which friction is averaged.
    pub speed: f64,
}

/// Why the average of the law of a contact without its state is not that of the contact under the dither; `None` where it is, and of a
/// contact without a state.
pub fn without_state(system: &System, index: usize, fast: FastContact) -> Option<String> {
    let contact = &system.contacts[index];
    let (law, of) = (&contact.friction, format!(" of contact {}", contact.name));
    let lowest = system.acting_frequencies().fold(f64::INFINITY, f64::min);
    // Loads that oscillate move the masses through friction alone.
    let moves = system.inputs.iter().any(|input| matches!(input.target, InputTarget::Force(_)));
    let displacement = if moves { fast.slip / lowest } else { 0.0 };
    if let Some(bristles) = law.bristles() {
        // Π = σ₀a/(F_c ω), a the amplitude of the velocity, is the displacement over that of the bristles.
        let ratio = displacement * bristles.stiffness / saturated(law);
        return (displacement > 0.0 && ratio < LARGE).then(|| bristles_follow(ratio, &of));
    }
    let stiffness = contact.tangential_stiffness?;
    let breakaway = letting_go(law, fast.slip) * contact.normal_load / stiffness;
    if displacement > 0.0 && displacement < LARGE * breakaway {
        return Some(slider_follows(displacement / breakaway, &of));
    }
    let loads = system.inputs.iter().filter(
        |input| matches!(input.target, InputTarget::NormalLoad { contact, .. } if contact == index),
    );
    let waves = loads.flat_map(|input| input.profile.waves());
    let rate = waves.fold(0.0_f64, |most, wave| most.max(wave.amplitude * wave.lowest()));
    let reached = stiffness * fast.speed / (law.static_coefficient() * rate);
    (rate > 0.0 && reached < 1.0).then(|| adheres(reached, &of))
}

/// Warnings about averages of a system under its dither, and about small motions of bristles, where they differ from those of the laws
/// without the states of the contacts.
pub fn averaged_without_states(system: &System, contacts: &[DitheredContact]) -> Vec<String> {
    let mut warnings = Vec::new();
    for (index, (contact, found)) in system.contacts.iter().zip(contacts).enumerate() {
        let speed = contact.surface_velocity.mean().abs();
        warnings.extend(without_state(
            system,
            index,
            FastContact { slip: found.slip_amplitude, speed },
        ));
        if contact.friction.bristles().is_some() {
            warnings.push(small_motions(&format!(" of contact {}", contact.name)));
        }
    }
    warnings
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
