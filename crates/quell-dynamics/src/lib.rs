//! Event-exact motion under friction: pure functions of valid values, without files, threads, clocks or printing.
//!
//! [`motion`] is that of any system, and takes [`simulation`] where it is that of one mass on a moving belt; what follows is about systems.
//!
//! * [`simulation`], [`motion`]: event-exact trajectories by adaptive Taylor series, and their derivatives;
//! * [`orbit`]: periodic responses, their Floquet multipliers, exact thresholds, limit cycles;
//! * [`attractor`]: where runs settle, rotation numbers, basins;
//! * [`mean_friction`]: the average of friction with a state of its own, under a prescribed slip;
//! * [`response`]: the steady response of a run, its spectrum, residual vibration and costs.

#![cfg_attr(not(test), deny(clippy::disallowed_methods))]

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
