//! Any law under one dither of any shape: the closed form of the law where one exists, otherwise quadrature over a quarter wave,
//! or over the whole period of a shape without symmetry.
//!
//! With s = ασ(δ) odd in δ and c(u) the sliding coefficient at speed u ≥ 0,
//! μ̄(v) = (1/π) ∫₀^{π/2} [μ(v + ασ) + μ(v − ασ)] dδ for v ≥ 0, split where ασ = v:
//!
//! * ασ < v: c(v + ασ) + c(v − ασ), a positive sum over an interval whose length is known to relative accuracy;
//! * ασ > v: c(ασ + v) − c(ασ − v); for v ≪ v_m the difference is computed as the integral of the slope, with five Gauss points.
//!
//! μ̄′(v) = 2c(0)ρ + (1/π) ∫ [c′(v + ασ) + c′(|v − ασ|)] dδ with the density ρ = 1/(πασ′) at the crossing.
//! The relative accuracy therefore holds for v → 0 too. The law is assumed to be smooth for u > 0 on the scale v_m.

use core::f64::consts::{FRAC_2_PI, FRAC_PI_2, PI};
use std::sync::LazyLock;

use quell_model::Friction;
use quell_numerics::gauss_legendre::GaussLegendre;
use quell_numerics::quadrature::{QuadratureOptions, integrate};

use super::effective::{Effective, SlopeSide};
use super::error::{AveragingError, settled};
use super::periodic_motion::{PeriodicMotion, SlipTerm};
use super::wave::FastWave;
use super::{decreasing, periodic, stribeck};

/// Nodes and weights on [0, 1] for the mean slope.
static RULE: LazyLock<[[f64; 5]; 2]> = LazyLock::new(|| GaussLegendre::new(5).on_unit_interval());

/// Below this fraction of v_m the difference of two coefficients is computed by integrating the slope.
const SMALL_SLIP: f64 = 0.05;

/// Effective friction without dither: the law itself.
pub(super) fn undithered(law: &Friction, v: f64) -> Result<Effective, AveragingError> {
    if v == 0.0 {
        return Err(AveragingError::SetValued { static_coefficient: law.static_coefficient() });
    }
    let speed = v.abs();
    let coefficient = law.coefficient(speed).copysign(v);
    let slope = law.slope(speed);
    let size = law.slope(0.0).abs() + slope.abs();
    Ok(Effective::closed([coefficient, 0.0], [slope, 0.0], size, SlopeSide::Both))
}

/// Effective friction under one dither, `amplitude` ≠ 0: the closed form where one exists, otherwise quadrature over a quarter
/// wave.
pub(super) fn effective(
    law: &Friction,
    wave: &FastWave,
    amplitude: f64,
    v: f64,
) -> Result<Effective, AveragingError> {
    if !wave.is_symmetric() {
        return whole_period(law, wave, amplitude, v);
    }
    let (wave, factor) = wave.clone().canonical();
    // s and −s have the same distribution.
    let alpha = amplitude.abs() * factor;
    let speed = v.abs();
    let effective = match (law, wave) {
        (Friction::Stribeck(law), FastWave::Integral(waveform)) => {
            stribeck::effective(law, &waveform, alpha, speed)
        }
        (Friction::Decreasing(law), FastWave::Integral(waveform)) => {
            decreasing::effective(law, &waveform, alpha, speed)?
        }
        (law, wave) => quarter_wave(law, &wave, alpha, speed)?,
    };
    Ok(if v < 0.0 { effective.mirrored() } else { effective })
}

/// The same by quadrature for any law: a second method to check the closed forms.
///
/// # Errors
/// A quadrature that did not converge.
pub fn effective_by_quadrature(
    law: &Friction,
    wave: &FastWave,
    amplitude: f64,
    v: f64,
) -> Result<Effective, AveragingError> {
    if amplitude == 0.0 {
        return undithered(law, v);
    }
    if !wave.is_symmetric() {
        return whole_period(law, wave, amplitude, v);
    }
    let effective = quarter_wave(law, wave, amplitude.abs(), v.abs())?;
    Ok(if v < 0.0 { effective.mirrored() } else { effective })
}

