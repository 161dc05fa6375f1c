//! Questions about many studies at once: the least dither, what actuators can give, friction laws fitted to measurements, the
//! probability that a structure vibrates, and friction models of other programs in place of a law.

#![cfg_attr(not(test), deny(clippy::disallowed_methods))]

pub mod actuator;
pub mod atlas;
pub mod decay;
pub mod estimates;
pub mod fit;
pub mod least_dither;
pub mod probability;
pub mod quench;
pub mod substitute;
pub mod tasks;
mod unestimated;
mod unknown;

pub use unestimated::{ExactFit, NoStandardError};
pub use unknown::{AveragingEnds, NoAnswer, NotOfDisc};
