//! Square, eq. (3.6): +1 on (0, π), −1 on (π, 2π). G is a triangle between ∓π/2.

use std::f64::consts::{FRAC_PI_2, PI};

use super::shape::{Piece, Shape};

pub(super) const SHAPE: Shape = Shape {
    name: "square",
    breaks: &[0.0, PI],
    pieces: &[Piece::Affine { value: 1.0, slope: 0.0 }, Piece::Affine { value: -1.0, slope: 0.0 }],
    integral: |phase| {
        if phase < PI { phase - FRAC_PI_2 } else { 3.0 * FRAC_PI_2 - phase }
    },
    peak_integral: FRAC_PI_2,
    mean_square_integral: PI * PI / 12.0,
    root_mean_square: 1.0,
};
