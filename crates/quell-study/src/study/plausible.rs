//! Warnings about numbers that are valid but look as if they were in other units.

use std::f64::consts::TAU;

use quell_model::System;
use quell_model::digits::digits;
use quell_model::system::{MassMatrix, Mechanical};
use quell_model::units::Quantity;
use quell_numerics::interval::RealInterval;
use quell_numerics::matrix::Matrix;

use quell_model::units::UnitSystem;

/// Natural frequencies of structures that friction excites, Hz.
const FREQUENCIES: RealInterval = RealInterval::new(0.01, 1e7);

/// The fastest surface that is likely, m/s: beyond high-speed trains at their wheel.
const FASTEST: f64 = 90.0;

/// The largest friction coefficient that is likely: above that of rubber on a dry road.
const ROUGHEST: f64 = 5.0;

/// The largest load or dither that is likely, N.
const STRONGEST: f64 = 1e8;

/// The largest load that is likely, in weights of the heaviest coordinate.
const HEAVIEST_LOAD: f64 = 1e5;

/// The largest load that is likely, in weights of the mass that modes have at the contact: a caliper of 0.5 kg under 20 kN has 4000.
const HEAVIEST_LOAD_ON_MODES: f64 = 3e4;

/// Masses that modes are likely to have at a contact, kg.
const MASSES_OF_MODES: RealInterval = RealInterval::new(1e-5, 1e4);

/// The highest natural frequency that the spring of a contact is likely to have on modes, in that of the highest mode.
const STIFFEST_CONTACT: f64 = 10.0;

/// Acceleration of gravity, m/s².
const GRAVITY: f64 = 9.81;

/// The warnings about a system; numbers without units have none. `modal`: whether its structure is given by modes, whose shapes have
/// the scale of a mass.
pub fn warnings(system: &System, units: UnitSystem, modal: bool) -> Vec<String> {
    let Some(length) = units.si_per_unit(Quantity::Displacement) else { return Vec::new() };
    let name = units.name();
    let mut warnings = of_magnitudes(system, units, length);
    let Some(mechanical) = system.structure.mechanical() else { return warnings };
    let mass = mechanical.mass().matrix();
    for (i, coordinate) in mechanical.coordinates().iter().enumerate() {
        let hertz = (mechanical.stiffness()[(i, i)] / mass[(i, i)]).sqrt() / TAU;
        if hertz > FREQUENCIES.upper || (hertz > 0.0 && hertz < FREQUENCIES.lower) {
            warnings.push(format!(
                "{coordinate} alone would vibrate at {hertz:.3e} Hz: check whether mass and stiffness are in {name}"
            ));
            break;
        }
    }
    if modal {
        warnings.extend(of_modes(system, mechanical, units));
        return warnings;
    }
    let heaviest = (0..mass.rows()).map(|i| mass[(i, i)]).fold(0.0, f64::max);
    let kilograms = heaviest * units.si_per_unit(Quantity::LoadMass).unwrap_or(1.0);
    let load = system.contacts.iter().map(|contact| contact.normal_load).fold(0.0, f64::max);
    if load > HEAVIEST_LOAD * GRAVITY * kilograms {
        warnings.push(format!(
            "a load of {} N on masses of at most {kilograms:.3e} kg is {:.1e} times their weight: check whether the masses are in \
             {name}{}",
            digits(load, 6),
            load / (GRAVITY * kilograms),
            or_other(units)
        ));
    }
    warnings
}

/// The other system of units that the numbers may be in, where a study can have it.
fn or_other(units: UnitSystem) -> &'static str {
    if units == UnitSystem::MmTonneSecond { " or in SI" } else { " or in mm-t-s" }
}

/// Warnings about speeds, coefficients and forces that are larger than any likely one.
fn of_magnitudes(system: &System, units: UnitSystem, length: f64) -> Vec<String> {
    let mut warnings = Vec::new();
    let newtons = units.si_per_unit(Quantity::Force).unwrap_or(1.0);
    for contact in &system.contacts {
        let speed = contact.surface_velocity.mean().abs() * length;
        if speed > FASTEST {
            warnings.push(format!(
                "the surface of contact {} moves at {} m/s: check the unit of its velocity",
                contact.name,
                digits(speed, 6)
            ));
        }
        let coefficient = contact.friction.static_coefficient();
        if coefficient > ROUGHEST {
            warnings.push(format!(
                "the friction coefficient of contact {} is {} at rest: check whether it is a ratio, not per cent or a force",
                contact.name,
                digits(coefficient, 6)
            ));
        }
        let load = contact.normal_load * newtons;
        if load > STRONGEST {
            warnings.push(format!(
                "the load of contact {} is {} N: check its unit",
                contact.name,
                digits(load, 6)
            ));
        }
    }
    for wave in system.waves() {
        let amplitude = wave.amplitude.abs() * newtons;
        if amplitude > STRONGEST {
            warnings.push(format!(
                "the amplitude of a dither is {} N: check its unit",
                digits(amplitude, 6)
            ));
        }
    }
    warnings
}

