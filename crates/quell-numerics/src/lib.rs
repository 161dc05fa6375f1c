//! Mathematics of Quell; no physics.
//!
//! * [`lane`], [`elementary`], [`dispatch`]: the arithmetic of the hot kernels, the same bits everywhere;
//! * [`matrix`], [`eigen`], [`floquet`]: small dense matrices, eigenvalues, exponents of periodic systems with error bounds;
//! * [`polynomial`]: first root of a Taylor step, isolated or proven absent; step length;
//! * [`quadrature`], [`roots`], [`special`], [`spectrum`]: integrals, scalar roots and minima, special functions, spectra.

pub mod dispatch;
pub mod eigen;
pub mod elementary;
pub mod floquet;
pub mod lane;
pub mod matrix;
pub mod polynomial;
pub mod quadrature;
pub mod roots;
pub mod special;
pub mod spectrum;
