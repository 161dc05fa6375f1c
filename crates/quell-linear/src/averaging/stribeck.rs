//! Stribeck law under one dither: closed forms of the effective friction and its slope.
//!
//! Law (2.7) is a₀ sgn v + a₁v + a₃v³ with a₀ = μ_s, a₁ = −3(μ_s − μ_m)/(2v_m), a₃ = (μ_s − μ_m)/(2v_m³).
//! Averaging over s = αG, whose odd moments vanish, gives (3.29)–(3.31):
//!
//! * |v| < αG_max: a₀⟨sgn⟩ + (a₁ + 3a₃α²⟨G²⟩)v + a₃v³ with ⟨sgn⟩ = (2/π) arcsin(v/α) for a sine,
//!   1 − √(1 − 4v/(πα)) for a triangle, 2v/(πα) for a square;
//! * |v| ≥ αG_max: μ(v) + 3a₃α²⟨G²⟩v.
//!
//! 3⟨G²⟩ is 3/2, π²/10 and π²/4. The dissertation prints π²/16 for the triangle in (3.45a) and (3.45b), and
//! (3.46)–(3.48) inherit the wrong constant. ⟨sgn⟩ is evaluated without cancellation for v ≪ α.

use quell_model::Waveform;
use quell_model::friction::{SlidingLaw, Stribeck};

use super::effective::{Effective, SlopeSide};
use super::wave::FastWave;

/// Effective friction at slip velocity `v` ≥ 0 under s = αG, α > 0.
pub(super) fn effective(law: &Stribeck, waveform: &Waveform, alpha: f64, v: f64) -> Effective {
    let difference = law.static_coefficient() - law.minimum_coefficient();
    let vm = law.reference_velocity();
    let (w, ratio) = (v / vm, alpha / vm);
    let moment = ratio * ratio * waveform.mean_square_integral();
    // −(3/2)Δ (w − w³/3 − ⟨G²⟩(α/v_m)² w) and its derivative.
    let linear = -1.5 * difference * w * (1.0 - w * w / 3.0 - moment);
    let smooth_slope = -1.5 * difference / vm * ((1.0 - w) * (1.0 + w) - moment);
    let slope_size = 1.5 * difference / vm * (1.0 + w * w + moment);
    let corner = alpha * waveform.peak_integral();
    if v >= corner {
        let side = if v == corner { SlopeSide::Outer } else { SlopeSide::Both };
        return Effective::closed(
            [law.static_coefficient(), linear],
            [smooth_slope, 0.0],
            slope_size,
            side,
        );
    }
    let wave = FastWave::Integral(waveform.clone());
    let (delta, steepness) = wave.crossing(alpha, v);
    // ⟨sgn⟩ = δ/(π/2), its slope 2ρ = 2/(π ds/dδ).
    let sign = core::f64::consts::FRAC_2_PI * delta;
    let density = core::f64::consts::FRAC_2_PI / steepness;
    Effective::closed(
        [law.static_coefficient() * sign, linear],
        [law.static_coefficient() * density, smooth_slope],
        slope_size,
        SlopeSide::Both,
    )
}
