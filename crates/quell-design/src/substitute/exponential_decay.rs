//! `μ(v) = μ_k + (μ_s − μ_k)e^{−dv}` with `μ_s ≥ μ_k ≥ 0`: the static–kinetic model of Abaqus.
//!
//! For a given d the two coefficients are linear: `μ_k` and `μ_s − μ_k` are factors ≥ 0 of 1 and e^{−dv}. The search over d covers
//! decays over a tenth of the least speed of the curve to ten times its largest. A rising curve cannot be fitted; the error
//! shows it.

use super::{SpeedCurve, least_over};

/// Exponential decay from a static to a kinetic coefficient.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ExponentialDecay {
    /// `μ_s`.
    pub static_coefficient: f64,
    /// `μ_k`.
    pub kinetic_coefficient: f64,
    /// d, the inverse of a speed.
    pub decay: f64,
    /// The largest difference of μ at the points of the curve.
    pub largest_error: f64,
}

impl ExponentialDecay {
    /// The model with the least squares of differences from a curve.
    pub fn fitted(curve: &SpeedCurve) -> Self {
        let problem = curve.weighted(|_| true);
        let factors = |decay: f64| problem.factors([&|_| 1.0, &|v| libm::exp(-decay * v)]);
        let ends = (0.1 / curve.fastest(), 10.0 / curve.slowest());
        let decay = least_over(|decay| factors(decay).1, ends.0, ends.1);
        let [kinetic, fall] = factors(decay).0;
        let fitted = Self {
            static_coefficient: kinetic + fall,
            kinetic_coefficient: kinetic,
            decay,
            largest_error: 0.0,
        };
        let largest_error = curve.largest_error(|v| fitted.coefficient(v), |_| true);
        Self { largest_error, ..fitted }
    }

    /// μ at a slip speed.
    pub fn coefficient(&self, speed: f64) -> f64 {
        let fall = self.static_coefficient - self.kinetic_coefficient;
        self.kinetic_coefficient + fall * libm::exp(-self.decay * speed)
    }
}
