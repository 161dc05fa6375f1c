//! Any law under noise: the mean over a Gaussian fast velocity.
//!
//! The fast velocity w of many independent lines is nearly Gaussian, with the variance σ² = ½ Σ (Aᵢ/Rᵢ)² in the limit of high
//! frequency (at finite R each line has the gain of the oscillator, Rᵢ²/(Rᵢ² − 1)). With the density φ of w and the sliding
//! coefficient c(u) at speed u ≥ 0, for v ≥ 0,
//!
//! * μ̄(v) = ∫₀^∞ c(u) [φ(u − v) − φ(u + v)] du, where the bracket is φ(u − v)(1 − e^{−2uv/σ²}), free of cancellation;
//! * μ̄′(v) = 2c(0)φ(v) + ∫₀^∞ c′(u) [φ(u − v) + φ(u + v)] du.
//!
//! The average is smooth: where a sine has a corner at α = v₀, a Gaussian velocity has no largest value, and dither acts a little
//! at every amplitude. This is statistical linearisation with its bias and its gain for one random input (Gelb and Vander Velde,
//! *Multiple-Input Describing Functions and Nonlinear System Design*, 1968, chapter 7).
//!
//! Closed forms, with x = v/σ and Φ the distribution function: constant μ_d, μ_d erf(x/√2); odd powers of v have the moments of a
//! Gaussian, ⟨(v − w)³⟩ = v³ + 3vσ²; an exponential fall e^{−u/v_m}, by erfc with the argument (σ/v_m ∓ x)/√2; a Gaussian fall
//! e^{−(u/v_s)²}, by the product of two Gaussians, A erf(m/(τ√2)). Other laws by quadrature over ±`REACH` σ, 10⁻¹² of μ.
//!
//! Of n lines with fixed phases the velocity is Gaussian only as n grows: the mean over the lines differs by up to 0.07/n of a
//! jump of friction, the first term of an Edgeworth series with the excess kurtosis −3/(2n).

use core::f64::consts::{PI, SQRT_2};

use quell_model::Friction;
use quell_model::friction::{LawParameters, SlidingLaw};
use quell_numerics::quadrature::{QuadratureOptions, integrate};
use quell_numerics::special::{erf, erfc, erfcx, exp, expm1};

use super::effective::{Effective, SlopeSide};
use super::error::{AveragingError, settled};

/// Standard deviations over which quadrature extends: beyond, the density is below 10⁻¹⁸ of its maximum.
const REACH: f64 = 9.2;

/// Exponent of an exponential fall with a Gaussian decay in the speed.
const GAUSSIAN_FALL: f64 = 2.0;

/// Effective friction at slip velocity v (any sign) under a Gaussian fast velocity of standard deviation σ > 0: the closed form of
/// the law, otherwise quadrature.
pub(super) fn effective(
    law: &Friction,
    deviation: f64,
    v: f64,
) -> Result<Effective, AveragingError> {
    let speed = v.abs();
    let terms = closed_terms(law);
    let found = match terms {
        Some(terms) => sum_of(&terms, deviation, speed),
        None => by_quadrature(law, deviation, speed)?,
    };
    Ok(if v < 0.0 { found.mirrored() } else { found })
}

/// The same by quadrature for any law: a second method to check the closed forms.
///
/// # Errors
/// A quadrature that did not converge.
pub fn effective_under_noise_by_quadrature(
    law: &Friction,
    deviation: f64,
    v: f64,
) -> Result<Effective, AveragingError> {
    let found = by_quadrature(law, deviation, v.abs())?;
    Ok(if v < 0.0 { found.mirrored() } else { found })
}

/// A part of a law with a closed form of its mean, odd in the slip velocity.
enum LawTerm {
    /// a sgn v.
    Constant(f64),
    /// b v.
    Linear(f64),
    /// d v³.
    Cubic(f64),
    /// a e^{−|v|/v_m} sgn v: (a, v_m).
    Exponential(f64, f64),
    /// a e^{−(v/v_s)²} sgn v: (a, v_s).
    GaussianFall(f64, f64),
}

/// The parts of a law whose mean has a closed form.
fn closed_terms(law: &Friction) -> Option<Vec<LawTerm>> {
    use LawTerm::{Constant, Cubic, Exponential, GaussianFall, Linear};
    match law {
        Friction::Stribeck(law) => {
            let (level, scale) = (law.static_coefficient(), law.reference_velocity());
            let fall = 1.5 * (level - law.minimum_coefficient()) / scale;
            Some(vec![Constant(level), Linear(-fall), Cubic(fall / (3.0 * scale * scale))])
        }
        Friction::Decreasing(law) => {
            let least = law.minimum_coefficient();
            let excess = law.static_coefficient() - least;
            Some(vec![Constant(least), Exponential(excess, law.reference_velocity())])
        }
        Friction::Coulomb(law) => match law.values().as_slice() {
            [level, _, viscous] => Some(vec![Constant(*level), Linear(*viscous)]),
            _ => None,
        },
        Friction::StribeckExponential(law) => match law.values().as_slice() {
            [level, at_rest, scale, exponent, viscous] => {
                let excess = at_rest - level;
                let fall = if *exponent == GAUSSIAN_FALL {
                    GaussianFall(excess, *scale)
                } else if *exponent == 1.0 {
                    Exponential(excess, *scale)
                } else {
                    return None;
                };
                Some(vec![Constant(*level), Linear(*viscous), fall])
            }
            _ => None,
        },
        _ => None,
    }
}

