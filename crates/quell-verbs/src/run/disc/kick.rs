//! The small motion from which a run of a disc begins: rest is an equilibrium, and no motion would grow from it.

use num_complex::Complex64;
use quell_linear::linearised::Linearised;
use quell_linear::spectrum::{SmallMotion, spectrum};
use quell_model::System;
use quell_numerics::polar::modulus;

use super::overflowed;
use super::watch::SteadyLevel;
use crate::complaint::Failure;

/// Largest relative change of a load or slip velocity in the motion at the start, and its deflection where neither changes.
pub const KICK: f64 = 1e-3;

/// Relative change below which a motion is taken to leave the loads and slip velocities unchanged.
const UNCHANGED: f64 = 1e-9;

/// The leading small motion of a disc, scaled.
#[derive(Clone, Debug, PartialEq)]
pub struct Kick {
    /// λ.
    pub eigenvalue: Complex64,
    /// State with this motion about steady sliding.
    pub state: Vec<f64>,
    /// Amplitude of the observed row in it.
    pub amplitude: f64,
    /// Whether it changes a load or a slip velocity, which then determine its size.
    pub changes_contacts: bool,
    /// Observed value in steady sliding.
    pub middle: f64,
    /// The contacts in steady sliding.
    pub(super) levels: Vec<SteadyLevel>,
}

fn times(row: &[f64], shape: &[Complex64]) -> Complex64 {
    row.iter().zip(shape).map(|(weight, z)| weight * z).sum()
}

/// Largest relative change of a load or a slip velocity in a motion with this shape.
fn largest_change(linear: &Linearised, levels: &[SteadyLevel], motion: &SmallMotion) -> f64 {
    let contacts = linear.contacts().iter().zip(levels);
    let changes = contacts.map(|(contact, level)| {
        let (spring, damper) = contact.normal_spring();
        let approach =
            contact.normal().map_or_else(Complex64::default, |n| times(n, &motion.shape));
        let along = contact.tangent().map_or_else(Complex64::default, |t| times(t, &motion.shape));
        let load = (spring + damper * motion.eigenvalue) * approach;
        let slip = motion.eigenvalue * along;
        let of_load = modulus(load) / level.normal_load.abs();
        of_load.max(modulus(slip) / level.slip_velocity.abs())
    });
    changes.fold(0.0, f64::max)
}

/// The fastest-growing or least-damped small motion of a system without dither, seen by a row over its coordinates.
///
/// # Errors
/// [`Failure::Failed`] without steady sliding, or if a matrix overflows.
pub(super) fn of(system: &System, row: &[f64]) -> Result<Kick, Failure> {
    let failed = |why: String| overflowed("simulate", why);
    let linear = Linearised::new(system).map_err(|why| failed(why.to_string()))?;
    let found = spectrum(&linear, &linear.friction()).map_err(|why| failed(why.to_string()))?;
    let leading = found.motions.first();
    let motion = leading.ok_or_else(|| failed("the disc has no motion".to_owned()))?;
    let levels: Vec<SteadyLevel> = linear
        .contacts()
        .iter()
        .zip(&system.contacts)
        .map(|(contact, given)| SteadyLevel {
            normal_load: contact.steady.normal_load,
            slip_velocity: given.surface_velocity.mean(),
        })
        .collect();
    let observed = times(row, &motion.shape);
    let seen = modulus(observed);
    let change = largest_change(&linear, &levels, motion);
    let changes_contacts = change > UNCHANGED;
    let is_seen = seen > UNCHANGED;
    let size = match (changes_contacts, is_seen) {
        (true, _) => KICK / change,
        (false, true) => KICK / seen,
        (false, false) => KICK,
    };
    // The observed value is at its largest, where it is seen at all.
    let turn = if is_seen { observed.conj() / seen } else { 1.0.into() };
    let scaled = motion.shape.iter().map(|z| size * turn * z);
    let moved = scaled.clone().zip(linear.position()).map(|(z, steady)| steady + z.re);
    let velocities = scaled.map(|z| (motion.eigenvalue * z).re);
    Ok(Kick {
        eigenvalue: motion.eigenvalue,
        state: moved.chain(velocities).collect(),
        amplitude: size * seen,
        changes_contacts,
        middle: row.iter().zip(linear.position()).map(|(weight, x)| weight * x).sum(),
        levels,
    })
}
