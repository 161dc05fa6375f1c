//! Formulas as printed in the dissertation, for comparison with the correct ones. Where a formula here is wrong, its
//! documentation says how; the correct formula is in `quell_linear::averaging`.

use std::f64::consts::{FRAC_2_SQRT_PI, PI};

use quell_numerics::special::{dawson, erf, exp};

/// Numbers of a law: μ_s, μ_m, v_m.
#[derive(Clone, Copy, Debug)]
pub(super) struct LawNumbers {
    pub(super) static_level: f64,
    pub(super) minimum: f64,
    pub(super) vm: f64,
}

impl LawNumbers {
    /// Those of the dissertation: 0.4, 0.2857, 0.2.
    pub(super) const DISSERTATION: Self = Self { static_level: 0.4, minimum: 0.2857, vm: 0.2 };

    /// μ_s − μ_m.
    pub(super) fn difference(self) -> f64 {
        self.static_level - self.minimum
    }

    /// κ = 4v_mζ/(3F(μ_s − μ_m)), F = 1.
    pub(super) fn kappa(self, damping_ratio: f64) -> f64 {
        4.0 * self.vm * damping_ratio / (3.0 * self.difference())
    }
}

/// erfi(x) = −i erf(ix).
pub(super) fn erfi(x: f64) -> f64 {
    FRAC_2_SQRT_PI * exp(x * x) * dawson(x)
}

/// (3.38a): effective friction, decreasing law, triangle, 0 ≤ v_r ≤ πα/4. Wrong: the factor of the error functions is e^{γ−w},
/// not e^{−w−γ}.
pub(super) fn effective_338a(law: LawNumbers, v: f64, alpha: f64) -> f64 {
    let (gamma, w) = (PI * alpha / (4.0 * law.vm), v / law.vm);
    let inner = (gamma - w).max(0.0).sqrt();
    let root = gamma.sqrt();
    let half = 0.5 * law.difference() * (law.vm / alpha).sqrt();
    law.minimum * (1.0 - (1.0 - w / gamma).max(0.0).sqrt())
        + half * exp(-w - gamma) * (erf(root) - erf(inner) + erfi(root))
        - half * exp(w - gamma) * erfi(inner)
}

/// (3.39a): effective friction, decreasing law, square, |v_r| ≤ πα/2. Correct, and odd in v_r by itself.
pub(super) fn effective_339a(law: LawNumbers, v: f64, alpha: f64) -> f64 {
    let decay = exp(-PI * alpha / (2.0 * law.vm));
    2.0 * law.minimum / (PI * alpha) * v
        + 2.0 * law.difference() / PI * law.vm / alpha * decay * libm::sinh(v / law.vm)
}

/// (3.53a): slope of (3.38a). Wrong: exponent +1/2 instead of −1/2, a missing factor 1/(2√(γ−w)), and (3.38a) itself.
pub(super) fn slope_353a(law: LawNumbers, v: f64, alpha: f64) -> f64 {
    let (gamma, w) = (PI * alpha / (4.0 * law.vm), v / law.vm);
    let (root, inner) = (gamma.sqrt(), (gamma - w).sqrt());
    let b1 = law.difference();
    let half = b1 / (2.0 * (law.vm * alpha).sqrt());
    2.0 * law.minimum / (PI * alpha) * (1.0 - w / gamma).sqrt()
        + b1 / (PI * law.vm * alpha).sqrt() * (1.0 + exp(-2.0 * gamma))
        - half * exp(w - gamma) * erfi(inner)
        + half * exp(-w - gamma) * erf(inner)
        - half * exp(-w - gamma) * (erf(root) + erfi(root))
}

/// (3.45a): slope of the effective Stribeck friction, triangle, inside. Wrong: π²/16 instead of π²/10.
pub(super) fn slope_345a(law: LawNumbers, v: f64, alpha: f64) -> f64 {
    let [a1, a3] = cubic(law);
    2.0 * law.static_level / ((alpha * PI).sqrt() * (PI * alpha - 4.0 * v).sqrt())
        + a1
        + PI * PI / 16.0 * a3 * alpha * alpha
        + 3.0 * a3 * v * v
}

