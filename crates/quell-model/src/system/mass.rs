//! The mass matrix: a base and point masses attached to it.
//!
//! M = M₀ + Σ m u uᵀ. A modal structure has M₀ = I, with few attached masses, so that its inverse costs O(n) per
//! column (Woodbury): (I + Σ m u uᵀ)⁻¹ = I − W (D⁻¹ + WᵀW)⁻¹ Wᵀ, W the rows u as columns and D the masses.

use quell_numerics::matrix::Matrix;

/// A symmetric, positive definite mass matrix.
#[derive(Clone, Debug, PartialEq)]
pub struct MassMatrix {
    size: usize,
    /// M₀; `None` for the identity.
    base: Option<Matrix>,
    /// Attached masses m > 0 and their rows u.
    attached: Vec<(f64, Vec<f64>)>,
}

impl MassMatrix {
    /// I, the mass of modes of unit norm.
    pub fn identity(size: usize) -> Self {
        Self { size, base: None, attached: Vec::new() }
    }

    /// A square matrix, symmetric and positive definite.
    pub fn dense(matrix: Matrix) -> Self {
        Self { size: matrix.rows(), base: Some(matrix), attached: Vec::new() }
    }

    /// The same matrix plus m u uᵀ: a mass m that moves with the displacement uᵀq. Nothing for m = 0.
    #[must_use]
    pub fn attach(mut self, mass: f64, row: Vec<f64>) -> Self {
        if mass > 0.0 {
            self.attached.push((mass, row));
        }
        self
    }

    /// Number of rows.
    pub fn size(&self) -> usize {
        self.size
    }

    /// The entries of its diagonal.
    pub fn diagonal(&self) -> Vec<f64> {
        let entry = |i: usize| {
            let base = self.base.as_ref().map_or(1.0, |base| base[(i, i)]);
            self.attached.iter().fold(base, |sum, (mass, row)| (mass * row[i]).mul_add(row[i], sum))
        };
        (0..self.size).map(entry).collect()
    }

    /// M, all entries.
    pub fn matrix(&self) -> Matrix {
        let mut matrix = self.base.clone().unwrap_or_else(|| Matrix::identity(self.size));
        for (mass, row) in &self.attached {
            matrix.add_outer(*mass, row);
        }
        matrix
    }

    /// M⁻¹ times a matrix; `None` where M is singular.
    pub fn solve(&self, right: &Matrix) -> Option<Matrix> {
        if self.base.is_some() {
            return self.matrix().solve(right);
        }
        let columns = Matrix::from_fn(self.size, self.attached.len(), |i, l| self.attached[l].1[i]);
        let mut small = columns.transpose().times(&columns);
        for (l, (mass, _)) in self.attached.iter().enumerate() {
            small[(l, l)] += 1.0 / mass;
        }
        let small = small.solve(&Matrix::identity(self.attached.len()))?;
        let mut result = right.clone();
        if small.rows() > 0 {
            let along = columns.transpose().times(right);
            result.add_scaled(-1.0, &columns.times(&small.times(&along)));
        }
        Some(result)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_ways_to_the_inverse_agree() {
        let rows = [vec![0.6, 0.9, -0.2], vec![0.1, -0.4, 1.3]];
        let modal =
            MassMatrix::identity(3).attach(0.3, rows[0].clone()).attach(2.5, rows[1].clone());
        let dense = MassMatrix::dense(modal.matrix());
        let right = Matrix::from_fn(3, 2, |i, j| (1 + i) as f64 - 2.0 * j as f64);
        let (by_rank, by_elimination) = (modal.solve(&right), dense.solve(&right));
        let (by_rank, by_elimination) =
            (by_rank.expect("regular"), by_elimination.expect("regular"));
        for (a, b) in by_rank.as_slice().iter().zip(by_elimination.as_slice()) {
            assert!((a - b).abs() < 1e-14, "{a} {b}");
        }
        let back = modal.matrix().times(&by_rank);
        for (a, b) in back.as_slice().iter().zip(right.as_slice()) {
            assert!((a - b).abs() < 1e-14, "{a} {b}");
        }
        assert_eq!(MassMatrix::identity(3).attach(0.0, rows[0].clone()), MassMatrix::identity(3));
    }
}
