//! The slow system of two wave amplitudes: its growth rate and the detunings between which it grows, in closed form.
//!
//! ```text
//! [ D₁     c₁₂    ]
//! [ c₂₁    D₂ − iδ ]      D = −η + is,   C = c₁₂c₂₁,   δ: detuning
//! ```
//!
//! The characteristic polynomial λ² + (a + ib)λ + (c + id) has both roots in the left half-plane iff a > 0 and a²c + abd − d² > 0
//! (Hurwitz criterion for complex coefficients). a does not depend on δ, and b, c, d are linear in it, so the second condition is
//! a quadratic in δ with the leading coefficient η₁η₂. Hence, with both waves damped, the system is unstable between two roots.
//!
//! λ = (D₁ + D₂ − iδ)/2 ± √(y² + C), y = (D₁ − D₂ + iδ)/2: Re √ is stationary where y² is a real multiple of C, a quadratic
//! in Im y.

use num_complex::Complex64;
use quell_numerics::polar::square_root;
use quell_numerics::roots::quadratic;

/// The slow system of a pair of waves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct WavePair {
    pub(super) first: Complex64,
    pub(super) second: Complex64,
    pub(super) product: Complex64,
}

/// Detunings at which a pair grows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum DetuningBand {
    /// No detuning.
    Nowhere,
    /// The detunings between these two.
    Between(f64, f64),
    /// Detunings far from the resonance too: one of the waves is unstable or undamped by itself.
    Outside,
}

/// Relative size below which a discriminant is rounding noise: there the tongues of an undamped disc end in a point.
const ROUNDING: f64 = 1e-13;

impl WavePair {
    /// Larger real part of the two exponents at the detuning δ.
    pub(super) fn growth(&self, detuning: f64) -> f64 {
        let shift = Complex64::new(0.0, detuning);
        let half = 0.5 * (self.first - self.second + shift);
        let root = square_root(half * half + self.product);
        0.5 * (self.first.re + self.second.re) + root.re.abs()
    }

    /// Coefficients of the quadratic in δ that is positive where the pair is stable.
    fn hurwitz(&self) -> [f64; 3] {
        let (first, second) = (self.first, self.second);
        let a = -(first.re + second.re);
        let b = first.im + second.im;
        let still = first * second - self.product;
        let (c, d) = (still.re, still.im);
        let (slope_c, slope_d) = (first.im, -first.re);
        [
            a * a * c - a * b * d - d * d,
            a * a * slope_c + a * (d - b * slope_d) - 2.0 * d * slope_d,
            slope_d * (a - slope_d),
        ]
    }

    /// Detunings at which the pair grows.
    pub(super) fn band(&self) -> DetuningBand {
        if !(self.first.re < 0.0 && self.second.re < 0.0) {
            return DetuningBand::Outside;
        }
        let [q0, q1, q2] = self.hurwitz();
        let discriminant = q1 * q1 - 4.0 * q2 * q0;
        if discriminant <= ROUNDING * (q1 * q1 + (4.0 * q2 * q0).abs()) {
            return DetuningBand::Nowhere;
        }
        let Some([x, y]) = quadratic(q0, q1, q2) else { return DetuningBand::Nowhere };
        if x <= y { DetuningBand::Between(x, y) } else { DetuningBand::Between(y, x) }
    }

    /// Detuning of the largest growth, and that growth.
    pub(super) fn peak(&self) -> (f64, f64) {
        let real = 0.5 * (self.first.re - self.second.re);
        let offset = self.first.im - self.second.im;
        let (re, im) = (self.product.re, self.product.im);
        let size = libm::hypot(re, im);
        let candidates = if im == 0.0 {
            [0.0, 0.0]
        } else {
            // The pair of roots of t² + 2x(Re C/Im C)t − x², whose product is −x².
            let large = real * (-re - libm::copysign(size, re)) / im;
            [large, if large == 0.0 { 0.0 } else { -real * real / large }]
        };
        candidates
            .map(|t| 2.0 * t - offset)
            .map(|detuning| (detuning, self.growth(detuning)))
            .into_iter()
            .fold((0.0, f64::NEG_INFINITY), |best, next| if next.1 > best.1 { next } else { best })
    }
}
