//! Decreasing law under one dither: closed forms of the effective friction and its slope.
//!
//! Law (2.8) is sgn v (b₀ + b₁e^{−|v|}) with b₀ = μ_m, b₁ = μ_s − μ_m and velocities in units of v_m: w = v/v_m, a = α/v_m,
//! c = aG_max. Outside (w ≥ c): b₀ + b₁e^{−w}m(a), m = ⟨e^{aG}⟩, evaluated as e^{−(w−c)} [e^{−c}m]:
//!
//! * sine (3.37): e^{−a} I₀(a);
//! * triangle (3.38b), γ = πa/4: (1/(2√a)) [erf √γ + (2/√π) e^{−γ} F(√γ)], F Dawson's integral;
//! * square (3.39b): (1 − e^{−2c})/(2c).
//!
//! Inside (w < c) the jump is separated, μ = (b₀+b₁) sgn − b₁ sgn (1 − e^{−|·|}), so that every part is positive:
//! μ̄ = (b₀+b₁)⟨sgn⟩ − b₁K, μ̄′ = 2(b₀+b₁)ρ − (b₁/v_m)J with J(w) = ⟨e^{−|w−s|}⟩ and K = ∫₀ʷ J.
//!
//! * sine: no closed form; both means are integrated over one quarter wave by adaptive quadrature, split where s = w;
//! * triangle, t₀ = √(γ−w): J = (1/(2√γ)) {e^{−w}F(√γ) + F(t₀) + (√π/2)[erfcx t₀ − e^{−w}erfcx √γ]}; ⟨sgn⟩ − K is the same with
//!   −F(t₀). For w ≤ 1 that difference suffers cancellation and K is integrated instead, as ∫ 2tJ dt over t from t₀ to √γ. Its
//!   integrand is entire: 16 Gauss points reach rounding error. The printed (3.38a) = (B.10a) has the factor e^{−w−γ} instead of
//!   e^{γ−w} before the error functions and is wrong by up to 21 %; (3.53a) inherits the error;
//! * square (3.39a), (3.57a): sums of positive terms as printed, e^{−c} sinh w and e^{−c} cosh w in scaled form.

use core::f64::consts::{FRAC_2_PI, FRAC_2_SQRT_PI, FRAC_PI_2, PI};
use std::sync::LazyLock;

use quell_model::Waveform;
use quell_model::friction::{Decreasing, SlidingLaw};
use quell_numerics::gauss_legendre::GaussLegendre;
use quell_numerics::quadrature::{Integral, QuadratureOptions, integrate};
use quell_numerics::special::{bessel_i0_scaled, dawson, erf, erfcx, exp, expm1, expm1_over};

use super::effective::{Effective, SlopeSide};
use super::error::{AveragingError, settled};
use super::wave::FastWave;

/// Nodes and weights on [0, 1].
static RULE: LazyLock<[[f64; 16]; 2]> = LazyLock::new(|| GaussLegendre::new(16).on_unit_interval());

/// √π/2.
const HALF_SQRT_PI: f64 = 1.0 / FRAC_2_SQRT_PI;

/// Effective friction at slip velocity `v` ≥ 0 under s = αG, α > 0.
pub(super) fn effective(
    law: &Decreasing,
    waveform: &Waveform,
    alpha: f64,
    v: f64,
) -> Result<Effective, AveragingError> {
    let vm = law.reference_velocity();
    let b0 = law.minimum_coefficient();
    let b1 = law.static_coefficient() - b0;
    let corner = alpha * waveform.peak_integral();
    let a = alpha / vm;
    if v >= corner {
        let side = if v == corner { SlopeSide::Outer } else { SlopeSide::Both };
        let tail = b1 * exp(-((v - corner) / vm)) * scaled_mean_exponential(waveform, a)?;
        return Ok(Effective::closed([b0, tail], [-tail / vm, 0.0], tail / vm, side));
    }
    let (w, below) = (v / vm, (corner - v) / vm);
    let wave = FastWave::Integral(waveform.clone());
    let (delta, steepness) = wave.crossing(alpha, v);
    let sign = FRAC_2_PI * delta;
    let density = FRAC_2_PI / steepness;
    match waveform {
        Waveform::Square => {
            // Terms are positive: b₁ v_m/α · (2/π) e^{−c} sinh w and its derivative.
            let near = exp(-below);
            let sinh = 0.5 * near * -expm1(-2.0 * w);
            let cosh = 0.5 * near * (1.0 + exp(-2.0 * w));
            let slope = b1 * density * cosh;
            Ok(Effective::closed(
                [b0 * sign, b1 * FRAC_2_PI / a * sinh],
                [b0 * density, slope],
                slope,
                SlopeSide::Both,
            ))
        }
        Waveform::Triangle => {
            let (value, mean) = triangle(corner / vm, w, below, sign);
            Ok(Effective::closed(
                [b0 * sign, b1 * value],
                [(b0 + b1) * density, -b1 / vm * mean],
                b1 / vm * mean,
                SlopeSide::Both,
            ))
        }
        _ => {
            let (k, j) = sine(a, w, delta)?;
            let jump = b0 + b1;
            let mut effective = Effective::closed(
                [jump * sign, -b1 * k.value],
                [jump * density, -b1 / vm * j.value],
                b1 / vm * j.value,
                SlopeSide::Both,
            );
            effective.coefficient_error += b1 * k.error;
            effective.slope_error += b1 / vm * j.error;
            Ok(effective)
        }
    }
}

