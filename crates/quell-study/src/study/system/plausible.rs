//! Warnings about numbers that are valid but look as if they were in other units.

use std::f64::consts::TAU;

use quell_model::System;
use quell_model::digits::digits;
use quell_model::units::Quantity;
use quell_numerics::matrix::Matrix;

use super::units::SystemUnits;

/// Natural frequencies of structures that friction excites, Hz.
const FREQUENCIES: (f64, f64) = (0.01, 1e7);

/// The fastest surface that is likely, m/s.
const FASTEST: f64 = 300.0;

/// The largest load that is likely, in weights of the heaviest coordinate.
const HEAVIEST_LOAD: f64 = 1e5;

/// Acceleration of gravity, m/s².
const GRAVITY: f64 = 9.81;

/// The warnings about a system; numbers without units have none.
pub(super) fn warnings(system: &System, units: SystemUnits, modal: bool) -> Vec<String> {
    let mut warnings = Vec::new();
    let Some(length) = units.si_per_unit(Quantity::Displacement) else { return warnings };
    let name = units.name();
    let other = match units {
        SystemUnits::MmTonneSecond => "SI",
        _ => "mm-t-s",
    };
    if let Some(mechanical) = system.structure.mechanical() {
        let mass = mechanical.mass().matrix();
        for (i, coordinate) in mechanical.coordinates().iter().enumerate() {
            let hertz = (mechanical.stiffness()[(i, i)] / mass[(i, i)]).sqrt() / TAU;
            if hertz > FREQUENCIES.1 || (hertz > 0.0 && hertz < FREQUENCIES.0) {
                warnings.push(format!(
                    "{coordinate} alone would vibrate at {hertz:.3e} Hz. Check whether mass and stiffness are in {name}."
                ));
                break;
            }
        }
        let heaviest = (0..mass.rows()).map(|i| mass[(i, i)]).fold(0.0, f64::max);
        let kilograms = heaviest * units.si_per_unit(Quantity::LoadMass).unwrap_or(1.0);
        let load = system.contacts.iter().map(|contact| contact.normal_load).fold(0.0, f64::max);
        if !modal && load > HEAVIEST_LOAD * GRAVITY * kilograms {
            warnings.push(format!(
                "A load of {} N on masses of at most {kilograms:.3e} kg is {:.1e} times their weight. Check whether the \
                 masses are in {name} or in {other}.",
                digits(load, 6),
                load / (GRAVITY * kilograms)
            ));
        }
    }
    for contact in &system.contacts {
        let speed = contact.surface_velocity.mean().abs() * length;
        if speed > FASTEST {
            warnings.push(format!(
                "The surface of contact {} moves at {} m/s. Check whether its velocity is in {name} or in {other}.",
                contact.name,
                digits(speed, 6)
            ));
        }
    }
    warnings
}

/// Warnings about stiffness and damping with one entry of a symmetric pair, once for each matrix.
pub(super) fn half_symmetric(system: &System) -> Vec<String> {
    let Some(mechanical) = system.structure.mechanical() else { return Vec::new() };
    let matrices = [("damping", mechanical.damping()), ("stiffness", mechanical.stiffness())];
    let found = matrices.into_iter().filter_map(|(name, matrix)| {
        let (i, j) = half_pair(matrix)?;
        let entry = digits(matrix[(i, j)], 6);
        Some(format!(
            "system.{name}[{i}][{j}] is {entry}, but system.{name}[{j}][{i}] is 0. Check whether the second entry of a \
             symmetric pair is missing; a {name} that is unsymmetric on purpose is allowed."
        ))
    });
    found.collect()
}

/// The first entry that is not zero while its mirror image is.
fn half_pair(matrix: &Matrix) -> Option<(usize, usize)> {
    let n = matrix.rows();
    let mut pairs = (0..n).flat_map(|i| (0..n).map(move |j| (i, j)));
    pairs.find(|&(i, j)| matrix[(i, j)] != 0.0 && matrix[(j, i)] == 0.0)
}
