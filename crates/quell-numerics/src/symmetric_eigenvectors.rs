//! Eigenvalues and eigenvectors of a small symmetric matrix by Jacobi's rotations.
//!
//! Each sweep turns every off-diagonal entry to zero once (Golub and Van Loan, *Matrix Computations*, §8.5). The sums have a fixed order, so
//! that the result has the same bits everywhere. For matrices of a few dozen rows.

use crate::matrix::Matrix;
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

/// The eigenpairs of a symmetric matrix by ascending eigenvalue; `None` if an entry is not finite.
pub fn symmetric_eigenpairs(matrix: &Matrix) -> Option<Vec<Eigenpair>> {
    if !matrix.is_finite() {
        return None;
    }
    let size = matrix.rows();
    let mut own = matrix.clone();
    let mut vectors = Matrix::identity(size);
    for _ in 0..SWEEPS {
        let mut turned = false;
        for p in 0..size {
            for q in p + 1..size {
                let entry = own[(p, q)];
                if entry.abs() <= f64::EPSILON * 1e-3 * (own[(p, p)] * own[(q, q)]).abs().sqrt() {
                    continue;
                }
                turned = true;
                rotate(&mut own, &mut vectors, (p, q));
            }
        }
        if !turned {
            break;
        }
    }
    let mut pairs: Vec<Eigenpair> = (0..size)
        .map(|k| Eigenpair {
            value: own[(k, k)],
            vector: (0..size).map(|row| vectors[(row, k)]).collect(),
        })
        .collect();
    ascending_by(&mut pairs, |a| a.value);
    Some(pairs)
}

/// Turns the entry (p, q) to zero.
fn rotate(own: &mut Matrix, vectors: &mut Matrix, (p, q): (usize, usize)) {
    let theta = (own[(q, q)] - own[(p, p)]) / (2.0 * own[(p, q)]);
    let tangent = theta.signum() / (theta.abs() + libm::hypot(theta, 1.0));
    let cosine = 1.0 / libm::hypot(tangent, 1.0);
    let sine = tangent * cosine;
    for k in 0..own.rows() {
        let (a, b) = (own[(k, p)], own[(k, q)]);
        own[(k, p)] = cosine * a - sine * b;
        own[(k, q)] = sine * a + cosine * b;
    }
    for k in 0..own.rows() {
        let (a, b) = (own[(p, k)], own[(q, k)]);
        own[(p, k)] = cosine * a - sine * b;
        own[(q, k)] = sine * a + cosine * b;
        let (a, b) = (vectors[(k, p)], vectors[(k, q)]);
        vectors[(k, p)] = cosine * a - sine * b;
        vectors[(k, q)] = sine * a + cosine * b;
    }
    own[(p, q)] = 0.0;
    own[(q, p)] = 0.0;
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_pairs_of_a_chain_are_the_known_ones() {
        // 2 on the diagonal, −1 next to it: λ_k = 2 − 2 cos(kπ/(n + 1)).
        let size = 9;
        let chain = Matrix::from_fn(size, size, |i, j| match i.abs_diff(j) {
            0 => 2.0,
            1 => -1.0,
            _ => 0.0,
        });
        let pairs = symmetric_eigenpairs(&chain).expect("finite");
        for (k, pair) in pairs.iter().enumerate() {
            let angle = (k + 1) as f64 * std::f64::consts::PI / (size + 1) as f64;
            assert!((pair.value - (2.0 - 2.0 * libm::cos(angle))).abs() < 1e-14);
            for row in 0..size {
                let image: f64 = (0..size).map(|j| chain[(row, j)] * pair.vector[j]).sum();
                assert!((image - pair.value * pair.vector[row]).abs() < 1e-14);
            }
        }
    }

    #[test]
    fn a_matrix_that_is_not_finite_has_none() {
        assert_eq!(symmetric_eigenpairs(&Matrix::from_fn(2, 2, |_, _| f64::NAN)), None);
        assert_eq!(symmetric_eigenpairs(&Matrix::zeros(0, 0)), Some(Vec::new()));
    }
}
