//! A mass on a moving belt with dither: pure functions of valid values, without files,
//! threads, clocks or printing.
//!
//! * [`attractor`]: where runs end, rotation numbers, basins;
//! * [`averaging`]: effective friction under fast dither, stability of steady sliding, critical amplitudes;
//! * [`orbit`]: periodic responses, their Floquet multipliers, exact thresholds;
//! * [`simulation`]: event-exact trajectories by adaptive Taylor series;
//! * [`start`], [`response`]: where a run starts; its steady response, spectrum, efficiency and costs.

pub mod attractor;
pub mod averaging;
mod band;
mod contraction;
pub mod orbit;
pub mod response;
pub mod simulation;
pub mod start;
