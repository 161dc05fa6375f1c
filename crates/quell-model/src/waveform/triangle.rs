//! Triangle, eq. (3.5): rises from 0 to 1 at π/2, falls to −1 at 3π/2, rises to 0 at 2π.
//!
//! G is made of parabolas: −π/4 + θ²/π on [0, π/2], mirrored.

use std::f64::consts::{FRAC_2_PI, FRAC_PI_2, FRAC_PI_4, PI, TAU};

use super::shape::{Piece, Shape};

/// 1/√3.
const FRAC_1_SQRT_3: f64 = 0.577_350_269_189_625_8;

pub(super) const SHAPE: Shape = Shape {
    name: "triangle",
    breaks: &[FRAC_PI_2, 3.0 * FRAC_PI_2],
    pieces: &[
        Piece::Affine { value: 1.0, slope: -FRAC_2_PI },
        Piece::Affine { value: -1.0, slope: FRAC_2_PI },
    ],
    integral: |phase| {
        // Distance from the nearest multiple of 2π, then mirrored about π/2.
        let from_zero = if phase > PI { TAU - phase } else { phase };
        if from_zero <= FRAC_PI_2 {
            from_zero * from_zero / PI - FRAC_PI_4
        } else {
            let from_pi = PI - from_zero;
            FRAC_PI_4 - from_pi * from_pi / PI
        }
    },
    peak_integral: FRAC_PI_4,
    mean_square_integral: PI * PI / 30.0,
    root_mean_square: FRAC_1_SQRT_3,
};
