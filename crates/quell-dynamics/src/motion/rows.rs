//! Rows and columns over the state, and the state matrix, each in the form that costs least: a step of a modal structure costs O(n)
//! per order, a step of a small one a few vector instructions.
//!
//! The equations of a step are written once, over [`StateStorage`]: with [`FewStates`] the length of the state is known at compile
//! time, so that the state and its rates stay in registers.

use quell_numerics::lane::Lane;
use quell_numerics::matrix::Matrix;

/// RowEntries of a row or of a column over the state.
#[derive(Clone, Debug, Default)]
pub(super) struct RowEntries {
    /// Place of the first value.
    start: usize,
    /// Values without gaps.
    values: Vec<f64>,
    /// RowEntries with gaps, instead of values.
    scattered: Vec<(usize, f64)>,
    /// All numbers of a row over at most [`SMALL`] states.
    dense: [f64; SMALL],
}

/// Share of zeros in a range above which its entries are kept apart.
const SCATTERED: usize = 4;

impl RowEntries {
    /// The entries of `values` that are not zero, moved by `offset` places.
    pub(super) fn at(values: &[f64], offset: usize) -> Self {
        let nonzero = |value: &f64| *value != 0.0;
        let (Some(first), Some(last)) =
            (values.iter().position(nonzero), values.iter().rposition(nonzero))
        else {
            return Self::default();
        };
        let mut dense = [0.0; SMALL];
        if let Some(dense) = dense.get_mut(offset..offset + values.len()) {
            dense.copy_from_slice(values);
        }
        let count = values.iter().filter(|value| nonzero(value)).count();
        if last + 1 - first > SCATTERED * count {
            let places = values.iter().enumerate().filter(|(_, value)| nonzero(value));
            let scattered = places.map(|(place, value)| (place + offset, *value)).collect();
            return Self { start: 0, values: Vec::new(), scattered, dense };
        }
        let start = first + offset;
        Self { start, values: values[first..=last].to_vec(), scattered: Vec::new(), dense }
    }

    /// Whether there is no entry.
    #[inline(always)]
    pub(super) fn is_empty(&self) -> bool {
        self.values.is_empty() && self.scattered.is_empty()
    }

    /// The row times a state.
    #[inline(always)]
    pub(super) fn dot(&self, state: &[f64]) -> f64 {
        if self.scattered.is_empty() {
            return dot(&self.values, &state[self.start..self.start + self.values.len()]);
        }
        let mut sum = 0.0;
        for &(place, value) in &self.scattered {
            sum = f64::mul_add(value, state[place], sum);
        }
        sum
    }

    /// All numbers over at most [`SMALL`] states, and zeros after them.
    pub(super) fn few(&self) -> &[f64; SMALL] {
        &self.dense
    }

    /// Σ |rᵢxᵢ|, which bounds the rounding of [`RowEntries::dot`].
    pub(super) fn size_at(&self, state: &[f64]) -> f64 {
        self.pairs().map(|(place, value)| (value * state[place]).abs()).sum()
    }

    /// Adds `factor` times the column to a state.
    #[inline(always)]
    pub(super) fn add_to(&self, factor: f64, state: &mut [f64]) {
        let range = &mut state[self.start..self.start + self.values.len()];
        for (entry, value) in range.iter_mut().zip(&self.values) {
            *entry = f64::mul_add(*value, factor, *entry);
        }
        for &(place, value) in &self.scattered {
            state[place] = f64::mul_add(value, factor, state[place]);
        }
    }

    /// The product of a row and a column.
    pub(super) fn product(&self, column: &Self) -> f64 {
        self.pairs().map(|(place, value)| value * column.entry(place)).sum()
    }

    /// The number at a place.
    fn entry(&self, place: usize) -> f64 {
        if self.scattered.is_empty() {
            let inside = place.checked_sub(self.start).and_then(|inside| self.values.get(inside));
            return inside.copied().unwrap_or(0.0);
        }
        let found = self.scattered.binary_search_by_key(&place, |(at, _)| *at);
        found.map_or(0.0, |found| self.scattered[found].1)
    }

    /// All numbers, `size` of them.
    pub(super) fn dense(&self, size: usize) -> Vec<f64> {
        let mut values = vec![0.0; size];
        self.add_to(1.0, &mut values);
        values
    }

    /// Its places with their values.
    pub(super) fn pairs(&self) -> impl Iterator<Item = (usize, f64)> {
        let values = self.values.iter().enumerate();
        let values = values.map(|(place, value)| (self.start + place, *value));
        values.chain(self.scattered.iter().copied())
    }
}

