//! Effective friction: the mean of the friction law over the fast slip velocity.
//!
//! μ̄(v) = ⟨μ(v − s)(1 + ν)⟩ (2.21, 3.19, 4.28): v the slow slip velocity, s the fast slip velocity and ν the fast part of
//! the normal load, both zero-mean ([`FastMotion`]). The print has μ(v_r + αG) in places, which only waveforms with
//! s(θ + π) = −s(θ) forgive. The slope keeps s frozen: that is what decides stability (with normal dither s depends on v, and
//! differentiating through it is wrong; the limit R → ∞ differs from the frozen slope at a threshold beyond α_N² only, see
//! `tests/averaging_errata.rs`).
//!
//! | motion | how | relative error of μ̄, μ̄′ |
//! |---|---|---|
//! | one dither, shape G (or sine of any R) | closed forms of the law | 10⁻¹², 10⁻¹¹ |
//! | one dither, another shape | quarter-wave quadrature | 10⁻¹², 10⁻¹⁰ |
//! | commensurate dithers, second order of normal dither, correlated load | quadrature over the period | 10⁻¹² absolute in units of μ |
//! | two or three independent groups | nested quadrature | stated with the result |
//!
//! Away from a corner |v| = max|s|; there the slope inside grows like (max|s| − |v|)^{−1/2}, and its relative error like the
//! rounding of that difference. Exactly at the corner the outer slope is given, and the result says so ([`Side::Outer`]).

use quell_model::Friction;
use quell_numerics::quadrature::{Integral, QuadratureError};

use super::fast_motion::FastMotion;
use super::{decreasing, independent, periodic, single_wave, stribeck, wave::FastWave};

/// Whether the slope is the same on both sides of the slip velocity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// An ordinary slope.
    Both,
    /// |v| equals the largest fast velocity: the slope jumps there (to +∞ inside for sine and triangle, by a finite step for a
    /// square), and the value given is that for growing |v|.
    Outer,
}

/// Effective friction at one slip velocity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Effective {
    /// μ̄ (dimensionless).
    pub coefficient: f64,
    /// Bound on the numerical error of `coefficient`.
    pub coefficient_error: f64,
    /// dμ̄/dv_r with the fast motion frozen, per unit velocity.
    pub slope: f64,
    /// Bound on the numerical error of `slope`.
    pub slope_error: f64,
    /// Whether `slope` is one-sided.
    pub side: Side,
}

impl Effective {
    /// Sum of named parts; the error counts the rounding of each (`slope_size`: size of the terms inside a slope part).
    pub(super) fn closed(
        coefficient: [f64; 2],
        slope: [f64; 2],
        slope_size: f64,
        side: Side,
    ) -> Self {
        let rounding = 16.0 * f64::EPSILON;
        Self {
            coefficient: coefficient[0] + coefficient[1],
            coefficient_error: rounding * (coefficient[0].abs() + coefficient[1].abs()),
            slope: slope[0] + slope[1],
            slope_error: rounding * (slope[0].abs() + slope[1].abs() + slope_size),
            side,
        }
    }

    /// The value at −v: μ̄ is odd there, its slope even.
    fn mirrored(self) -> Self {
        Self { coefficient: -self.coefficient, ..self }
    }
}

/// Why an average is not a number.
#[derive(Clone, Debug, PartialEq)]
pub enum AveragingError {
    /// No slip and no fast motion: friction takes any value in [−μ_s, μ_s].
    SetValued {
        /// Static coefficient μ_s.
        static_coefficient: f64,
    },
    /// More groups of incommensurate dithers than nested quadrature can serve.
    TooManyGroups {
        /// Groups with mutually incommensurate frequencies.
        groups: usize,
        /// Largest number served.
        largest: usize,
    },
    /// The oscillator's response is asked for at a frequency ratio that is not above resonance.
    NotFast {
        /// Frequency ratio R ≤ 1.
        frequency_ratio: f64,
    },
    /// A quadrature did not reach its tolerance.
    Quadrature(QuadratureError),
}

