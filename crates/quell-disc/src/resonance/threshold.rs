//! Friction at the tip of a tongue.
//!
//! With f₀ = μf and f₁ = αf/2 (|f_h| = αf|c_h| at harmonic h of another waveform), the damping of a wave is η = A − Bf, A = (g²/2β)c(β + sΩ) + ξβ, B = μ(g²/2β)s, and a
//! dither-induced pair of equal direction has p = b₁b₂α²f²/4, b = (g²/2β)s. The tip is at p = η₁η₂, a quadratic in f:
//!
//! * tangential dither (μ = 0): f = (2/α)√(A₁A₂/(b₁b₂)); with ξ = 0 it is 2c/α √((β₁/l₁ ∓ Ω)(β₂/l₂ ∓ Ω)), with − for forward
//!   waves;
//! * normal dither (μ = 1): for forward waves damping increases faster than coupling, so they have no tip for α < 2; backward
//!   waves do.
//!
//! An undithered pair of an undamped plate has its tip at f = 0. With ξ > 0 the tip is where the discriminant of the pair's
//! quadratic vanishes. It is bracketed on a logarithmic grid of friction (no closed form exists for unequal waves) and located to
//! rounding.

use quell_numerics::roots::{Closeness, find_root, quadratic};

use super::meetings::WaveMeeting;
use super::pair::DetuningBand;
use super::tongue::Coupling;
use super::waves::{Order, Waves};

/// Steps of the logarithmic grid per decade, and decades on either side of the friction scale of the waves.
const STEPS_PER_DECADE: i32 = 24;
const DECADES: i32 = 6;

impl Waves {
    pub(super) fn threshold(&self, meeting: &WaveMeeting, coupling: Coupling) -> Option<f64> {
        if coupling != Coupling::Destabilising {
            return None;
        }
        if meeting.h == 0 || self.order == Order::Second {
            self.first_tongue(meeting)
        } else {
            self.dithered_tip(meeting)
        }
    }

    /// A and b of each wave: its damping without friction, and its coupling by friction of zero mean.
    fn damping_parts(&self, meeting: &WaveMeeting) -> [[f64; 2]; 2] {
        meeting.signed().map(|wave| {
            let still = self.with_friction(0.0).self_term(&wave, meeting.speed, &[]);
            [-still.re, self.rho(&wave) * wave.l]
        })
    }

    fn dithered_tip(&self, meeting: &WaveMeeting) -> Option<f64> {
        let [[a1, b1], [a2, b2]] = self.damping_parts(meeting);
        if !(a1 > 0.0 && a2 > 0.0) {
            return Some(0.0);
        }
        let (mean, half) = self.friction_parts(1.0, meeting.h);
        // half² b₁b₂ f² = (A₁ − μb₁f)(A₂ − μb₂f)
        let square = b1 * b2 * (mean * mean - half * half);
        let linear = -mean * (a1 * b2 + a2 * b1);
        let constant = a1 * a2;
        let roots = quadratic(constant, linear, square)?;
        roots.into_iter().filter(|root| *root > 0.0 && root.is_finite()).reduce(f64::min)
    }

    /// Smallest friction at which a pair without a closed form has a tongue.
    fn first_tongue(&self, meeting: &WaveMeeting) -> Option<f64> {
        let waves = meeting.waves;
        if meeting.h == 0 && waves.iter().all(|wave| self.modes[wave.mode].damping == 0.0) {
            return Some(0.0);
        }
        let [[a1, b1], [a2, b2]] = self.damping_parts(meeting);
        let scale = (a1 + a2).abs() / (b1.abs() + b2.abs());
        if !(scale > 0.0 && scale.is_finite()) {
            return None;
        }
        let excess = |friction: f64| self.with_friction(friction).pair(meeting).peak().1;
        let steps = STEPS_PER_DECADE * DECADES;
        let mut last = 0.0;
        for step in -steps..=steps {
            let friction = scale * libm::pow(10.0, f64::from(step) / f64::from(STEPS_PER_DECADE));
            match self.with_friction(friction).pair(meeting).band() {
                DetuningBand::Outside => return None,
                DetuningBand::Between(..) => {
                    let closeness = Closeness { absolute: 0.0, relative: 1e-14 };
                    // Where the growth at the tip is rounding noise on both sides, use the friction at which the band was found.
                    let root = find_root(excess, last, friction, closeness);
                    return Some(root.map_or(friction, |root| root.location));
                }
                DetuningBand::Nowhere => last = friction,
            }
        }
        None
    }
}