/// Σ aᵢbᵢ in eight partial sums.
#[inline(always)]
fn dot(a: &[f64], b: &[f64]) -> f64 {
    if let ([a], [b]) = (a, b) {
        return a * b;
    }
    let mut sums = [0.0; 8];
    let (heads, tail) = a.as_chunks::<8>();
    let (others, rest) = b.as_chunks::<8>();
    for (a, b) in heads.iter().zip(others) {
        for lane in 0..8 {
            sums[lane] = f64::mul_add(a[lane], b[lane], sums[lane]);
        }
    }
    for (lane, (a, b)) in tail.iter().zip(rest).enumerate() {
        sums[lane % 8] = f64::mul_add(*a, *b, sums[lane % 8]);
    }
    ((sums[0] + sums[4]) + (sums[1] + sums[5])) + ((sums[2] + sums[6]) + (sums[3] + sums[7]))
}

/// The state matrix without the contacts.
#[derive(Clone, Debug)]
pub(super) enum StateMatrix {
    /// q̇ᵢ = vᵢ, v̇ᵢ = −kᵢqᵢ − cᵢvᵢ: the diagonals k and c.
    Modal(Vec<f64>, Vec<f64>),
    /// Few states: the columns, one after the other.
    Small(Vec<f64>),
    /// Many states and few zeros: the columns in the same way. Each row is summed in the order of [`StateMatrix::Sparse`], whose bits it
    /// has, but side by side with others.
    Dense(Vec<f64>),
    /// Where each row begins in the entries, and the end of the last.
    Sparse(Vec<usize>, Vec<(usize, f64)>),
}

/// Largest number of states of [`StateMatrix::Small`].
const SMALL: usize = 8;

/// Entries that [`StateMatrix::Dense`] multiplies in the time of one of [`StateMatrix::Sparse`], which waits for the sum before it.
const SIDE_BY_SIDE: usize = 6;

impl StateMatrix {
    /// The columns of a matrix of `size` states, one after the other; `None` if it has another size.
    #[inline(always)]
    pub(super) fn columns(&self, size: usize) -> Option<&[f64]> {
        let Self::Small(columns) = self else { return None };
        (columns.len() == size * size).then_some(&columns[..])
    }

    pub(super) fn of(matrix: &Matrix) -> Self {
        let size = matrix.rows();
        if size <= SMALL {
            let entries = (0..size * size).map(|at| matrix[(at % size, at / size)]);
            return Self::Small(entries.collect());
        }
        if let Some((stiffness, damping)) = modal(matrix) {
            return Self::Modal(stiffness, damping);
        }
        let (mut starts, mut entries) = (vec![0], Vec::new());
        for i in 0..size {
            let row = matrix.row(i).iter().enumerate();
            entries.extend(row.filter(|(_, value)| **value != 0.0).map(|(j, value)| (j, *value)));
            starts.push(entries.len());
        }
        if SIDE_BY_SIDE * entries.len() > size * size {
            return Self::Dense(
                (0..size * size).map(|at| matrix[(at % size, at / size)]).collect(),
            );
        }
        Self::Sparse(starts, entries)
    }

    /// Time of a step over that of one mass, roughly: a part of it is the same for every number of states.
    pub(super) fn work(&self) -> f64 {
        /// Entries, one after the other, that take as long as the rest of the step of one mass.
        const REST: f64 = 16.0;
        let entries = match self {
            Self::Modal(stiffness, _) => stiffness.len(),
            Self::Small(columns) | Self::Dense(columns) => columns.len() / SIDE_BY_SIDE,
            Self::Sparse(_, entries) => entries.len(),
        };
        1.0 + entries as f64 / REST
    }

    /// Writes the matrix times a state to `out`.
    #[inline(always)]
    pub(super) fn times(&self, state: &[f64], out: &mut [f64]) {
        match self {
            Self::Modal(stiffness, damping) => {
                let (displacements, velocities) = state.split_at(stiffness.len());
                let (upper, lower) = out.split_at_mut(stiffness.len());
                upper.copy_from_slice(velocities);
                let moving = displacements.iter().zip(velocities);
                let numbers = stiffness.iter().zip(damping);
                for ((out, (q, v)), (k, c)) in lower.iter_mut().zip(moving).zip(numbers) {
                    *out = f64::mul_add(-k, *q, -(c * v));
                }
            }
            Self::Small(columns) => match state.len() {
                1 => small::<1>(columns, state, out),
                2 => small::<2>(columns, state, out),
                3 => small::<3>(columns, state, out),
                4 => small::<4>(columns, state, out),
                5 => small::<5>(columns, state, out),
                6 => small::<6>(columns, state, out),
                7 => small::<7>(columns, state, out),
                _ => small::<8>(columns, state, out),
            },
            Self::Dense(columns) => {
                out.fill(0.0);
                for (column, entry) in columns.chunks_exact(state.len()).zip(state) {
                    for (sum, value) in out.iter_mut().zip(column) {
                        *sum = f64::mul_add(*value, *entry, *sum);
                    }
                }
            }
            Self::Sparse(starts, entries) => {
                for (i, result) in out.iter_mut().enumerate() {
                    let mut sum = 0.0;
                    for &(place, value) in &entries[starts[i]..starts[i + 1]] {
                        sum = f64::mul_add(value, state[place], sum);
                    }
                    *result = sum;
                }
            }
        }
    }
}