/// Warnings about modes whose scale does not suit the contacts. Shapes that are normalised to unit mass in another unit of mass have a
/// mass at the contact that is a thousand times too small or too large; natural frequencies do not show that.
fn of_modes(system: &System, mechanical: &Mechanical, units: UnitSystem) -> Vec<String> {
    let kilograms = units.si_per_unit(Quantity::LoadMass).unwrap_or(1.0);
    let mass = mechanical.mass();
    let diagonal = mass.diagonal();
    let highest = (0..mass.size())
        .map(|i| (mechanical.stiffness()[(i, i)] / diagonal[i]).max(0.0).sqrt())
        .fold(0.0, f64::max);
    let question = format!(
        "check whether the shapes are normalised to unit mass in {}{}: between kg and t they differ by the factor 31.6",
        units.name(),
        or_other(units)
    );
    let mut warnings = Vec::new();
    for contact in &system.contacts {
        let rows = [contact.tangent.as_deref(), contact.normal.as_deref()];
        let masses = rows.into_iter().flatten().filter_map(|row| mass_along(mass, row));
        let Some(own) = masses.reduce(f64::min) else { continue };
        let in_kilograms = own * kilograms;
        let weights = contact.normal_load / (GRAVITY * in_kilograms);
        let spring = contact.normal.as_deref().and_then(|row| mass_along(mass, row));
        let spring = spring.map(|own| (contact.normal_stiffness / own).sqrt() / highest);
        let name = &contact.name;
        if !MASSES_OF_MODES.contains(in_kilograms) {
            warnings.push(format!(
                "the modes have a mass of {in_kilograms:.3e} kg at contact {name}: {question}"
            ));
        } else if weights > HEAVIEST_LOAD_ON_MODES {
            warnings.push(format!(
                "the load of {} N at contact {name} is {weights:.1e} times the weight of the {in_kilograms:.3e} kg that the modes \
                 have there: {question}",
                digits(contact.normal_load, 6)
            ));
        } else if let Some(ratio) = spring.filter(|ratio| *ratio > STIFFEST_CONTACT) {
            warnings.push(format!(
                "on the mass that the modes have at contact {name}, {in_kilograms:.3e} kg, its normal spring alone would vibrate at \
                 {} times the frequency of the highest mode: {question}, or whether modes are missing",
                digits(ratio, 3)
            ));
        }
    }
    warnings
}

/// The mass that resists a force along a row, 1/(rᵀM⁻¹r); `None` where the row is zero or the mass singular.
fn mass_along(mass: &MassMatrix, row: &[f64]) -> Option<f64> {
    let force = Matrix::from_fn(row.len(), 1, |i, _| row[i]);
    let moved = mass.solve(&force)?;
    let inverse: f64 = row.iter().enumerate().map(|(i, entry)| entry * moved[(i, 0)]).sum();
    (inverse > 0.0).then(|| inverse.recip())
}

/// Warnings about stiffness and damping with one entry of a symmetric pair, or a stiffness with two of opposite signs, once for each.
pub(super) fn half_symmetric(system: &System) -> Vec<String> {
    let Some(mechanical) = system.structure.mechanical() else { return Vec::new() };
    let matrices = [("damping", mechanical.damping()), ("stiffness", mechanical.stiffness())];
    let found = matrices.into_iter().filter_map(|(name, matrix)| {
        let (i, j) = half_pair(matrix)?;
        let entry = digits(matrix[(i, j)], 6);
        Some(format!(
            "system.{name}[{i}][{j}] is {entry}, but system.{name}[{j}][{i}] is 0: check whether the second entry of a \
             symmetric pair is missing; a {name} that is unsymmetric on purpose is allowed"
        ))
    });
    let lost = lost_sign(mechanical).map(|(i, j)| {
        let [entry, other] = [(i, j), (j, i)].map(|at| digits(mechanical.stiffness()[at], 6));
        format!(
            "system.stiffness[{i}][{j}] is {entry}, but system.stiffness[{j}][{i}] is {other}: check whether one of a symmetric pair has \
             lost its sign; a stiffness that is unsymmetric on purpose is allowed"
        )
    });
    found.chain(lost).collect()
}

/// The first entry of a stiffness whose mirror image is its negative.
fn lost_sign(mechanical: &Mechanical) -> Option<(usize, usize)> {
    let (matrix, damping) = (mechanical.stiffness(), mechanical.damping());
    let n = matrix.rows();
    let mut pairs = (0..n).flat_map(|i| (i + 1..n).map(move |j| (i, j)));
    // Next to gyroscopic terms it is what damping makes of a frame that turns.
    let turns = |(i, j)| damping[(i, j)] != 0.0 && damping[(i, j)] == -damping[(j, i)];
    pairs.find(|&at| {
        let (i, j) = at;
        matrix[at] != 0.0 && matrix[at] == -matrix[(j, i)] && !turns(at)
    })
}

/// The first entry that is not zero while its mirror image is.
fn half_pair(matrix: &Matrix) -> Option<(usize, usize)> {
    let n = matrix.rows();
    let mut pairs = (0..n).flat_map(|i| (0..n).map(move |j| (i, j)));
    pairs.find(|&(i, j)| matrix[(i, j)] != 0.0 && matrix[(j, i)] == 0.0)
}
