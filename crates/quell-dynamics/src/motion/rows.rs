//! Sparse rows and columns over the state: modal structures have few entries in a row, and a step of theirs costs O(n) per order.

use quell_numerics::matrix::Matrix;

/// Entries of a row or of a column, with their places in the state.
#[derive(Clone, Debug, Default)]
pub(super) struct Entries(Vec<(usize, f64)>);

impl Entries {
    /// The entries of `values` that are not zero, moved by `offset` places.
    pub(super) fn at(values: &[f64], offset: usize) -> Self {
        let places = values.iter().enumerate().filter(|(_, value)| **value != 0.0);
        Self(places.map(|(place, value)| (place + offset, *value)).collect())
    }

    /// The entries times a factor.
    pub(super) fn times(mut self, factor: f64) -> Self {
        self.0.iter_mut().for_each(|(_, value)| *value *= factor);
        self
    }

    /// The sum of two rows.
    pub(super) fn plus(mut self, other: Self) -> Self {
        for (place, value) in other.0 {
            match self.0.iter_mut().find(|(at, _)| *at == place) {
                Some((_, own)) => *own += value,
                None => self.0.push((place, value)),
            }
        }
        self
    }

    /// The row times a state.
    #[inline(always)]
    pub(super) fn dot(&self, state: &[f64]) -> f64 {
        let mut sum = 0.0;
        for &(place, value) in &self.0 {
            sum = f64::mul_add(value, state[place], sum);
        }
        sum
    }

    /// Σ |rᵢxᵢ|, which bounds the rounding of [`Entries::dot`].
    pub(super) fn size_at(&self, state: &[f64]) -> f64 {
        self.0.iter().map(|(place, value)| (value * state[*place]).abs()).sum()
    }

    /// Adds `factor` times the column to a state.
    #[inline(always)]
    pub(super) fn add_to(&self, factor: f64, state: &mut [f64]) {
        for &(place, value) in &self.0 {
            state[place] = f64::mul_add(value, factor, state[place]);
        }
    }

    /// The product of a row and a column.
    pub(super) fn product(&self, column: &Self) -> f64 {
        let other = |place| column.0.iter().find(|(at, _)| *at == place).map_or(0.0, |(_, v)| *v);
        self.0.iter().map(|(place, value)| value * other(*place)).sum()
    }

    /// Whether there is no entry.
    pub(super) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// All numbers, `size` of them.
    pub(super) fn dense(&self, size: usize) -> Vec<f64> {
        let mut values = vec![0.0; size];
        self.add_to(1.0, &mut values);
        values
    }
}

/// A matrix by its rows, without zeros.
#[derive(Clone, Debug)]
pub(super) struct SparseMatrix {
    /// Where each row begins in `entries`, and the end of the last.
    starts: Vec<usize>,
    entries: Vec<(usize, f64)>,
}

impl SparseMatrix {
    pub(super) fn of(matrix: &Matrix) -> Self {
        let (mut starts, mut entries) = (vec![0], Vec::new());
        for i in 0..matrix.rows() {
            let row = matrix.row(i).iter().enumerate();
            entries.extend(row.filter(|(_, value)| **value != 0.0).map(|(j, value)| (j, *value)));
            starts.push(entries.len());
        }
        Self { starts, entries }
    }

    /// Writes the matrix times a state to `out`.
    #[inline(always)]
    pub(super) fn times(&self, state: &[f64], out: &mut [f64]) {
        for (i, result) in out.iter_mut().enumerate() {
            let mut sum = 0.0;
            for &(place, value) in &self.entries[self.starts[i]..self.starts[i + 1]] {
                sum = f64::mul_add(value, state[place], sum);
            }
            *result = sum;
        }
    }
}
