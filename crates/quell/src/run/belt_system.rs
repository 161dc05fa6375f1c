//! A belt as its system: the verbs about motions that repeat, of a belt whose contact has a state of its own.
//!
//! The engine for belts has no place for that state, so such a belt is answered by the verbs of systems; its numbers keep their paths.

use quell_dynamics::start::InitialState;
use quell_model::Parametrisation;
use serde_json::Value as Json;

use super::found_attractor::AttractorRequest;
use super::orbit::Wanted;
use super::protocol::Protocol;
use super::system::found_attractor::MotionAttractorRequest;
use super::system::orbit::WantedMotion;
use super::system::protocol::SystemProtocol;
use super::system::start::StateNumbers;
use super::system::thresholds::MotionThresholdsRequest;
use super::thresholds::ThresholdsRequest;
use crate::complaint::{Complaint, Failure, Fault, Origin};
use crate::contact_state::passivity;
use crate::study::{BeltStudy, DescribedSystem, Study, SystemStart, SystemStudy, not_periodic};

/// The system of a belt whose contact has a state of its own, in the numbers of the equations; `None` of a rigid contact.
///
/// # Errors
/// Noise, which has no period; a study in SI, whose numbers would lose their units.
pub(crate) fn of_state(study: &BeltStudy, verb: &str) -> Result<Option<SystemStudy>, Failure> {
    let belt = study.belt();
    if !belt.has_contact_state() {
        return Ok(None);
    }
    if let Some(key) = Study::from(study).noise() {
        return Err(not_periodic(verb, key).into());
    }
    if study.scales().is_some() {
        let allowed = format!(
            "a study in the numbers of the equations, or the same belt as [system] with units = \"SI\": `{verb}` of a belt whose contact \
             has a state of its own is that of its system, whose numbers here have no units"
        );
        return Err(
            Complaint::new(Fault::Conflict, "belt", Origin::Whole, Json::Null, allowed).into()
        );
    }
    let initial = match study.initial() {
        InitialState::Rest => SystemStart::Rest,
        InitialState::Sliding => SystemStart::Sliding,
        InitialState::Squealing => SystemStart::Squealing,
        InitialState::Explicit { displacement, velocity } => {
            // The contact begins without load, as in `simulate`.
            SystemStart::Values(vec![displacement, velocity, 0.0])
        }
    };
    Ok(Some(study.as_system(DescribedSystem {
        system: belt.system(),
        observe: vec![1.0],
        initial,
        warnings: passivity(belt).into_iter().collect(),
        time: None,
        belt: Some(belt.clone()),
    })))
}

/// Displacement and velocity as numbers of a state.
fn numbers((displacement, velocity): (f64, f64)) -> StateNumbers {
    vec![(0, displacement), (1, velocity)]
}

/// The request about a belt for its system.
pub(crate) fn wanted(wanted: Wanted) -> WantedMotion {
    match wanted {
        Wanted::OfSliding { periods } => WantedMotion::Base { periods },
        Wanted::Near { state, periods } => WantedMotion::Near { state: numbers(state), periods },
        Wanted::After(start) => WantedMotion::After(protocol(start)),
    }
}

/// The request about a belt for its system.
pub(crate) fn thresholds(request: ThresholdsRequest) -> MotionThresholdsRequest {
    let ThresholdsRequest { parameter, from, to, protocols, ramp } = request;
    let protocols = protocols.into_iter().map(protocol).collect();
    MotionThresholdsRequest { parameter, window: (from, to), near: None, protocols, ramp }
}

fn protocol(protocol: Protocol) -> SystemProtocol {
    match protocol {
        Protocol::Rest => SystemProtocol::Rest,
        Protocol::Sliding => SystemProtocol::Sliding,
        Protocol::Squeal => SystemProtocol::Squeal,
        Protocol::From(displacement, velocity) => {
            SystemProtocol::From(numbers((displacement, velocity)))
        }
    }
}

/// The request about a belt for its system.
pub(crate) fn attractor(request: &AttractorRequest) -> MotionAttractorRequest {
    let AttractorRequest { start, lyapunov } = *request;
    MotionAttractorRequest { start: start.map_or_else(Vec::new, numbers), lyapunov }
}
