//! Numerical methods of Quell; no physics.
//!
//! * [`lane`], [`elementary`], [`dispatch`]: the arithmetic of the hot kernels, with the same bits on every machine;
//! * [`matrix`], [`eigen`], [`floquet`]: small dense matrices, eigenvalues, exponents of periodic systems with error bounds;
//! * [`polynomial`]: first root of a Taylor step, isolated or proven absent; step length;
//! * [`periodic_polynomial`]: a periodic function by polynomials on intervals;
//! * [`quadrature`], [`gauss_legendre`], [`roots`], [`special`], [`bessel`], [`spectrum`]: integrals, scalar roots and minima,
//!   special functions, spectra;
//! * [`extrapolation`]: smooth ordinary differential equations to full accuracy;
//! * [`symmetric`], [`gram`]: eigenvalues of symmetric pencils, eigenpairs of AᵀA from the columns of A;
//! * [`least_squares`], [`damped_least_squares`]: linear fits of a few columns, nonlinear fits within bounds;
//! * [`random`]: pseudorandom numbers with fixed bits;
//! * [`order`]: sorting by numbers, compiled once;
//! * [`cyclic`]: sequences whose beginning is arbitrary;
//! * [`interval`]: bounds of functions over intervals with outward rounding, for proofs;
//! * [`polar`]: modulus, argument and square root of complex numbers with the same bits on every machine;
//! * [`normal_form`]: coefficients that decide whether a bifurcation is supercritical;
//! * [`continuation`]: fixed points of period maps by shooting, their branches, thresholds and curves of thresholds.

#![cfg_attr(not(test), deny(clippy::disallowed_methods))]

pub mod bessel;
pub mod continuation;
pub mod cyclic;
pub mod damped_least_squares;
pub mod dispatch;
pub mod eigen;
pub mod elementary;
pub mod extrapolation;
pub mod floquet;
#[cfg(all(windows, target_env = "gnu"))]
mod fused;
pub mod gauss_legendre;
pub mod gram;
mod groups;
pub mod interval;
pub mod lane;
pub mod least_squares;
pub mod matrix;
pub mod normal_form;
pub mod order;
pub mod periodic_polynomial;
pub mod polar;
pub mod polynomial;
pub mod quadrature;
pub mod random;
pub mod roots;
pub mod special;
pub mod spectrum;
pub mod symmetric;
