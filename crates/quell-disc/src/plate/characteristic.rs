//! The characteristic equation of a thin annular plate, clamped at r = b, free at r = a; eqs (5.3)–(5.6).
//!
//! With lengths in a, w = c₁J(kr) + c₂Y(kr) + c₃I(kr) + c₄K(kr) solves ∇⁴w = k⁴w exactly for w(r) cos nθ. Four conditions:
//!
//! ```text
//! r = b/a:  w = 0,   w' = 0
//! r = 1:    ∇²w − (1 − ν)(w' − n² w) = 0                     (bending moment)
//!           (∇²w)' − (1 − ν) n² (w' − w) = 0                 (Kirchhoff's shear force)
//! ```
//!
//! ∇² multiplies J, Y by −k² and I, K by k², so no second or third derivative is needed. The determinant in that form has entries
//! between 10⁻²⁴ and 10²⁴ at n = 20, b/a = 0.05. Here I and K are the scaled functions of `quell_numerics::bessel` with the
//! exponents shifted to e^{k(r−1)} and e^{−k(r−b)}, each condition is divided by k^(its order), and every column by its largest
//! entry. TravellingWave numbers then agree with 40-digit arithmetic to a few units of rounding. Elimination with complete pivoting gives
//! the determinant and, at a root, the null vector.
//!
//! Limitation: for b/a → 0 the columns of Y and K become parallel at the clamp (both ∝ r⁻ⁿ). This costs up to four digits of
//! c₂ and c₄, but does not affect the frequency.

use quell_numerics::bessel::{Neighbours, bessel_i_scaled, bessel_j, bessel_k_scaled, bessel_y};

/// Values and slopes (with respect to kr) of J, Y, e^{k(r−1)}-scaled I, e^{−k(r−b)}-scaled K at one radius.
pub(super) struct Basis {
    pub(super) values: [f64; 4],
    pub(super) slopes: [f64; 4],
}

impl Basis {
    /// Values at radius r for n nodal diameters; `None` where a function is out of the range of `f64`.
    pub(super) fn new(
        diameters: u32,
        wave_number: f64,
        inner_radius: f64,
        radius: f64,
    ) -> Option<Self> {
        let x = wave_number * radius;
        let ratio = f64::from(diameters) / x;
        let grow = libm::exp(wave_number * (radius - 1.0));
        let decay = libm::exp(-wave_number * (radius - inner_radius));
        let falling = |[value, next]: Neighbours| (value, ratio * value - next);
        let (j, j_slope) = falling(bessel_j(diameters, x)?);
        let (y, y_slope) = falling(bessel_y(diameters, x)?);
        let (k, k_slope) = falling(bessel_k_scaled(diameters, x)?);
        let [i, i_next] = bessel_i_scaled(diameters, x)?;
        Some(Self {
            values: [j, y, grow * i, decay * k],
            slopes: [j_slope, y_slope, grow * (ratio * i + i_next), decay * k_slope],
        })
    }
}

/// Result of eliminating the four conditions at one wave number.
pub(super) struct Elimination {
    /// The determinant with every column scaled to a largest entry of 1.
    pub(super) determinant: f64,
    /// Coefficients of J, Y, scaled I, scaled K that satisfy three conditions exactly and, at a root, the fourth as well.
    pub(super) coefficients: [f64; 4],
}

/// Sets up the four conditions at the wave number k and eliminates; `None` where a Bessel function is out of the range of `f64`.
pub(super) fn eliminate(
    diameters: u32,
    inner_radius: f64,
    poisson_ratio: f64,
    wave_number: f64,
) -> Option<Elimination> {
    let inner = Basis::new(diameters, wave_number, inner_radius, inner_radius)?;
    let outer = Basis::new(diameters, wave_number, inner_radius, 1.0)?;
    let k = wave_number;
    let n2 = f64::from(diameters) * f64::from(diameters);
    let softness = 1.0 - poisson_ratio;
    let mut matrix = [[0.0; 4]; 4];
    let mut scale = [0.0; 4];
    for column in 0..4 {
        let laplacian = if column < 2 { -1.0 } else { 1.0 };
        let (value, slope) = (outer.values[column], outer.slopes[column]);
        let entries = [
            inner.values[column],
            inner.slopes[column],
            laplacian * value - softness * (slope / k - n2 * value / (k * k)),
            laplacian * slope - softness * n2 * (slope / (k * k) - value / (k * k * k)),
        ];
        scale[column] = entries.iter().fold(0.0_f64, |largest, entry| largest.max(entry.abs()));
        if !(scale[column] > 0.0 && scale[column].is_finite()) {
            return None;
        }
        for row in 0..4 {
            matrix[row][column] = entries[row] / scale[column];
        }
    }
    let (determinant, mut coefficients) = complete_pivoting(matrix);
    for (coefficient, scale) in coefficients.iter_mut().zip(scale) {
        *coefficient /= scale;
    }
    Some(Elimination { determinant, coefficients })
}

#[expect(
    clippy::needless_range_loop,
    reason = "elimination reads and writes two rows of one matrix"
)]
/// Determinant, and the vector that satisfies the equations of the first three pivots.
fn complete_pivoting(mut matrix: [[f64; 4]; 4]) -> (f64, [f64; 4]) {
    let mut order = [0, 1, 2, 3];
    let mut determinant = 1.0;
    for step in 0..4 {
        let (mut row, mut column) = (step, step);
        for i in step..4 {
            for j in step..4 {
                if matrix[i][j].abs() > matrix[row][column].abs() {
                    (row, column) = (i, j);
                }
            }
        }
        if row != step {
            matrix.swap(row, step);
            determinant = -determinant;
        }
        if column != step {
            for line in &mut matrix {
                line.swap(column, step);
            }
            order.swap(column, step);
            determinant = -determinant;
        }
        let pivot = matrix[step][step];
        determinant *= pivot;
        if pivot == 0.0 {
            continue;
        }
        for i in step + 1..4 {
            let factor = matrix[i][step] / pivot;
            for j in step..4 {
                matrix[i][j] -= factor * matrix[step][j];
            }
        }
    }
    let mut solution = [0.0, 0.0, 0.0, 1.0];
    for i in (0..3).rev() {
        let sum: f64 = (i + 1..4).map(|j| matrix[i][j] * solution[j]).sum();
        solution[i] = if matrix[i][i] == 0.0 { 0.0 } else { -sum / matrix[i][i] };
    }
    let mut ordered = [0.0; 4];
    for (index, value) in order.into_iter().zip(solution) {
        ordered[index] = value;
    }
    (determinant, ordered)
}