/// e^{−aG_max} m(a), m = ⟨e^{aG}⟩, for a = α/v_m ≥ 0: 1 at a = 0, falling to 0 like a^{−1/2} (square: a^{−1}).
pub(super) fn scaled_mean_exponential(waveform: &Waveform, a: f64) -> Result<f64, AveragingError> {
    if a == 0.0 {
        return Ok(1.0);
    }
    Ok(match waveform {
        Waveform::Sine => bessel_i0_scaled(a),
        Waveform::Triangle => {
            let gamma = a * waveform.peak_integral();
            let root = gamma.sqrt();
            let second = FRAC_2_SQRT_PI * exp(-gamma) * dawson(root);
            (erf(root) + second) / (2.0 * a.sqrt())
        }
        Waveform::Square => expm1_over(-PI * a),
        other => {
            let (period, peak) = (other.period(), other.integral_range().upper);
            let decay = |phase: f64| exp(a * (other.integral(phase) - peak));
            let options = QuadratureOptions { relative: 1e-13, ..QuadratureOptions::default() };
            settled(integrate(decay, 0.0, period, other.breaks(), &options))?.value / period
        }
    })
}

/// ⟨sgn·e^{−|·|}⟩ and J for the triangle inside; `gamma` = πa/4, `below` = γ − w, `sign` = ⟨sgn⟩.
fn triangle(gamma: f64, w: f64, below: f64, sign: f64) -> (f64, f64) {
    let (root, t0) = (gamma.sqrt(), below.sqrt());
    let (far, edge) = (dawson(root), HALF_SQRT_PI * erfcx(root));
    let decay = exp(-w);
    // J(γ − t²), entire in t.
    let mean = |t: f64, decay: f64| {
        (decay * (far - edge) + dawson(t) + HALF_SQRT_PI * erfcx(t)) / (2.0 * root)
    };
    let value = if w <= 1.0 {
        // √γ − t₀ without cancellation.
        let length = w / (root + t0);
        let [nodes, weights] = &*RULE;
        let integral: f64 = nodes
            .iter()
            .zip(weights)
            .map(|(x, weight)| {
                let t = t0 + length * x;
                // w − (t² − t₀²), the slip at t.
                let slip = (1.0 - x) * length * (root + t);
                weight * 2.0 * t * mean(t, exp(-slip))
            })
            .sum();
        sign - length * integral
    } else {
        (decay * (far - edge) + HALF_SQRT_PI * erfcx(t0) - dawson(t0)) / (2.0 * root)
    };
    (value, mean(t0, decay))
}

/// K and J for the sine inside, by quadrature over a quarter wave; s = w at `delta`.
fn sine(a: f64, w: f64, delta: f64) -> Result<(Integral, Integral), AveragingError> {
    let options = QuadratureOptions { relative: 1e-13, ..QuadratureOptions::default() };
    // The exponentials are concentrated within a few units of s = w. Splitting there avoids a narrow peak at large a.
    let mut cuts = vec![delta];
    for offset in [-36.0, -6.0, 6.0, 36.0] {
        let s = (w + offset) / a;
        if s > 0.0 && s < 1.0 {
            cuts.push(libm::asin(s));
        }
    }
    let k = |x: f64| {
        let c = a * libm::sin(x);
        if x < delta {
            -expm1(-(w + c)) - expm1(-(w - c))
        } else {
            -exp(-(c - w)) * expm1(-2.0 * w)
        }
    };
    let j = |x: f64| {
        let c = a * libm::sin(x);
        exp(-(w + c)) + exp(-(w - c).abs())
    };
    let scaled = |i: Integral| Integral { value: i.value / PI, error: i.error / PI, ..i };
    let k = settled(integrate(k, 0.0, FRAC_PI_2, &cuts, &options))?;
    let j = settled(integrate(j, 0.0, FRAC_PI_2, &cuts, &options))?;
    Ok((scaled(k), scaled(j)))
}
