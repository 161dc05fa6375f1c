//! An annular brake disc under a rotating load: a thin plate clamped at its inner edge, a mass, a damper
//! and a spring that rotate over it, and the follower force of friction; with and without dither.
//!
//! * [`plate`]: frequencies and shapes of the plate, every mode found twice;
//! * [`equations`]: the equations of motion, assembled from contributions that can be switched off;
//! * [`undithered`], [`boundaries`]: eigenvalues, Campbell diagram, exact boundaries f(Ω) at ξ = 0;
//! * [`dithered`], [`partition`]: Floquet exponents with error bounds, boundary curves by D-partition;
//! * [`marginal`]: marginal values of any parameter under any waveform, by exact exponents along a line;
//! * [`growing`]: the speeds at which a motion grows, exactly;
//! * [`instability`]: which part of the loads causes an unstable motion;
//! * [`static_load`]: deflection under a static load, critical speeds;
//! * [`tangential`]: the follower force under tangential dither at a finite speed ratio, and the force of the dither;
//! * [`resonance`]: where waves meet, which pairs of them can be unstable at first and second order, tongues, clear dither frequencies.
//!
//! The disc itself, its modes, loads and dither, is a noun of `quell-model`.

#![cfg_attr(not(test), deny(clippy::disallowed_methods))]

pub mod boundaries;
pub mod dithered;
pub mod equations;
pub mod growing;
pub mod instability;
pub mod marginal;
pub mod partition;
pub mod plate;
pub mod resonance;
pub mod static_load;
pub mod tangential;
pub mod undithered;