/// (3.45b): the same outside. Wrong: π²/16 instead of π²/10.
pub(super) fn slope_345b(law: LawNumbers, v: f64, alpha: f64) -> f64 {
    let [_, a3] = cubic(law);
    3.0 * a3 * (v * v - law.vm * law.vm) + PI * PI / 16.0 * a3 * alpha * alpha
}

/// a₁ and a₃ of the Stribeck law.
fn cubic(law: LawNumbers) -> [f64; 2] {
    [-1.5 * law.difference() / law.vm, 0.5 * law.difference() / law.vm.powi(3)]
}

/// (3.47), (4.35): upper edge of the unstable belt velocities, Stribeck law, triangle. Wrong: π²/48 instead of π²/30.
pub(super) fn upper_edge_347(law: LawNumbers, damping_ratio: f64, alpha: f64) -> f64 {
    let square = 1.0 - PI * PI / 48.0 * (alpha / law.vm).powi(2) - law.kappa(damping_ratio);
    law.vm * square.max(0.0).sqrt()
}

/// (3.44), (4.34): α^L, Stribeck law, sine (times μ(v₀) for normal dither), v_m√(2/3)√(1 − κ). Correct.
pub(super) fn everywhere_344(law: LawNumbers, damping_ratio: f64) -> f64 {
    law.vm * (2.0f64 / 3.0).sqrt() * (1.0 - law.kappa(damping_ratio)).sqrt()
}

/// The same in the optical reading of the print, with the second root inside the first: v_m√((2/3)√(1 − κ)). Wrong; a brace was
/// probably lost in the reading.
pub(super) fn everywhere_344_read(law: LawNumbers, damping_ratio: f64) -> f64 {
    law.vm * (2.0 / 3.0 * (1.0 - law.kappa(damping_ratio)).sqrt()).sqrt()
}

/// (3.48), (4.36), (4.38): α^L, Stribeck law, triangle (times μ(v₀) for normal dither). Wrong for a triangle, where α^L is
/// (v_m/π)√(240(1 − κ)/23). (4.38) prints it for the square, where it is too large by a factor of two.
pub(super) fn everywhere_348(law: LawNumbers, damping_ratio: f64) -> f64 {
    2.0 / PI * law.vm * (3.0 - 4.0 * law.vm * damping_ratio / law.difference()).sqrt()
}

/// (3.52): α^L, Stribeck law, square. Correct.
pub(super) fn everywhere_352(law: LawNumbers, damping_ratio: f64) -> f64 {
    law.vm / PI * (3.0 - 4.0 * law.vm * damping_ratio / law.difference()).sqrt()
}

/// (B.3), the last line as printed. Wrong: prefactor exp((v_r − πα/v_m)/v_m) instead of exp(v_r/v_m − πα/(4v_m)).
pub(super) fn integral_b3(law: LawNumbers, v: f64, alpha: f64) -> f64 {
    exp((v - alpha * PI / law.vm) / law.vm) * first_integral(law, v, alpha)
}

/// (B.5), the last line as printed. Wrong: prefactor exp(v_r/v_m − πα/4).
pub(super) fn integral_b5(law: LawNumbers, v: f64, alpha: f64) -> f64 {
    exp(v / law.vm - PI * alpha / 4.0) * first_integral(law, v, alpha)
}

/// The factor after the prefactors of (B.3) and (B.5).
fn first_integral(law: LawNumbers, v: f64, alpha: f64) -> f64 {
    0.5 * PI * (law.vm / alpha).sqrt() * erfi((PI * alpha / (4.0 * law.vm) - v / law.vm).sqrt())
}

/// (B.4), the last line as printed. Wrong in the same way as (3.38a).
pub(super) fn integral_b4(law: LawNumbers, v: f64, alpha: f64) -> f64 {
    let (gamma, w) = (PI * alpha / (4.0 * law.vm), v / law.vm);
    PI * (law.vm / alpha).sqrt()
        * exp(-w - gamma)
        * (erf(gamma.sqrt()) - erf((gamma - w).sqrt()) + erfi(gamma.sqrt()))
}
