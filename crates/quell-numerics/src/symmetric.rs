//! Eigenvalues of a symmetric pencil: M x = μ K x with K positive definite.
//!
//! K = L Lᵀ (Cholesky), then the eigenvalues of the symmetric L⁻¹ M L⁻ᵀ, by the crate `faer`, on one thread.
//! The largest μ are accurate to a few rounding errors relative to the largest one: if the smallest values are needed, solve
//! for their reciprocals (K the stiffness, M the mass: μ = 1/ω²).

use faer::linalg::triangular_solve::solve_lower_triangular_in_place;
use faer::{Mat, Par, Side};

/// Symmetric matrix that is assembled entry by entry; only the lower triangle is stored.
#[derive(Debug, Clone)]
pub struct SymmetricMatrix {
    lower: Mat<f64>,
}

impl SymmetricMatrix {
    /// The zero matrix of `size` rows.
    #[must_use]
    pub fn zeros(size: usize) -> Self {
        Self { lower: Mat::zeros(size, size) }
    }

    /// Number of rows.
    #[must_use]
    pub fn size(&self) -> usize {
        self.lower.nrows()
    }

    /// Adds `value` to the entries (i, j) and (j, i); an entry outside the matrix is ignored.
    pub fn add(&mut self, i: usize, j: usize, value: f64) {
        let (row, column) = (i.max(j), i.min(j));
        if row < self.size() {
            self.lower[(row, column)] += value;
        }
    }
}

/// All μ with M x = μ K x, ascending; `None` if K is not positive definite, the sizes differ, or an entry is not finite.
#[must_use]
pub fn pencil_eigenvalues(m: &SymmetricMatrix, k: &SymmetricMatrix) -> Option<Vec<f64>> {
    let size = k.size();
    if m.size() != size {
        return None;
    }
    if size == 0 {
        return Some(Vec::new());
    }
    let factor = k.lower.llt(Side::Lower).ok()?;
    let mut full = Mat::from_fn(size, size, |i, j| m.lower[(i.max(j), i.min(j))]);
    solve_lower_triangular_in_place(factor.L(), full.as_mut(), Par::Seq);
    let mut transposed = full.transpose().to_owned();
    solve_lower_triangular_in_place(factor.L(), transposed.as_mut(), Par::Seq);
    let values = transposed.self_adjoint_eigenvalues(Side::Lower).ok()?;
    values.iter().all(|value| value.is_finite()).then_some(values)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A chain of equal masses and springs fixed at one end: ω² = 4 sin²((2j − 1)π/(2(2n + 1))).
    #[test]
    fn frequencies_of_a_chain_of_masses() {
        let size = 30;
        let (mut mass, mut stiffness) =
            (SymmetricMatrix::zeros(size), SymmetricMatrix::zeros(size));
        for i in 0..size {
            mass.add(i, i, 1.0);
            stiffness.add(i, i, if i + 1 == size { 1.0 } else { 2.0 });
            if i > 0 {
                stiffness.add(i - 1, i, -1.0);
            }
        }
        let values = pencil_eigenvalues(&mass, &stiffness).expect("positive definite");
        for (j, value) in values.iter().rev().enumerate() {
            let angle = (2 * j + 1) as f64 * core::f64::consts::PI / (2.0 * (2 * size + 1) as f64);
            let exact = 4.0 * angle.sin().powi(2);
            assert!((1.0 / value / exact - 1.0).abs() < 1e-12, "{j}: {} {exact}", 1.0 / value);
        }
    }

    #[test]
    fn indefinite_matrices_are_rejected() {
        let mut indefinite = SymmetricMatrix::zeros(2);
        indefinite.add(0, 0, 1.0);
        indefinite.add(1, 1, -1.0);
        assert!(pencil_eigenvalues(&SymmetricMatrix::zeros(2), &indefinite).is_none());
        assert!(pencil_eigenvalues(&SymmetricMatrix::zeros(3), &indefinite).is_none());
    }
}
