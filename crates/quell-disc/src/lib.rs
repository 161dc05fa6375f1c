//! An annular brake disc under a rotating load: a thin plate clamped at its inner edge, a mass, a damper
//! and a spring that rotate over it, and the follower force of friction; with and without dither.

pub mod plate;
pub mod resonance;