impl From<QuadratureError> for AveragingError {
    fn from(error: QuadratureError) -> Self {
        Self::Quadrature(error)
    }
}

/// An integral whose tolerance only the rounding of its integrand forbids serves, with the error it has.
pub(super) fn settled(
    integral: Result<Integral, QuadratureError>,
) -> Result<Integral, AveragingError> {
    match integral {
        Ok(integral) | Err(QuadratureError::Rounding { best: integral }) => Ok(integral),
        Err(error) => Err(error.into()),
    }
}

impl core::fmt::Display for AveragingError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::SetValued { static_coefficient } => write!(
                f,
                "without slip and without fast motion friction takes any value up to ±{static_coefficient}"
            ),
            Self::TooManyGroups { groups, largest } => write!(
                f,
                "{groups} dithers of mutually incommensurate frequencies; averaging serves up to {largest} such groups"
            ),
            Self::NotFast { frequency_ratio } => write!(
                f,
                "the oscillator's own response to the dither needs a frequency ratio above 1, not {frequency_ratio}"
            ),
            Self::Quadrature(error) => write!(f, "averaging: {error}"),
        }
    }
}

impl core::error::Error for AveragingError {}

/// Effective friction and its frozen slope at slow slip velocity `v` (any sign) under a given fast motion.
///
/// # Errors
/// [`AveragingError::SetValued`] at v = 0 without fast slip, [`AveragingError::TooManyGroups`], or a quadrature that
/// did not converge.
pub fn effective(law: &Friction, motion: &FastMotion, v: f64) -> Result<Effective, AveragingError> {
    match motion.groups() {
        [] => undithered(law, v),
        [group] => match group.single_term() {
            Some((wave, amplitude)) => single(law, wave, amplitude, v),
            None => periodic::effective(law, group, v),
        },
        groups => independent::effective(law, groups, v),
    }
}

/// The law itself.
pub(super) fn undithered(law: &Friction, v: f64) -> Result<Effective, AveragingError> {
    if v == 0.0 {
        return Err(AveragingError::SetValued { static_coefficient: law.static_coefficient() });
    }
    let speed = v.abs();
    let coefficient = law.coefficient(speed).copysign(v);
    let slope = law.slope(speed);
    let size = law.slope(0.0).abs() + slope.abs();
    Ok(Effective::closed([coefficient, 0.0], [slope, 0.0], size, Side::Both))
}

/// One dither, `amplitude` ≠ 0: closed form where there is one, else quadrature over a quarter wave.
pub(super) fn single(
    law: &Friction,
    wave: FastWave,
    amplitude: f64,
    v: f64,
) -> Result<Effective, AveragingError> {
    let (wave, factor) = wave.canonical();
    // s and −s have the same distribution.
    let alpha = amplitude.abs() * factor;
    let speed = v.abs();
    let effective = match (law, wave) {
        (Friction::Stribeck(law), FastWave::Integral(waveform)) => {
            stribeck::effective(law, waveform, alpha, speed)
        }
        (Friction::Decreasing(law), FastWave::Integral(waveform)) => {
            decreasing::effective(law, waveform, alpha, speed)?
        }
        (law, wave) => single_wave::effective(law, wave, alpha, speed)?,
    };
    Ok(if v < 0.0 { effective.mirrored() } else { effective })
}

/// The same by quadrature, whatever the law: a second method for the closed forms.
///
/// # Errors
/// A quadrature that did not converge.
pub fn effective_by_quadrature(
    law: &Friction,
    wave: FastWave,
    amplitude: f64,
    v: f64,
) -> Result<Effective, AveragingError> {
    if amplitude == 0.0 {
        return undithered(law, v);
    }
    let effective = single_wave::effective(law, wave, amplitude.abs(), v.abs())?;
    Ok(if v < 0.0 { effective.mirrored() } else { effective })
}
