//! The accuracy of an orbit and of its multipliers.
//!
//! Shooting stops when the mismatch r after a period is small, but the error of the state is (M − 1)⁻¹r: r/|1 − λ| along the
//! eigenvector of a multiplier λ near 1. Near a fold λ itself varies with the state, so that Newton's step underestimates the
//! distance to the orbit by up to a factor of 2 (Kantorovich), which is included. The error of the multipliers is their
//! change over that distance to both sides, in the direction in which the distance is largest.
//! Limit: an estimate, first order in the distance; it is not an enclosure.

use quell_model::Belt;

use super::period_map::{TOLERANCE, radius_of, shoot};
use super::variation::{Matrix2, Variation};
use crate::simulation::Start;

/// Kantorovich's bound on the distance to a root, in Newton steps.
const NEWTON_STEPS: f64 = 2.0;

/// Distance of the true orbit, relative to F, beyond which its multipliers are left undetermined: a difference over it would not
/// measure the slope.
const FAR: f64 = 1e-2;

/// Estimated errors of an orbit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Accuracy {
    /// Error of its state, a length.
    pub(super) state: f64,
    /// Error of the modulus of the deciding multiplier.
    pub(super) multiplier: f64,
}

/// The accuracy of an orbit with this mismatch; `is_free` for a limit cycle, whose phase is not an error.
pub(super) fn accuracy(
    belt: &Belt,
    start: Start,
    period: f64,
    residual: f64,
    variation: &Variation<'_>,
    is_free: bool,
) -> Accuracy {
    let scale = belt.normal_load();
    // The engine's own error and rounding remain, although the mismatch may vanish by chance.
    let noise = TOLERANCE * scale.max(start.displacement.abs()).max(start.velocity.abs());
    let mismatch = residual + noise;
    let ([x, v], slowness) = if is_free {
        ([1.0, 0.0], (1.0 - radius_of(variation, true)).abs())
    } else {
        weakest(&variation.matrix)
    };
    let state = NEWTON_STEPS * mismatch / slowness;
    if state.is_nan() || state > FAR * scale {
        return Accuracy { state, multiplier: f64::INFINITY };
    }
    let here = radius_of(variation, is_free);
    let change = [state, -state].map(|step| {
        let displaced = Start {
            displacement: step.mul_add(x, start.displacement),
            velocity: step.mul_add(v, start.velocity),
            ..start
        };
        shoot(belt, displaced, period)
            .map_or(f64::INFINITY, |(_, there)| (radius_of(&there, is_free) - here).abs())
    });
    Accuracy { state, multiplier: change[0].max(change[1]) }
}

/// The direction of a change of state that M − 1 shortens most, and the factor: its smallest singular value.
fn weakest(matrix: &Matrix2) -> ([f64; 2], f64) {
    let [[a, b], [c, d]] = *matrix;
    let (a, d) = (a - 1.0, d - 1.0);
    // AᵀA = [[p, q], [q, r]]; of its smaller eigenvalue det²/larger does not cancel.
    let (p, q, r) = (a * a + c * c, a * b + c * d, b * b + d * d);
    let larger = 0.5 * (p + r) + libm::hypot(0.5 * (p - r), q);
    let smallest = if larger > 0.0 { (a * d - b * c).abs() / libm::sqrt(larger) } else { 0.0 };
    // The eigenvector of the larger eigenvalue is (q, larger − p) or (larger − r, q); the weakest direction is at right angles
    // to it.
    let strongest = if p > r { [larger - r, q] } else { [q, larger - p] };
    let length = libm::hypot(strongest[0], strongest[1]);
    let direction = if length > 0.0 {
        [-strongest[1] / length, strongest[0] / length]
    } else {
        [std::f64::consts::FRAC_1_SQRT_2; 2]
    };
    (direction, smallest)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_weakest_direction_is_that_of_the_smallest_singular_value() {
        for matrix in [
            [[0.3, -1.2], [0.8, 0.5]],
            [[1.0 + 1e-7, 0.0], [0.0, 0.2]],
            [[0.2, 0.4], [0.0, 1.0 - 1e-9]],
            [[2.0, 1.0], [1.0, 2.0]],
        ] {
            let ([x, v], smallest) = weakest(&matrix);
            assert!((libm::hypot(x, v) - 1.0).abs() < 1e-14);
            let [[a, b], [c, d]] = matrix;
            let image = libm::hypot((a - 1.0) * x + b * v, c * x + (d - 1.0) * v);
            assert!((image - smallest).abs() <= 1e-14, "{matrix:?}: {image} {smallest}");
            // No other direction is shortened more.
            for k in 0..360 {
                let angle = f64::from(k).to_radians();
                let (x, v) = (libm::cos(angle), libm::sin(angle));
                let other = libm::hypot((a - 1.0) * x + b * v, c * x + (d - 1.0) * v);
                assert!(other >= smallest - 1e-14, "{matrix:?}");
            }
        }
    }
}
