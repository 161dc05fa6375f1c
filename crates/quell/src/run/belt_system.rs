//! A belt as its system: `orbit`, `attractor`, `thresholds` and `bifurcation` of every belt, and the other verbs about motions that repeat of a belt
//! whose contact has a state of its own. Its numbers keep their paths.

use quell_dynamics::start::InitialState;
use quell_model::units::Quantity;

use super::basins::BasinsRequest;
use crate::complaint::Failure;
use crate::contact_state::passivity;
use crate::study::{BeltStudy, DescribedSystem, Study, SystemStart, SystemStudy, not_periodic};

/// The system of a belt whose contact has a state of its own, in SI where the study is, otherwise in the numbers of the equations;
/// `None` of a rigid contact.
///
/// # Errors
/// Noise, which has no period; a law whose numbers are out of their bounds in SI.
pub(crate) fn of_state(study: &BeltStudy, verb: &str) -> Result<Option<SystemStudy>, Failure> {
    if study.belt().has_contact_state() { of(study, verb).map(Some) } else { Ok(None) }
}

/// The system of a belt, for a verb about motions that repeat.
///
/// # Errors
/// Noise, which has no period; a law whose numbers are out of their bounds in SI.
pub(crate) fn of(study: &BeltStudy, verb: &str) -> Result<SystemStudy, Failure> {
    if let Some(key) = Study::from(study).noise() {
        return Err(not_periodic(verb, key).into());
    }
    described(study)
}

/// The belt as a system in the units of a study that has units, otherwise in the numbers of the equations.
///
/// # Errors
/// A law whose numbers are out of their bounds in these units.
pub(crate) fn described(study: &BeltStudy) -> Result<SystemStudy, Failure> {
    let initial = match study.initial() {
        InitialState::Rest => SystemStart::Rest,
        InitialState::Sliding => SystemStart::Sliding,
        InitialState::Squealing => SystemStart::Squealing,
        InitialState::Explicit { displacement, velocity } => {
            // The contact begins without load, as in `simulate`.
            SystemStart::Values(vec![displacement, in_units(study, velocity), 0.0])
        }
    };
    Ok(study.as_system(DescribedSystem {
        system: study.system()?,
        units: study.units(),
        observe: vec![1.0],
        initial,
        warnings: passivity(study.belt()).into_iter().collect(),
        time: None,
    }))
}

/// A velocity of the equations in the units of the system; displacements are lengths in both.
fn in_units(study: &BeltStudy, velocity: f64) -> f64 {
    study.scales().map_or(velocity, |scales| scales.to_units(Quantity::Velocity, velocity))
}

/// The request about a belt for its system.
pub(crate) fn basins(study: &BeltStudy, request: &BasinsRequest) -> BasinsRequest {
    let end = |velocity: f64| in_units(study, velocity);
    let velocity = request.velocity.map(|(from, to)| (end(from), end(to)));
    BasinsRequest { velocity, ..request.clone() }
}
