//! Event-exact motion under friction: pure functions of valid values, without files, threads, clocks or printing.
//!
//! [`motion`] is that of any system; the other modules have one mass on a moving belt with dither, [`response`] both.
//!
//! * [`simulation`]: event-exact trajectories by adaptive Taylor series;
//! * [`orbit`]: periodic responses, their Floquet multipliers, exact thresholds;
//! * [`attractor`]: where runs settle, rotation numbers, basins;
//! * [`mean_friction`]: the average of friction with a state of its own, under a prescribed slip;
//! * [`start`], [`response`]: initial states; the steady response of a run, its spectrum, residual vibration and costs.

pub mod attractor;
mod band;
mod contraction;
mod decay;
pub mod mean_friction;
pub mod motion;
pub mod orbit;
pub mod response;
mod sample_times;
pub mod simulation;
pub mod start;
