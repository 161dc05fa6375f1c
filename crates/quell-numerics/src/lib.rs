//! Mathematics of Quell; no physics.

pub mod quadrature;
pub mod roots;
pub mod special;
pub mod spectrum;
