//! The friction of Simscape's Translational Friction, over the normal load:
//! μ(v) = `√(2e)(μ_b − μ_c)(v/v_S)e^{−(v/v_S)²} + μ_c tanh(v/v_C) + fv` with `v_S = √2 v_b` and `v_C = v_b/10`.
//!
//! For a given breakaway velocity `v_b` the three other numbers are linear, and ≥ 0 as the program requires: the Stribeck
//! part `μ_b − μ_c`, Coulomb friction `μ_c`, and viscous friction f. The model has no jump at v = 0, so that of a curve which
//! does not vanish there the speed 0 is left out.

use super::{SpeedCurve, least_over};

/// Stribeck, Coulomb and viscous friction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TranslationalFriction {
    /// Breakaway friction over the normal load, `μ_b`.
    pub breakaway: f64,
    /// Coulomb friction over the normal load, `μ_c`.
    pub coulomb: f64,
    /// Viscous friction over the normal load, the inverse of a speed.
    pub viscous: f64,
    /// Breakaway friction velocity `v_b`.
    pub breakaway_velocity: f64,
    /// The largest difference of μ at the points of the curve that count.
    pub largest_error: f64,
    /// The least slip speed that counts.
    pub slowest: f64,
}

/// A curve begins at 0 if its limit there is at most this share of its largest coefficient.
const VANISHES: f64 = 1e-3;

impl TranslationalFriction {
    /// The model with the least squares of differences from a curve.
    pub fn fitted(curve: &SpeedCurve) -> Self {
        let largest = curve.coefficients.iter().fold(0.0f64, |most, value| most.max(*value));
        let vanishes = curve.coefficients[0] <= VANISHES * largest;
        let slowest = if vanishes { 0.0 } else { curve.slowest() };
        let counts = |speed: f64| speed >= slowest;
        let problem = curve.weighted(counts);
        let factors = |velocity: f64| {
            problem.factors([&|v| stribeck(v / velocity), &|v| coulomb(v / velocity), &|v| v])
        };
        let velocity = least_over(
            |velocity| factors(velocity).1,
            0.1 * curve.slowest(),
            10.0 * curve.fastest(),
        );
        let [excess, coulomb, viscous] = factors(velocity).0;
        let fitted = Self {
            breakaway: coulomb + excess,
            coulomb,
            viscous,
            breakaway_velocity: velocity,
            largest_error: 0.0,
            slowest,
        };
        let largest_error = curve.largest_error(|v| fitted.coefficient(v), counts);
        Self { largest_error, ..fitted }
    }

    /// μ at a slip speed.
    pub fn coefficient(&self, speed: f64) -> f64 {
        let ratio = speed / self.breakaway_velocity;
        let excess = self.breakaway - self.coulomb;
        excess * stribeck(ratio) + self.coulomb * coulomb(ratio) + self.viscous * speed
    }
}

/// The Stribeck part over the ratio of the speed to the breakaway velocity; its maximum, at 1, is 1.
fn stribeck(ratio: f64) -> f64 {
    let scaled = ratio / std::f64::consts::SQRT_2;
    (2.0 * std::f64::consts::E).sqrt() * scaled * libm::exp(-scaled * scaled)
}

/// The Coulomb part over the ratio of the speed to the breakaway velocity.
fn coulomb(ratio: f64) -> f64 {
    libm::tanh(10.0 * ratio)
}
