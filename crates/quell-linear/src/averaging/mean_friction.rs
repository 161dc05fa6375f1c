//! Effective friction: the mean of the friction law over the fast slip velocity.
//!
//! μ̄(v) = ⟨μ(v − s)(1 + ν)⟩ (2.21, 3.19, 4.28), where v is the slow slip velocity, s the fast slip velocity and ν the fast part
//! of the normal load, both with zero mean ([`FastMotion`]). The dissertation prints μ(v_r + αG) in places, which is equivalent
//! only for waveforms with s(θ + π) = −s(θ). The slope is taken with s frozen, because that slope decides stability. With normal
//! dither s depends on v, and differentiating through it is wrong. At a threshold the limit R → ∞ differs from the frozen slope
//! only beyond order α_N² (see `tests/averaging_errata.rs`).
//!
//! | motion | method | relative error of μ̄, μ̄′ |
//! |---|---|---|
//! | one dither, shape G (or sine of any R) | closed forms of the law | 10⁻¹², 10⁻¹¹ |
//! | one dither, another shape | quarter-wave quadrature | 10⁻¹², 10⁻¹⁰ |
//! | one dither by samples | Gauss rules piece by piece | 10⁻¹² of μ, absolute |
//! | commensurate dithers, second-order normal dither, correlated load | quadrature over the period | 10⁻¹² of μ, absolute |
//! | two or three independent groups | nested quadrature | given with the result |
//! | noise | closed forms of the law, or quadrature over a Gaussian distribution | 10⁻¹² of μ, absolute |
//! | noise and other dithers | nested quadrature | given with the result |
//!
//! These errors hold away from a corner |v| = max|s|. At a corner the inner slope grows like (max|s| − |v|)^{−1/2}, and its
//! relative error like the rounding of that difference. Exactly at the corner the outer slope is returned, and the result says so
//! ([`SlopeSide::Outer`](super::SlopeSide::Outer)).

use quell_model::Friction;

use super::effective::Effective;
use super::error::AveragingError;
use super::fast_motion::FastMotion;
use super::{gaussian, independent, periodic, single_wave};

/// Effective friction and its frozen slope at slow slip velocity `v` (any sign) under a given fast motion.
///
/// # Errors
/// [`AveragingError::SetValued`] at v = 0 without fast slip, [`AveragingError::TooManyGroups`], or a quadrature that
/// did not converge.
pub fn effective(law: &Friction, motion: &FastMotion, v: f64) -> Result<Effective, AveragingError> {
    if motion.noise() > 0.0 {
        return match motion.groups() {
            [] => gaussian::effective(law, motion.noise(), v),
            groups => independent::effective(law, (groups, motion.noise()), v),
        };
    }
    match motion.groups() {
        [] => single_wave::undithered(law, v),
        [group] => match group.single_term() {
            Some((wave, amplitude)) => single_wave::effective(law, wave, amplitude, v),
            None => periodic::effective(law, group, v),
        },
        groups => independent::effective(law, (groups, 0.0), v),
    }
}

/// The part of the mean that the fluctuating load makes, ⟨μ(v − s)ν⟩, and its frozen slope. `slip` is the same motion without its
/// load.
///
/// For one group it is integrated by itself: as a difference of two means it would lose every digit near a corner, where the
/// slopes of both grow without bound.
pub(super) fn of_fluctuating_load(
    law: &Friction,
    (motion, slip): (&FastMotion, &Effective),
    v: f64,
) -> Result<(f64, f64), AveragingError> {
    let found = match motion.groups() {
        [group] if motion.noise() == 0.0 => {
            let found = periodic::mean(law, &periodic::Signal::new(group)?, 0.0, v)?;
            return Ok((found.coefficient, found.slope));
        }
        _ => effective(law, motion, v)?,
    };
    Ok((found.coefficient - slip.coefficient, found.slope - slip.slope))
}
