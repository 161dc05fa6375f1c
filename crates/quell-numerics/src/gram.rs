//! Eigenvalues and eigenvectors of AᵀA by Jacobi's rotations of the columns of A.
//!
//! Each sweep makes every pair of columns orthogonal once (Hestenes 1958; Golub and Van Loan, *Matrix Computations*, §8.6.3). The sums have a fixed
//! order, so that the result has the same bits everywhere. For a few dozen columns.

use crate::order::ascending_by;

/// Sweeps after which every matrix of this size has converged: the convergence is quadratic, and ten are rarely needed.
const SWEEPS: usize = 60;

/// An eigenvalue with its vector of length 1.
#[derive(Clone, Debug, PartialEq)]
pub struct Eigenpair {
    /// λ.
    pub value: f64,
    /// The vector.
    pub vector: Vec<f64>,
}

/// The eigenpairs of AᵀA by ascending eigenvalue, from the columns of A, which have one length; `None` if an entry is not finite.
///
/// Eigenvalues down to ε² of the largest keep their vectors, where those of the product AᵀA are lost in rounding below ε.
pub fn gram_eigenpairs(columns: &[Vec<f64>]) -> Option<Vec<Eigenpair>> {
    if !columns.iter().flatten().all(|entry| entry.is_finite()) {
        return None;
    }
    let size = columns.len();
    let mut own = columns.to_vec();
    // Row k is the k-th vector.
    let mut vectors: Vec<Vec<f64>> =
        (0..size).map(|k| (0..size).map(|row| f64::from(u8::from(row == k))).collect()).collect();
    let product = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    // The rounding error of a product of two columns, relative to their lengths.
    let rounding = f64::EPSILON * own.first().map_or(0, Vec::len) as f64;
    for _ in 0..SWEEPS {
        let mut turned = false;
        for p in 0..size {
            for q in p + 1..size {
                let across = product(&own[p], &own[q]);
                let squares = [p, q].map(|k| product(&own[k], &own[k]));
                if across.abs() <= rounding * (squares[0] * squares[1]).sqrt() {
                    continue;
                }
                turned = true;
                let turn = rotation(squares[0], squares[1], across);
                turn_rows(&mut own, (p, q), turn);
                turn_rows(&mut vectors, (p, q), turn);
            }
        }
        if !turned {
            break;
        }
    }
    // From the columns as given: many rotations change the lengths of the turned ones by rounding.
    let pair = |vector: Vec<f64>| {
        let length = product(&vector, &vector).sqrt();
        let vector: Vec<f64> = vector.iter().map(|share| share / length).collect();
        let entry = |row: usize| -> f64 {
            columns.iter().zip(&vector).map(|(column, share)| column[row] * share).sum()
        };
        let rows = columns.first().map_or(0, Vec::len);
        Eigenpair { value: (0..rows).map(|row| entry(row) * entry(row)).sum(), vector }
    };
    let mut pairs: Vec<Eigenpair> = vectors.into_iter().map(pair).collect();
    ascending_by(&mut pairs, |a| a.value);
    Some(pairs)
}

/// Turns two rows in their plane.
fn turn_rows(rows: &mut [Vec<f64>], (p, q): (usize, usize), [cosine, sine]: [f64; 2]) {
    let (before, after) = rows.split_at_mut(q);
    for (a, b) in before[p].iter_mut().zip(&mut after[0]) {
        (*a, *b) = (cosine * *a - sine * *b, sine * *a + cosine * *b);
    }
}

/// Cosine and sine of the rotation that makes [[a, c], [c, b]] diagonal, by at most a quarter of a right angle.
fn rotation(a: f64, b: f64, c: f64) -> [f64; 2] {
    let theta = (b - a) / (2.0 * c);
    let tangent = theta.signum() / (theta.abs() + libm::hypot(theta, 1.0));
    let cosine = 1.0 / libm::hypot(tangent, 1.0);
    [cosine, tangent * cosine]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_pairs_of_a_chain_are_the_known_ones() {
        // Differences of neighbours: AᵀA has 2 on the diagonal and −1 next to it, λ_k = 2 − 2 cos(kπ/(n + 1)).
        let size = 9;
        let difference = |j: usize| {
            (0..=size)
                .map(|i| f64::from(u8::from(i == j)) - f64::from(u8::from(i == j + 1)))
                .collect()
        };
        let columns: Vec<Vec<f64>> = (0..size).map(difference).collect();
        let chain = |i: usize, j: usize| match i.abs_diff(j) {
            0 => 2.0,
            1 => -1.0,
            _ => 0.0,
        };
        let pairs = gram_eigenpairs(&columns).expect("finite");
        assert_eq!(pairs.len(), size);
        for (k, pair) in pairs.iter().enumerate() {
            let angle = (k + 1) as f64 * std::f64::consts::PI / (size + 1) as f64;
            let exact = 2.0 - 2.0 * libm::cos(angle);
            assert!((pair.value - exact).abs() < 1e-14, "{k}: {} {exact}", pair.value);
            for row in 0..size {
                let image: f64 = (0..size).map(|j| chain(row, j) * pair.vector[j]).sum();
                let off = image - pair.value * pair.vector[row];
                assert!(off.abs() < 1e-14, "{k}: {off:e}");
            }
        }
    }

    /// A null vector is found although another combination is as weak as rounding lets a product be.
    #[test]
    fn weak_combinations_of_columns_are_separated() {
        let rows = 50;
        let column =
            |entry: &dyn Fn(f64) -> f64| (0..rows).map(|k| entry(f64::from(k) / 49.0)).collect();
        let columns: Vec<Vec<f64>> =
            vec![column(&|x| 1.0 + 1e-9 * x), column(&|x| 1.0 - 1e-9 * x), column(&|_| 2.0)];
        let pairs = gram_eigenpairs(&columns).expect("finite");
        let null = &pairs[0].vector;
        // The sum of the first two is the third.
        let off = [null[0] - null[1], null[0] + null[2]];
        assert!(off.iter().all(|off| off.abs() < 1e-5), "{null:?}");
        assert!(pairs[0].value < 1e-12 * pairs[1].value && pairs[1].value < 1e-15, "{pairs:?}");
        let sum: f64 = columns.iter().flatten().map(|entry| entry * entry).sum();
        assert!((pairs[2].value / sum - 1.0).abs() < 1e-14);
    }

    #[test]
    fn a_matrix_that_is_not_finite_has_none() {
        assert_eq!(gram_eigenpairs(&[vec![f64::NAN]]), None);
        assert_eq!(gram_eigenpairs(&[]), Some(Vec::new()));
    }
}
