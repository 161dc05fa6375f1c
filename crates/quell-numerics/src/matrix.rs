//! Small dense real matrices in row-major storage.

use core::ops::{Index, IndexMut};

/// A dense real matrix in row-major storage.
#[derive(Clone, Debug, PartialEq)]
pub struct Matrix {
    rows: usize,
    columns: usize,
    values: Vec<f64>,
}

impl Matrix {
    /// The zero matrix.
    pub fn zeros(rows: usize, columns: usize) -> Self {
        Self { rows, columns, values: vec![0.0; rows * columns] }
    }

    /// The identity matrix.
    pub fn identity(size: usize) -> Self {
        Self::from_fn(size, size, |i, j| f64::from(u8::from(i == j)))
    }

    /// The matrix whose entry (i, j) is given by a function of i and j.
    pub fn from_fn(rows: usize, columns: usize, entry: impl Fn(usize, usize) -> f64) -> Self {
        let values = (0..rows * columns).map(|at| entry(at / columns, at % columns)).collect();
        Self { rows, columns, values }
    }

    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// Number of columns.
    pub fn columns(&self) -> usize {
        self.columns
    }

    /// Row i.
    pub fn row(&self, i: usize) -> &[f64] {
        &self.values[i * self.columns..(i + 1) * self.columns]
    }

    /// Mutable row i.
    pub fn row_mut(&mut self, i: usize) -> &mut [f64] {
        &mut self.values[i * self.columns..(i + 1) * self.columns]
    }

    /// All entries in row-major order.
    pub fn as_slice(&self) -> &[f64] {
        &self.values
    }

    /// All entries in row-major order, mutable.
    pub fn as_mut_slice(&mut self) -> &mut [f64] {
        &mut self.values
    }

    /// The transpose.
    #[must_use]
    pub fn transpose(&self) -> Self {
        Self::from_fn(self.columns, self.rows, |i, j| self[(j, i)])
    }

    /// The product with a matrix that has as many rows as this one has columns; each entry is summed
    /// from the first term to the last.
    ///
    /// # Panics
    /// If the sizes do not match.
    #[must_use]
    pub fn times(&self, other: &Self) -> Self {
        assert_eq!(self.columns, other.rows, "sizes of a product");
        let mut product = Self::zeros(self.rows, other.columns);
        for i in 0..self.rows {
            for (k, &factor) in self.row(i).iter().enumerate() {
                if factor != 0.0 {
                    for (sum, &term) in product.row_mut(i).iter_mut().zip(other.row(k)) {
                        *sum += factor * term;
                    }
                }
            }
        }
        product
    }

    /// Adds `factor` times another matrix of the same size.
    pub fn add_scaled(&mut self, factor: f64, other: &Self) {
        debug_assert_eq!((self.rows, self.columns), (other.rows, other.columns));
        for (entry, term) in self.values.iter_mut().zip(&other.values) {
            *entry += factor * term;
        }
    }

    /// Adds `factor`·v vᵀ to a square matrix of the size of v.
    pub fn add_outer(&mut self, factor: f64, vector: &[f64]) {
        for (i, left) in vector.iter().enumerate() {
            for (entry, right) in self.row_mut(i).iter_mut().zip(vector) {
                *entry += factor * left * right;
            }
        }
    }

    /// Square root of the sum of squares of all entries.
    pub fn frobenius_norm(&self) -> f64 {
        self.values.iter().map(|value| value * value).sum::<f64>().sqrt()
    }

    /// Largest magnitude of an entry.
    pub fn largest(&self) -> f64 {
        self.values.iter().fold(0.0, |largest, value| value.abs().max(largest))
    }

    /// Whether every entry is finite.
    pub fn is_finite(&self) -> bool {
        self.values.iter().all(|value| value.is_finite())
    }

    /// Solves A X = B by elimination with partial pivoting; `None` if a pivot vanishes.
    ///
    /// # Panics
    /// If this matrix is not square or B has a different number of rows.
    pub fn solve(&self, right: &Self) -> Option<Self> {
        assert!(self.rows == self.columns && self.rows == right.rows, "sizes of a system");
        let n = self.rows;
        let (mut a, mut x) = (self.clone(), right.clone());
        for k in 0..n {
            let pivot = (k..n).max_by(|&i, &j| a[(i, k)].abs().total_cmp(&a[(j, k)].abs()))?;
            if a[(pivot, k)] == 0.0 || !a[(pivot, k)].is_finite() {
                return None;
            }
            a.swap_rows(k, pivot);
            x.swap_rows(k, pivot);
            for i in k + 1..n {
                let factor = a[(i, k)] / a[(k, k)];
                if factor != 0.0 {
                    a.subtract_row(i, k, factor);
                    x.subtract_row(i, k, factor);
                }
            }
        }
        for k in (0..n).rev() {
            let pivot = a[(k, k)];
            for value in x.row_mut(k) {
                *value /= pivot;
            }
            for i in 0..k {
                let factor = a[(i, k)];
                if factor != 0.0 {
                    x.subtract_row(i, k, factor);
                }
            }
        }
        Some(x)
    }

    fn swap_rows(&mut self, i: usize, j: usize) {
        if i != j {
            let (low, high) = (i.min(j), i.max(j));
            let (head, tail) = self.values.split_at_mut(high * self.columns);
            head[low * self.columns..(low + 1) * self.columns]
                .swap_with_slice(&mut tail[..self.columns]);
        }
    }

    /// Subtracts `factor` times row `from` from row `i`.
    fn subtract_row(&mut self, i: usize, from: usize, factor: f64) {
        for j in 0..self.columns {
            self.values[i * self.columns + j] -= factor * self.values[from * self.columns + j];
        }
    }
}

impl Index<(usize, usize)> for Matrix {
    type Output = f64;

    fn index(&self, (i, j): (usize, usize)) -> &f64 {
        &self.values[i * self.columns + j]
    }
}

impl IndexMut<(usize, usize)> for Matrix {
    fn index_mut(&mut self, (i, j): (usize, usize)) -> &mut f64 {
        &mut self.values[i * self.columns + j]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn systems_with_zero_pivots_are_solved() {
        let a =
            Matrix::from_fn(3, 3, |i, j| [[0.0, 2.0, 1.0], [1.0, 0.0, 3.0], [4.0, 1.0, 0.0]][i][j]);
        let x = Matrix::from_fn(3, 2, |i, j| f64::from(u8::try_from(2 * i + j).expect("small")));
        let solved = a.solve(&a.times(&x)).expect("regular");
        for (value, wanted) in solved.as_slice().iter().zip(x.as_slice()) {
            assert!((value - wanted).abs() < 1e-14, "{value} {wanted}");
        }
        assert!(Matrix::zeros(2, 2).solve(&Matrix::identity(2)).is_none());
    }
}