/// φ(v) of a standard deviation.
fn density(deviation: f64, v: f64) -> f64 {
    let x = v / deviation;
    exp(-0.5 * x * x) / (deviation * (2.0 * PI).sqrt())
}

fn sum_of(terms: &[LawTerm], deviation: f64, v: f64) -> Effective {
    let (mut value, mut slope, mut size, mut steepness) = (0.0, 0.0, 0.0, 0.0);
    for term in terms {
        let mean = term.mean(deviation, v);
        value += mean[0];
        slope += mean[1];
        size += mean[2];
        steepness += mean[3];
    }
    let mut found = Effective::closed([value, 0.0], [slope, 0.0], steepness, SlopeSide::Both);
    // Two exponentials that cancel at small v have their own size.
    found.coefficient_error += 16.0 * f64::EPSILON * size;
    found
}

impl LawTerm {
    /// Mean and slope, and the magnitudes of the parts of which each is the sum.
    fn mean(&self, deviation: f64, v: f64) -> [f64; 4] {
        let x = v / deviation;
        let at = density(deviation, v);
        let sized = |value: f64, slope: f64| [value, slope, value.abs(), slope.abs()];
        match *self {
            Self::Constant(a) => sized(a * erf(x / SQRT_2), 2.0 * a * at),
            Self::Linear(b) => sized(b * v, b),
            Self::Cubic(d) => {
                let square = deviation * deviation;
                sized(d * v * (v * v + 3.0 * square), 3.0 * d * (v * v + square))
            }
            Self::Exponential(a, scale) => {
                let ratio = deviation / scale;
                let [with, against] = exponential_parts(ratio, x);
                let (jump, fall) = (2.0 * a * at, a / scale * (with + against));
                let size = a.abs() * (with + against);
                [a * (with - against), jump - fall, size, jump.abs() + fall.abs()]
            }
            Self::GaussianFall(a, scale) => {
                // e^{−(u/v_s)²} has the variance s² = v_s²/2.
                let (own, square) = (0.5 * scale * scale, deviation * deviation);
                let total = own + square;
                let weight = (own / total).sqrt() * exp(-0.5 * v * v / total);
                let (middle, spread) = (v * own / total, (own * square / total).sqrt());
                let y = middle / (spread * SQRT_2);
                let sign = erf(y);
                let edge = 2.0 / PI.sqrt() * exp(-y * y) * own / (total * spread * SQRT_2);
                let (rise, fall) = (a * weight * edge, a * weight * sign * v / total);
                let value = a * weight * sign;
                [value, rise - fall, value.abs(), rise.abs() + fall.abs()]
            }
        }
    }
}

/// ∫₀^∞ e^{−u/v_m} φ(u ∓ v) du for a = σ/v_m and x = v/σ: ½e^{a²/2 ∓ ax} erfc((a ∓ x)/√2).
fn exponential_parts(a: f64, x: f64) -> [f64; 2] {
    let scaled = |argument: f64| 0.5 * exp(-0.5 * x * x) * erfcx(argument / SQRT_2);
    let with =
        if x > a { 0.5 * exp(-a * (x - 0.5 * a)) * erfc((a - x) / SQRT_2) } else { scaled(a - x) };
    [with, scaled(a + x)]
}

/// Effective friction by quadrature at slip velocity `v` ≥ 0.
fn by_quadrature(law: &Friction, deviation: f64, v: f64) -> Result<Effective, AveragingError> {
    let (from, to) = ((v - REACH * deviation).max(0.0), v + REACH * deviation);
    let mut cuts = vec![v];
    for k in [1.0, 3.0, 6.0] {
        cuts.extend([v - k * deviation, v + k * deviation]);
    }
    cuts.extend([0.05, 0.3, 1.0, 3.0, 6.0, 36.0].map(|w| w * law.velocity_scale()));
    cuts.retain(|cut| *cut > from && *cut < to);
    let variance = deviation * deviation;
    let value = |u: f64| {
        let against = -expm1(-2.0 * u * v / variance);
        law.coefficient(u) * density(deviation, u - v) * against
    };
    let slope = |u: f64| {
        let both = 1.0 + exp(-2.0 * u * v / variance);
        law.slope(u) * density(deviation, u - v) * both
    };
    let options = QuadratureOptions { relative: 1e-13, ..QuadratureOptions::default() };
    let mean = settled(integrate(value, from, to, &cuts, &options))?;
    let jump = 2.0 * law.coefficient(0.0) * density(deviation, v);
    let at_rest = law.slope(0.0).abs();
    // An unbounded slope at rest is a singularity at the end of the range, resolved as far as its location is.
    let (at_rest, relative) = if at_rest.is_finite() { (at_rest, 1e-13) } else { (0.0, 1e-6) };
    let scale = at_rest + law.slope(v.max(deviation)).abs() + jump;
    let options = QuadratureOptions { relative, absolute: relative * scale, ..options };
    let smooth = settled(integrate(slope, from, to, &cuts, &options))?;
    let mut found =
        Effective::closed([mean.value, 0.0], [jump, smooth.value], scale, SlopeSide::Both);
    found.coefficient_error += mean.error;
    found.slope_error += smooth.error;
    Ok(found)
}
