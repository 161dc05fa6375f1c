//! A belt as its system, which answers what is said of belts and systems alike. Its numbers keep their paths.

use std::f64::consts::TAU;

use quell_dynamics::start::InitialState;
use quell_model::units::Quantity;

use crate::complaint::Failure;
use crate::study::{
    BeltStudy, DescribedSystem, GivenSize, RecordSettings, Solver, Study, SystemStart, SystemStudy,
    plausible,
};

/// The system of a belt, or a system itself.
///
/// # Errors
/// A disc; a law whose numbers are out of their bounds in SI.
pub(crate) fn system_of(study: &Study) -> Result<SystemStudy, Failure> {
    match study.belt() {
        Ok(belt) => described(&belt),
        Err(_) => Ok(study.system().map_err(|complaint| *complaint)?),
    }
}

/// The belt as a system in the units of a study that has units, otherwise in the numbers of the equations.
///
/// # Errors
/// A law whose numbers are out of their bounds in these units.
pub(crate) fn described(study: &BeltStudy) -> Result<SystemStudy, Failure> {
    warned(study, Vec::new())
}

fn warned(study: &BeltStudy, warnings: Vec<String>) -> Result<SystemStudy, Failure> {
    Ok(study.as_system(DescribedSystem {
        system: study.system()?,
        units: study.units(),
        observe: vec![1.0],
        initial: initial(study),
        warnings,
        sizes: sizes(study),
        actuator: study.actuator_in_units(),
        design: study.design_in_units(),
        tolerance: Some(study.solver().tolerance),
        record: recorded(study),
        time: None,
    }))
}

/// Where runs begin.
fn initial(study: &BeltStudy) -> SystemStart {
    match study.initial() {
        InitialState::Rest => SystemStart::Rest,
        InitialState::Sliding => SystemStart::Sliding,
        InitialState::Squealing => SystemStart::Squealing,
        InitialState::Explicit { displacement, velocity } => {
            // The contact begins without load, as in `simulate`.
            SystemStart::Values(vec![displacement, in_units(study, velocity), 0.0])
        }
    }
}

/// The unit of time of the equations in that of the system.
fn unit_of_time(study: &BeltStudy) -> f64 {
    study.scales().map_or(1.0, |scales| scales.to_units(Quantity::Time, 1.0))
}

/// The record of a response.
fn recorded(study: &BeltStudy) -> RecordSettings {
    let one = unit_of_time(study);
    let Solver { settle, record_periods, .. } = *study.solver();
    RecordSettings {
        settle: Some(one * settle),
        length: Some(one * TAU * f64::from(record_periods)),
        band: study.band().map(|ends| ends.map(|end| end / one)),
    }
}

/// A velocity of the equations in the units of the system; displacements are lengths in both.
fn in_units(study: &BeltStudy, velocity: f64) -> f64 {
    study.scales().map_or(velocity, |scales| scales.to_units(Quantity::Velocity, velocity))
}

/// The amplitudes that are given by another size, in these units.
fn sizes(study: &BeltStudy) -> Vec<GivenSize> {
    let one = study.scales().map_or(1.0, |scales| scales.to_units(Quantity::Force, 1.0));
    let given = study.given_sizes().iter().cloned();
    given.map(|given| GivenSize { amplitude: one * given.amplitude, ..given }).collect()
}

/// The system of a belt as `check` shows it, with what is unlikely about the numbers of the belt.
///
/// # Errors
/// As [`described`].
pub(crate) fn checked(study: &BeltStudy) -> Result<SystemStudy, Failure> {
    let belt = study.belt();
    let in_units = belt.system_in_units().and_then(Result::ok);
    let magnitudes = in_units.map(|system| plausible::warnings(&system, study.units(), false));
    warned(study, magnitudes.into_iter().flatten().collect())
}
