//! LuGre friction: bristles that deflect before they slip (Canudas de Wit, Olsson, Åström and Lischinsky 1995).
//!
//! ż = v_r − σ₀|v_r| z/g(v_r),   g = μ_c + (μ_s − μ_c) e^{−(v_r/v_s)²},   f/N = σ₀z + σ₁ż + σ₂v_r.
//!
//! z is the mean deflection of the bristles, a length, and the only state. In steady sliding z = g sgn(v_r)/σ₀, and
//! μ(v_r) = g sgn(v_r) + σ₂v_r: the exponential Stribeck law with δ = 2. This curve serves where a law is wanted without its state.
//!
//! All three σ are over the normal load: friction is proportional to the load at every moment.

use super::numeric::{checked, number_of, static_at_least_sliding, with_number};
use super::{Bristles, LawParameters, NumericLaw, Otherwise, SlidingLaw, StribeckExponential};
use crate::InvalidValues;
use crate::parameter::{
    BRISTLE_DAMPING, BRISTLE_STIFFNESS, COEFFICIENT, Parameter, REFERENCE_VELOCITY,
    STATIC_COEFFICIENT, VISCOUS,
};

/// Exponent of the fall of g.
const GAUSSIAN: f64 = 2.0;

/// LuGre friction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lugre {
    /// μ in steady sliding.
    steady: StribeckExponential,
    /// g sgn(v_r), at which the bristles saturate.
    level: StribeckExponential,
    bristles: Bristles,
}

impl Lugre {
    /// The level g sgn(v_r) at which the bristles saturate, as a law of the slip velocity.
    pub fn level(&self) -> StribeckExponential {
        self.level
    }

    /// Damping σ₁ of the bristles, per unit of velocity.
    pub fn bristle_damping(&self) -> f64 {
        self.bristles.damping
    }

    /// The largest damping σ₁ for which the friction force is passive, σ₂μ_c/(μ_s − μ_c); `None` without a bound (μ_s = μ_c).
    ///
    /// The map from v_r to f, with |z| ≤ μ_s/σ₀ and constant load, is passive if and only if σ₂μ_c ≥ σ₁(μ_s − μ_c):
    /// Barabanov and Ortega (2000).
    pub fn largest_passive_damping(&self) -> Option<f64> {
        let [coefficient, level, ..] = self.steady.values()[..] else { return None };
        (level > coefficient).then(|| self.bristles.viscous * coefficient / (level - coefficient))
    }
}

impl LawParameters for Lugre {
    const NAME: &'static str = "lugre";
    const ABOUT: &'static str = "σ₀z + σ₁ż + σ₂v_r with ż = v_r − σ₀|v_r| z/g, g = μ_c + (μ_s − μ_c) e^{−(v_r/v_s)²}; in steady \
                                 sliding g sgn(v_r) + σ₂v_r";
    const PARAMETERS: &'static [Parameter] = &[
        COEFFICIENT,
        STATIC_COEFFICIENT,
        REFERENCE_VELOCITY,
        BRISTLE_STIFFNESS,
        BRISTLE_DAMPING,
        VISCOUS,
    ];

    const HAS_STATE: bool = true;

    fn default_of(path: &str) -> Option<Otherwise> {
        let is_optional = path == BRISTLE_DAMPING.path || path == VISCOUS.path;
        is_optional.then_some(Otherwise::Number(0.0))
    }

    fn values(&self) -> Vec<f64> {
        let steady = self.steady.values();
        let Bristles { stiffness, damping, viscous } = self.bristles;
        vec![steady[0], steady[1], steady[2], stiffness, damping, viscous]
    }

    fn get(&self, path: &str) -> Option<f64> {
        number_of(self, path)
    }

    fn with(&self, path: &str, value: f64) -> Result<Self, InvalidValues> {
        with_number(self, path, value)
    }
}

impl SlidingLaw for Lugre {
    /// Of steady sliding: the state has a series of its own in the engine.
    type Recurrence = StribeckExponential;

    #[inline(always)]
    fn recurrence(&self) -> &StribeckExponential {
        &self.steady
    }

    fn bristles(&self) -> Option<Bristles> {
        Some(self.bristles)
    }

    #[inline(always)]
    fn velocity_scale(&self) -> f64 {
        self.steady.velocity_scale()
    }

    #[inline(always)]
    fn static_coefficient(&self) -> f64 {
        self.steady.static_coefficient()
    }

    #[inline(always)]
    fn starts_at_static_level(&self) -> bool {
        true
    }
}

impl NumericLaw for Lugre {
    fn from_values(values: &[f64]) -> Result<Self, InvalidValues> {
        checked(Self::PARAMETERS, values, || static_at_least_sliding(values[0], values[1]))?;
        let curve =
            |viscous| StribeckExponential::new(values[0], values[1], values[2], GAUSSIAN, viscous);
        let (stiffness, damping, viscous) = (values[3], values[4], values[5]);
        let bristles = Bristles { stiffness, damping, viscous };
        Ok(Self { steady: curve(viscous)?, level: curve(0.0)?, bristles })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steady_sliding_is_the_exponential_stribeck_law() {
        let law = Lugre::from_values(&[0.3, 0.5, 0.1, 1000.0, 2.0, 0.4]).expect("valid");
        let steady = StribeckExponential::new(0.3, 0.5, 0.1, 2.0, 0.4).expect("valid");
        for speed in [0.0, 0.03, 0.1, 0.7] {
            assert_eq!(law.coefficient(speed), steady.coefficient(speed));
            // The state in steady sliding, ż = 0, gives the same friction.
            let Bristles { stiffness, viscous, .. } = law.bristles;
            let z = law.level().coefficient(speed) / stiffness;
            let friction = stiffness.mul_add(z, viscous * speed);
            assert!((friction - law.coefficient(speed)).abs() < 1e-15);
        }
    }

    #[test]
    fn the_bound_of_passive_damping_is_that_of_the_levels() {
        let passive = |level, viscous| {
            let law = Lugre::from_values(&[0.3, level, 0.1, 1000.0, 2.0, viscous]).expect("valid");
            law.largest_passive_damping()
        };
        assert_eq!(passive(0.3, 0.4), None);
        assert_eq!(passive(0.5, 0.0), Some(0.0));
        assert!((passive(0.5, 0.4).expect("a bound") - 0.6).abs() < 1e-14);
    }
}
