//! Resonances of the waves of a disc under a rotating load: their speeds, which of them can be unstable, their widths and growth
//! rates.
//!
//! In the frame of the load, every mode with q > 0 nodal diameters is two waves: a forward wave of frequency β − qΩ and a
//! backward wave of frequency β + qΩ. A mode without nodal diameters is one wave of frequency β. In the complex form of (5.41)
//! the waves and their conjugates have w = lΩ + σβ, σ = ±1. Loads and friction of order ε couple two waves at
//!
//! ```text
//! w₁ = w₂          (5.55): undithered            w₁ = w₂ + hR, h = ±1     (5.56): induced by dither
//! ```
//!
//! A dither of another waveform than the sine couples waves at each of its harmonics, h = ±n with the n-th Fourier coefficient in
//! place of that of the cosine (`harmonics`); of a burst R is the frequency at which it repeats itself.
//!
//! The dissertation gives these speeds only. Here each meeting also has its pair of waves and the slow 2 × 2 system of their
//! amplitudes, which determines whether the coupling can be unstable, the friction at the tip of the tongue, both edges, and the
//! largest growth rate.
//!
//! Corrections to the dissertation: complex modes (5.39) require g² = φ²/2 for l ≠ 0, whereas (5.7) inserted literally into
//! (5.41)–(5.66) doubles every coupling. α cos(Rτ) is α/2 in (5.40)–(5.51). Tangential dither removes the mean friction, so it
//! does suppress the undithered tongues at first order ((5.53), (5.54)), contrary to the text. Table 5.1 omits Ω = 0.
//!
//! [`Order::Second`] is the high-friction ordering (5.57)–(5.66), f ~ √ε: friction acting twice via a third wave is of the same
//! order as mass, damper and spring. It revives the undithered tongues under tangential dither (growth ~ f⁴, width ~ f²)
//! and adds meetings at h = ±2.
//!
//! Accuracy: relative errors are proportional to ε (measured in the tests). Assumption: no third wave is in resonance with the
//! two. Under strong friction three waves grow together where no pair does, such as near the fourth speed of table 5.2 in figure 5.9:
//! `growing` finds them by exact exponents.

mod amplitude;
mod clear;
mod harmonics;
mod meetings;
mod pair;
mod threshold;
mod tongue;
mod verified;
mod wave;
mod waves;

#[cfg(test)]
mod tests;

pub use clear::{Blocked, Clearance, ClearanceError, Nearby, clear_frequencies, within};
pub use tongue::{Coupling, Resonance, Tongue};
pub use verified::{TestedFrequency, Verification, Verified, verified_frequency};
pub use wave::{TravellingWave, WaveDirection};
pub use waves::{Order, WaveError, Waves};
