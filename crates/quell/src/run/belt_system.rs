//! A belt as its system, which answers `orbit`, `attractor`, `thresholds`, `bifurcation` and `basins`. Its numbers keep their paths.

use quell_dynamics::start::InitialState;
use quell_model::units::Quantity;

use crate::complaint::Failure;
use crate::study::{BeltStudy, DescribedSystem, Study, SystemStart, SystemStudy, not_periodic};

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
        warnings: Vec::new(),
        time: None,
    }))
}

/// A velocity of the equations in the units of the system; displacements are lengths in both.
fn in_units(study: &BeltStudy, velocity: f64) -> f64 {
    study.scales().map_or(velocity, |scales| scales.to_units(Quantity::Velocity, velocity))
}
