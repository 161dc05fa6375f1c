//! Eigenvalues of a symmetric pencil: M x = μ K x with K positive definite.
//!
//! K = L Lᵀ (Cholesky), then the eigenvalues of the symmetric L⁻¹ M L⁻ᵀ, which Householder reflectors make tridiagonal.
//! The largest μ are accurate to a few rounding errors relative to the largest one: if the smallest values are needed, solve
//! for their reciprocals (K the stiffness, M the mass: μ = 1/ω²).

use num_complex::Complex64;

use crate::dispatch::{Work, with_fused_multiply_add};
use crate::eigen::{Tridiagonal, hessenberg_bands};
use crate::groups::dot;
use crate::matrix::Matrix;
use crate::order::ascending;

/// Symmetric matrix that is assembled entry by entry; only the lower triangle is stored.
#[derive(Debug, Clone)]
pub struct SymmetricMatrix {
    lower: Matrix,
}

impl SymmetricMatrix {
    /// The zero matrix of `size` rows.
    #[must_use]
    pub fn zeros(size: usize) -> Self {
        Self { lower: Matrix::zeros(size, size) }
    }

    /// Number of rows.
    #[must_use]
    pub fn size(&self) -> usize {
        self.lower.rows()
    }

    /// Adds `value` to the entries (i, j) and (j, i); an entry outside the matrix is ignored.
    pub fn add(&mut self, i: usize, j: usize, value: f64) {
        let (row, column) = (i.max(j), i.min(j));
        if row < self.size() {
            self.lower[(row, column)] += value;
        }
    }

    /// The lower triangular L of L Lᵀ; `None` if the matrix is not positive definite.
    #[inline(always)]
    fn cholesky(&self) -> Option<Matrix> {
        let mut factor = Matrix::zeros(self.size(), self.size());
        for i in 0..self.size() {
            for j in 0..=i {
                let rest = self.lower[(i, j)] - dot(&factor.row(i)[..j], &factor.row(j)[..j]);
                factor[(i, j)] = if i > j {
                    rest / factor[(j, j)]
                } else if rest > 0.0 {
                    rest.sqrt()
                } else {
                    return None;
                };
            }
        }
        Some(factor)
    }
}

/// All μ with M x = μ K x, ascending; `None` if K is not positive definite, the sizes differ, or an entry is not finite.
#[must_use]
pub fn pencil_eigenvalues(m: &SymmetricMatrix, k: &SymmetricMatrix) -> Option<Vec<f64>> {
    let size = k.size();
    if m.size() != size {
        return None;
    }
    let reduced = with_fused_multiply_add(PencilReduction { m, k })?;
    let (diagonal, beside) = hessenberg_bands(&reduced)?;
    let complex = |value: f64| Complex64::new(value, 0.0);
    let tridiagonal = Tridiagonal {
        diagonal: diagonal.into_iter().map(complex).collect(),
        across: beside.into_iter().map(|entry| complex(entry * entry)).collect(),
    };
    let mut values: Vec<f64> = tridiagonal.eigenvalues().ok()?.iter().map(|z| z.re).collect();
    ascending(&mut values);
    Some(values)
}

/// L⁻¹ M L⁻ᵀ; `None` if K is not positive definite.
struct PencilReduction<'a> {
    m: &'a SymmetricMatrix,
    k: &'a SymmetricMatrix,
}

impl Work for PencilReduction<'_> {
    type Output = Option<Matrix>;

    #[inline(always)]
    fn run(self) -> Self::Output {
        let Self { m, k } = self;
        let factor = k.cholesky()?;
        let full = Matrix::from_fn(k.size(), k.size(), |i, j| m.lower[(i.max(j), i.min(j))]);
        // M is symmetric: its rows are its columns, and those of the transpose of L⁻¹ M are the rows of M L⁻ᵀ.
        let half = rows_solved(&factor, full).transpose();
        Some(rows_solved(&factor, half))
    }
}

/// L⁻¹ applied to every row of a matrix.
#[inline(always)]
fn rows_solved(factor: &Matrix, mut rows: Matrix) -> Matrix {
    for row in 0..rows.rows() {
        let row = rows.row_mut(row);
        for i in 0..row.len() {
            let rest = row[i] - dot(&factor.row(i)[..i], &row[..i]);
            row[i] = rest / factor[(i, i)];
        }
    }
    rows
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
            let exact = 4.0 * libm::sin(angle) * libm::sin(angle);
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
