//! Questions about many studies at once: the least dither of an actuator, friction laws fitted to measurements, and the probability
//! that a structure vibrates.

pub mod fit;
pub mod least_dither;
pub mod probability;