/// Σ columns times entries, in registers.
#[inline(always)]
fn small<const N: usize>(columns: &[f64], state: &[f64], out: &mut [f64]) {
    out[..N].copy_from_slice(&product(columns.as_chunks::<N>().0, state));
}

/// Σ columns times entries.
#[inline(always)]
fn product<const N: usize>(columns: &[[f64; N]], state: &[f64]) -> [f64; N] {
    let mut sums = [0.0; N];
    for (column, entry) in columns.iter().zip(state) {
        for i in 0..N {
            sums[i] = f64::mul_add(column[i], *entry, sums[i]);
        }
    }
    sums
}

/// How the equations of a step read rows and columns over the state, and the state matrix.
pub(super) trait StateStorage: Copy {
    /// Numbers over the state that last for one step.
    type Buffer: AsMut<[f64]>;

    /// Whether the matrix may depend on a speed over time: the others are for constant matrices, and have no code for it.
    const TAKES_SPEED: bool = false;

    /// Length of the state.
    fn size(self) -> usize;

    /// A buffer, from the memory that is kept between steps where there is no better place.
    fn buffer(self, kept: &mut Vec<f64>) -> Self::Buffer;

    /// Returns the memory of a buffer, which is on the stack where it is not kept.
    #[inline(always)]
    fn keep(self, _: Self::Buffer, _: &mut Vec<f64>) {}

    /// A row times a state.
    fn dot(self, row: &RowEntries, state: &[f64]) -> f64;

    /// Adds `factor` times a column to a state.
    fn add(self, column: &RowEntries, factor: f64, state: &mut [f64]);

    /// Writes the state matrix times a state to `out`.
    fn times(self, state: &[f64], out: &mut [f64]);
}

/// Any number of states.
#[derive(Clone, Copy, Debug)]
pub(super) struct ManyStates<'a> {
    pub(super) size: usize,
    pub(super) matrix: &'a StateMatrix,
    /// Whether products of rows have the bits of [`SmallStates`].
    pub(super) by_halves: bool,
}

impl StateStorage for ManyStates<'_> {
    type Buffer = Vec<f64>;

    const TAKES_SPEED: bool = true;

    #[inline(always)]
    fn size(self) -> usize {
        self.size
    }

    #[inline(always)]
    fn buffer(self, kept: &mut Vec<f64>) -> Vec<f64> {
        std::mem::take(kept)
    }

    #[inline(always)]
    fn keep(self, buffer: Vec<f64>, kept: &mut Vec<f64>) {
        *kept = buffer;
    }

    #[inline(always)]
    fn dot(self, row: &RowEntries, state: &[f64]) -> f64 {
        if self.by_halves {
            return dot_by_halves(&row.dense[..self.size], &state[..self.size]);
        }
        row.dot(state)
    }

    #[inline(always)]
    fn add(self, column: &RowEntries, factor: f64, state: &mut [f64]) {
        column.add_to(factor, state);
    }

    #[inline(always)]
    fn times(self, state: &[f64], out: &mut [f64]) {
        self.matrix.times(state, out);
    }
}

/// `N` states of one run, with the columns of the state matrix, and the bits of [`SmallStates`]. Slices over the state must have this
/// length.
#[derive(Clone, Copy, Debug)]
pub(super) struct FewStates<'a, const N: usize>(&'a [[f64; N]; N]);

impl<'a, const N: usize> FewStates<'a, N> {
    /// The storage of a matrix; `None` if it has another size.
    #[inline(always)]
    pub(super) fn of(matrix: &'a StateMatrix) -> Option<Self> {
        const { assert!(2 <= N && N <= SMALL) };
        matrix.columns(N)?.as_chunks::<N>().0.try_into().ok().map(Self)
    }
}

