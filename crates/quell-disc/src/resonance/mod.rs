//! Resonances of a disc's waves under a rotating load: where they are, which can be unstable, how wide, how fast.
//!
//! In the frame of the load every mode of q > 0 nodal diameters is two waves, forward with the frequency β − qΩ, backward
//! with β + qΩ; a mode without nodal diameters is one, β. In the complex form of (5.41) they and their conjugates are
//! w = lΩ + σβ, σ = ±1. Loads and friction of order ε couple two waves at
//!
//! ```text
//! w₁ = w₂          (5.55): undithered            w₁ = w₂ + hR, h = ±1     (5.56): induced by dither
//! ```
//!
//! The print gives these places only. Here every one has its pair of waves, the slow 2 × 2 system of their amplitudes, and from it
//! whether the coupling can be unstable, the friction at the tip, both edges, the largest growth.
//! Corrections to the print: complex modes (5.39) need g² = φ²/2 for l ≠ 0, where (5.7) put literally into (5.41)–(5.66)
//! doubles every coupling; α cos(Rτ) is α/2 in (5.40)–(5.51); tangential dither takes the mean friction away, so it does suppress
//! the undithered tongues at first order ((5.53), (5.54)), contrary to the text; Table 5.1 omits Ω = 0.
//!
//! [`Order::Second`] is the high-friction ordering (5.57)–(5.66), f ~ √ε: friction acting twice over a third wave counts
//! as much as mass, damper and spring. It revives the undithered tongues under tangential dither (growth ~ f⁴, width ~ f²)
//! and adds places at h = ±2.
//!
//! Accuracy: relative errors fall in proportion to ε (the tests measure it). Assumption: no third wave in resonance with the two.

mod clear;
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
pub use verified::{Verified, verified_frequency};
pub use wave::{Wave, WaveDirection};
pub use waves::{Order, WaveError, Waves};