/// Effective friction under a shape without symmetry: quadrature over its whole period.
fn whole_period(
    law: &Friction,
    wave: &FastWave,
    amplitude: f64,
    v: f64,
) -> Result<Effective, AveragingError> {
    let harmonic = wave.cycles();
    let term = SlipTerm { wave: wave.clone(), amplitude, harmonic, phase: 0.0 };
    let group = PeriodicMotion { tangential: vec![term], ..PeriodicMotion::default() };
    periodic::effective(law, &group, v)
}

/// Effective friction by quadrature at slip velocity `v` ≥ 0 under s = α·wave, α > 0.
fn quarter_wave(
    law: &Friction,
    wave: &FastWave,
    alpha: f64,
    v: f64,
) -> Result<Effective, AveragingError> {
    let corner = alpha * wave.peak();
    let vm = law.velocity_scale();
    let outside = v >= corner;
    let (delta, density) = if outside {
        (FRAC_PI_2, 0.0)
    } else {
        let (delta, steepness) = wave.crossing(alpha, v);
        (delta, FRAC_2_PI / steepness)
    };
    let mut cuts = vec![delta];
    for offset in [-36.0, -6.0, -1.0, 1.0, 6.0, 36.0] {
        let value = v + offset * vm;
        if value > 0.0 && value < corner {
            cuts.push(wave.crossing(alpha, value).0);
        }
    }
    let pair = |x: f64| {
        let s = alpha * wave.quarter(x);
        if outside || x < delta {
            law.coefficient(v + s) + law.coefficient((v - s).max(0.0))
        } else if v < SMALL_SLIP * vm && s > 2.0 * v {
            2.0 * v * mean_slope(law, s, v)
        } else {
            law.coefficient(s + v) - law.coefficient((s - v).max(0.0))
        }
    };
    let slopes = |x: f64| {
        let s = alpha * wave.quarter(x);
        law.slope(v + s) + law.slope((v - s).abs())
    };
    // The near and the far part of the value may cancel, so each is integrated to its own accuracy.
    let options = QuadratureOptions { relative: 1e-13, ..QuadratureOptions::default() };
    let near = settled(integrate(pair, 0.0, delta, &cuts, &options))?;
    let far = if outside {
        0.0
    } else {
        let floor = QuadratureOptions { absolute: 1e-14 * near.value.abs(), ..options };
        settled(integrate(pair, delta, FRAC_PI_2, &cuts, &floor))?.value
    };
    // A slope that crosses zero is accurate relative to the slopes of the law.
    let at_rest = law.slope(0.0).abs();
    // Where the slope at rest is unbounded, as for a power below 1, the integrand has an endpoint singularity at the crossing.
    // Bisection towards it stops at the resolution of its location, and the error estimate includes that.
    let (at_rest, relative) = if at_rest.is_finite() { (at_rest, 1e-13) } else { (0.0, 1e-6) };
    let scale = at_rest + law.slope(v).abs() + PI * law.coefficient(0.0) * density;
    let options = QuadratureOptions { relative, absolute: relative * scale, ..options };
    let smooth = settled(integrate(slopes, 0.0, FRAC_PI_2, &cuts, &options))?;
    let side = if v == corner { SlopeSide::Outer } else { SlopeSide::Both };
    let mut effective = Effective::closed(
        [near.value / PI, far / PI],
        [law.coefficient(0.0) * density, smooth.value / PI],
        scale,
        side,
    );
    effective.coefficient_error += near.error / PI + 1e-13 * far.abs();
    effective.slope_error += smooth.error / PI;
    Ok(effective)
}

/// Mean slope of the law over the speeds s − v … s + v.
fn mean_slope(law: &Friction, s: f64, v: f64) -> f64 {
    let [nodes, weights] = &*RULE;
    let slope = |node: &f64| law.slope((2.0 * v).mul_add(*node, s - v));
    nodes.iter().zip(weights).map(|(node, weight)| weight * slope(node)).sum()
}
