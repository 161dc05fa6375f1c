//! Event-exact motion under friction: pure functions of valid values, without files, threads, clocks or printing.
//!
//! The structure is one mass on a moving belt with dither; the general loop over several contacts is not built yet.
//!
//! * [`simulation`]: event-exact trajectories by adaptive Taylor series;
//! * [`orbit`]: periodic responses, their Floquet multipliers, exact thresholds;
//! * [`attractor`]: where runs end, rotation numbers, basins;
//! * [`start`], [`response`]: where a run starts; its steady response, spectrum, efficiency and costs.

pub mod attractor;
mod band;
mod contraction;
pub mod orbit;
pub mod response;
pub mod simulation;
pub mod start;
