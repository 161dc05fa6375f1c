//! Questions about many studies at once: the least dither, what actuators can give, friction laws fitted to measurements, and the probability
//! that a structure vibrates.

pub mod actuator;
pub mod decay;
pub mod estimates;
pub mod fit;
pub mod least_dither;
pub mod probability;
