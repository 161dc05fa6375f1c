//! Tangential dither at a finite speed ratio: the follower force that it leaves, and the force that it needs (5.26)–(5.30).
//!
//! The load moves around its mean rotation as φ(τ) = φ₀ sin Rτ (5.26), so that it slips at Ω + φ₀R cos Rτ = Ω (1 + Λ cos Rτ)
//! with the slip ratio Λ = φ₀R/|Ω|. The dissertation takes the limit of high frequency, φ → 0 (5.27) and Λ → ∞ (5.28), and keeps of
//! the square wave its fundamental, printed with the amplitude F_θ (5.30). At a finite ratio friction of constant size follows
//! the sign of the slip exactly, f(τ) = f sgn(1 + Λ cos Rτ):
//!
//! ```text
//! mean        f̄/f = (2/π) asin(1/Λ)            Λ ≥ 1, else 1
//! harmonics   f_n/f = (4/nπ) sin nδ,  δ = π − acos(1/Λ);   f₁/f = (4/π) √(1 − 1/Λ²)
//! ```
//!
//! Corrections to the print. The fundamental of ±F_θ is (4/π)F_θ cos Rτ, not F_θ cos Rτ. The mean vanishes only as 2/(πΛ): a mean
//! below f̄/f = ε needs Λ = 1/sin(πε/2). And (5.29) gives the order of the dither force alone, D_T = O(φ″), which is the inertia of
//! the load; with m* its mass, the drive supplies the mean of friction and the dither the rest,
//!
//! ```text
//! D_T(τ) = −m* Λ|Ω|R sin Rτ + f(τ) − f̄,      peak D_T = max{ m*Λ|Ω|R + |f| − |f̄|,  m*Λ|Ω|R √(1 − 1/Λ²) + |f| + |f̄| }
//! ```
//!
//! in units of r₀M_pω_ref², those of f*. For Λ < 1 the slip does not reverse and D_T is the inertia alone.

use std::f64::consts::{FRAC_PI_2, PI};

/// A load that is shaken along its path while it slides.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TangentialDither {
    /// Slip ratio Λ > 0: peak velocity of the dither over the speed of sliding.
    pub slip_ratio: f64,
    /// Speed Ω of sliding.
    pub speed: f64,
    /// Frequency ratio R of the dither.
    pub frequency_ratio: f64,
}

impl TangentialDither {
    /// Whether the slip reverses.
    pub fn reverses(&self) -> bool {
        self.slip_ratio > 1.0
    }

    /// The slip ratio that reduces the mean of the follower force to a fraction in (0, 1].
    pub fn slip_ratio_for(mean: f64) -> f64 {
        libm::sin(FRAC_PI_2 * mean).recip()
    }

    /// Amplitude φ₀ of the angle, radians.
    pub fn angle(&self) -> f64 {
        self.slip_ratio * self.speed.abs() / self.frequency_ratio
    }

    /// Mean of the follower force over f.
    pub fn mean(&self) -> f64 {
        if self.reverses() { libm::asin(self.slip_ratio.recip()) / FRAC_PI_2 } else { 1.0 }
    }

    /// Amplitude of cos nRτ in the follower force over f, n ≥ 1.
    pub fn harmonic(&self, n: u32) -> f64 {
        if !self.reverses() {
            return 0.0;
        }
        let n = f64::from(n);
        let half = PI - libm::acos(self.slip_ratio.recip());
        4.0 / (n * PI) * libm::sin(n * half)
    }

    /// Peak D_T of the dither force for a mass m* and a friction f*.
    pub fn force(&self, mass: f64, friction: f64) -> f64 {
        let inertia = mass * self.slip_ratio * self.speed.abs() * self.frequency_ratio;
        if !self.reverses() {
            return inertia;
        }
        let (friction, mean) = (friction.abs(), self.mean());
        let at_reversal = (1.0 - self.slip_ratio.recip().powi(2)).sqrt();
        let forward = inertia + friction * (1.0 - mean);
        let backward = f64::mul_add(inertia, at_reversal, friction * (1.0 + mean));
        f64::max(forward, backward)
    }
}