impl<const N: usize> StateStorage for FewStates<'_, N> {
    type Buffer = [f64; N];

    #[inline(always)]
    fn size(self) -> usize {
        N
    }

    #[inline(always)]
    fn buffer(self, _: &mut Vec<f64>) -> [f64; N] {
        [0.0; N]
    }

    #[inline(always)]
    fn dot(self, row: &RowEntries, state: &[f64]) -> f64 {
        dot_by_halves(&row.dense[..N], &state[..N])
    }

    #[inline(always)]
    fn add(self, column: &RowEntries, factor: f64, state: &mut [f64]) {
        for (entry, value) in state[..N].iter_mut().zip(&column.dense[..N]) {
            *entry = f64::mul_add(*value, factor, *entry);
        }
    }

    #[inline(always)]
    fn times(self, state: &[f64], out: &mut [f64]) {
        out[..N].copy_from_slice(&product(self.0, &state[..N]));
    }
}

/// Up to [`SMALL`] states of one run, as many as there are columns.
#[derive(Clone, Copy, Debug)]
pub(super) struct SmallStates<'a> {
    size: usize,
    columns: &'a [f64],
}

impl<'a> SmallStates<'a> {
    /// The storage of a matrix of `size` states; `None` if it is not [`StateMatrix::Small`], or has an odd number of states, whose bits
    /// are those of [`ManyStates`].
    #[inline(always)]
    pub(super) fn of(matrix: &'a StateMatrix, size: usize) -> Option<Self> {
        let is_even = size >= 2 && size.is_multiple_of(2);
        let columns = matrix.columns(size).filter(|_| is_even)?;
        Some(Self { size, columns })
    }
}

impl StateStorage for SmallStates<'_> {
    type Buffer = [f64; SMALL];

    #[inline(always)]
    fn size(self) -> usize {
        self.size
    }

    #[inline(always)]
    fn buffer(self, _: &mut Vec<f64>) -> [f64; SMALL] {
        [0.0; SMALL]
    }

    #[inline(always)]
    fn dot(self, row: &RowEntries, state: &[f64]) -> f64 {
        dot_by_halves(&row.dense[..self.size], &state[..self.size])
    }

    #[inline(always)]
    fn add(self, column: &RowEntries, factor: f64, state: &mut [f64]) {
        for (entry, value) in state[..self.size].iter_mut().zip(&column.dense) {
            *entry = f64::mul_add(*value, factor, *entry);
        }
    }

    #[inline(always)]
    fn times(self, state: &[f64], out: &mut [f64]) {
        out[..self.size].fill(0.0);
        for (column, entry) in self.columns.chunks_exact(self.size).zip(state) {
            for (sum, value) in out[..self.size].iter_mut().zip(column) {
                *sum = f64::mul_add(*value, *entry, *sum);
            }
        }
    }
}

/// Σ aᵢbᵢ in two partial sums, one of each half.
#[inline(always)]
fn dot_by_halves<V: Lane>(row: &[V], state: &[V]) -> V {
    let (upper, lower) = row.split_at(row.len() / 2);
    let (displacements, velocities) = state.split_at(state.len() / 2);
    let mut sums = [upper[0] * displacements[0], lower[0] * velocities[0]];
    for (value, entry) in upper[1..].iter().zip(&displacements[1..]) {
        sums[0] = value.mul_add(*entry, sums[0]);
    }
    for (value, entry) in lower[1..].iter().zip(&velocities[1..]) {
        sums[1] = value.mul_add(*entry, sums[1]);
    }
    sums[0] + sums[1]
}

