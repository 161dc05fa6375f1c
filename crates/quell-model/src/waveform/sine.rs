//! Sine, eq. (2.1): g = sin θ, G = −cos θ.

use std::f64::consts::FRAC_1_SQRT_2;

use super::shape::{Piece, Shape};

pub(super) const SHAPE: Shape = Shape {
    name: "sine",
    breaks: &[],
    pieces: &[Piece::Harmonic],
    integral: |phase| -libm::cos(phase),
    peak_integral: 1.0,
    mean_square_integral: 0.5,
    root_mean_square: FRAC_1_SQRT_2,
};
