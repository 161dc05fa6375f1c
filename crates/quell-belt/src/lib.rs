//! A mass on a moving belt with dither: pure functions of valid values, without files,
//! threads, clocks or printing.
//!
//! * [`simulation`]: event-exact trajectories by adaptive Taylor series.

pub mod simulation;