/// The diagonals of a mechanical structure of modes, if the matrix is that of one.
fn modal(matrix: &Matrix) -> Option<(Vec<f64>, Vec<f64>)> {
    let size = matrix.rows();
    let half = size / 2;
    if !size.is_multiple_of(2) {
        return None;
    }
    let is_modal = (0..size).all(|i| {
        matrix.row(i).iter().enumerate().all(|(j, value)| match (i < half, j) {
            (true, j) => *value == f64::from(u8::from(j == i + half)),
            (false, j) => *value == 0.0 || j == i || j + half == i,
        })
    });
    let diagonal = |shift: usize| (0..half).map(|i| -matrix[(half + i, shift + i)]).collect();
    is_modal.then(|| (diagonal(0), diagonal(half)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_form_of_the_matrix_gives_its_product() {
        for size in [1, 2, 3, 5, 8, 9, 12] {
            let modal = size == 12;
            let matrix = Matrix::from_fn(size, size, |i, j| match (modal, i < size / 2) {
                (false, _) => (i as f64 - 0.7).mul_add(1.3, j as f64),
                (true, true) => f64::from(u8::from(j == i + size / 2)),
                (true, false) if j == i || j + size / 2 == i => -1.0 - (i + j) as f64,
                (true, false) => 0.0,
            });
            let state: Vec<f64> = (0..size).map(|i| 0.3 * i as f64 - 1.0).collect();
            let mut out = vec![0.0; size];
            let form = StateMatrix::of(&matrix);
            form.times(&state, &mut out);
            assert_eq!(modal, matches!(form, StateMatrix::Modal(..)));
            for (i, value) in out.iter().enumerate() {
                let exact: f64 = matrix.row(i).iter().zip(&state).map(|(a, x)| a * x).sum();
                assert!((value - exact).abs() < 1e-12, "{size}: {value} {exact}");
            }
        }
    }

    #[test]
    fn a_dense_matrix_has_the_bits_of_its_rows_one_after_the_other() {
        // A structure of 9 coordinates: displacements follow velocities, and the other rows have no zeros.
        let matrix = Matrix::from_fn(18, 18, |i, j| {
            let moves = f64::from(u8::from(j == i + 9));
            if i < 9 { moves } else { (0.37 * (i * i) as f64 + 1.9 * j as f64).sin() }
        });
        let state: Vec<f64> = (0..18).map(|i| (0.7 * f64::from(i)).cos()).collect();
        let (mut out, form) = (vec![1.0; 18], StateMatrix::of(&matrix));
        assert!(matches!(form, StateMatrix::Dense(_)));
        form.times(&state, &mut out);
        for (i, value) in out.iter().enumerate() {
            let row = matrix.row(i).iter().zip(&state);
            assert_eq!(*value, row.fold(0.0, |sum, (a, x)| f64::mul_add(*a, *x, sum)));
        }
    }

    /// A row, a column and the matrix in a storage against the form for any number of states.
    fn has_the_bits_of_many<S: StateStorage>(storage: S, form: &StateMatrix) {
        let size = storage.size();
        let many = ManyStates { size, matrix: form, by_halves: true };
        let state: Vec<f64> = (0..size).map(|i| 0.3 * i as f64 - 1.0).collect();
        let values: Vec<f64> = (0..size / 2).map(|i| 1.7 - i as f64).collect();
        for row in [RowEntries::at(&values, size / 2), RowEntries::at(&values, 0)] {
            assert_eq!(storage.dot(&row, &state), many.dot(&row, &state));
            assert!((row.dot(&state) - many.dot(&row, &state)).abs() < 1e-14);
            let (mut left, mut right) = (state.clone(), state.clone());
            storage.add(&row, 0.6, &mut left);
            many.add(&row, 0.6, &mut right);
            assert_eq!(left, right);
        }
        let (mut left, mut right) = (vec![0.0; size], vec![0.0; size]);
        storage.times(&state, &mut left);
        many.times(&state, &mut right);
        assert_eq!(left, right);
    }

    #[test]
    fn every_storage_has_the_bits_of_that_of_many_states() {
        for size in [2, 4, 6, 8] {
            let matrix =
                Matrix::from_fn(size, size, |i, j| (i as f64 - 0.7).mul_add(1.3, 0.9 * j as f64));
            let form = StateMatrix::of(&matrix);
            has_the_bits_of_many(SmallStates::of(&form, size).expect("a small matrix"), &form);
            assert_eq!(FewStates::<2>::of(&form).is_some(), size == 2);
            if let Some(few) = FewStates::<2>::of(&form) {
                has_the_bits_of_many(few, &form);
            }
            if let Some(few) = FewStates::<4>::of(&form) {
                has_the_bits_of_many(few, &form);
            }
        }
    }

    #[test]
    fn rows_with_and_without_gaps_are_the_same_rows() {
        let mut wide = vec![0.0; 40];
        (wide[3], wide[38]) = (2.0, -1.5);
        let state: Vec<f64> = (0..44).map(|i| f64::from(i) - 7.0).collect();
        for values in [&wide[..], &wide[2..5], &[1.0, 0.0, 3.0], &[0.0; 5], &wide[30..]] {
            let row = RowEntries::at(values, 4);
            let exact: f64 = values.iter().zip(&state[4..]).map(|(a, x)| a * x).sum();
            assert_eq!(row.dot(&state), exact);
            assert_eq!(row.dense(44)[4..4 + values.len()], *values);
            assert_eq!(row.product(&row), values.iter().map(|value| value * value).sum::<f64>());
        }
    }
}
