//! Balancing: a diagonal similarity transformation by powers of two that gives the rows and columns of a matrix
//! similar norms, so that the rounding errors of the eigenvalues are those of the balanced matrix.
//!
//! A ← D⁻¹ A D with D = diag(2^eᵢ), swept over i until no column and row sum differ by more than a factor of
//! about two (Parlett and Reinsch, *Numer. Math.* 13 (1969) 293; the 1-norm without the diagonal).
//! Scaling by powers of two is exact. A scaling is applied only if it lowers c + r by five per cent,
//! which also prevents balancing from increasing the errors (James, Langou and Lowery, 2014).

/// Maximum number of sweeps; a sweep without changes ends the iteration. More sweeps have not improved any matrix so far.
const SWEEPS: usize = 32;

/// Largest exponent of a scale factor, so that products of two factors stay finite.
const LARGEST_EXPONENT: i32 = 400;

/// Balances the n × n matrix in rows of length `stride`; returns D, a power of two for each row.
#[inline(always)]
pub(crate) fn balance(a: &mut [f64], n: usize, stride: usize) -> Vec<f64> {
    let mut scales = vec![1.0; n];
    let limit = 2f64.powi(LARGEST_EXPONENT);
    for _ in 0..SWEEPS {
        let mut changed = false;
        for i in 0..n {
            let (column, row) = sums(a, n, stride, i);
            if column <= 0.0 || row <= 0.0 || !column.is_finite() || !row.is_finite() {
                continue;
            }
            let mut factor = 1.0;
            let mut grown = column;
            while grown < 0.5 * row {
                factor *= 2.0;
                grown *= 4.0;
            }
            while grown >= 2.0 * row {
                factor *= 0.5;
                grown *= 0.25;
            }
            let better = column * factor + row / factor < 0.95 * (column + row);
            let scale: f64 = scales[i] * factor;
            if factor != 1.0 && better && scale < limit && scale * limit > 1.0 {
                changed = true;
                scales[i] = scale;
                for entry in &mut a[i * stride..i * stride + n] {
                    *entry /= factor;
                }
                for entry in a[i..].iter_mut().step_by(stride).take(n) {
                    *entry *= factor;
                }
            }
        }
        if !changed {
            break;
        }
    }
    scales
}

/// Sums of the magnitudes of column i and of row i, both without the diagonal. They are recomputed each time: a difference of
/// larger sums would lose entries that are many orders of magnitude smaller than the diagonal.
#[inline(always)]
fn sums(a: &[f64], n: usize, stride: usize, i: usize) -> (f64, f64) {
    let (mut column, mut row) = (0.0, 0.0);
    for j in (0..n).filter(|&j| j != i) {
        column += a[j * stride + i].abs();
        row += a[i * stride + j].abs();
    }
    (column, row)
}
