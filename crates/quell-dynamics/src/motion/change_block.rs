//! Small changes of a state, several columns side by side.

use super::rows::{RowEntries, StateMatrix};
use crate::simulation::ORDER;

/// Columns that are advanced together.
pub(super) const LANES: usize = 4;

/// One number of each of the columns.
pub(super) type ColumnBlock = [f64; LANES];

/// A series of them.
pub(super) type BlockSeries = [ColumnBlock; ORDER + 1];

pub(super) const ZERO: ColumnBlock = [0.0; LANES];

/// The entries of a row or column over the state that are not zero.
#[derive(Clone, Debug)]
pub(super) struct ChangeRow(Vec<(usize, f64)>);

impl ChangeRow {
    pub(super) fn of(row: &RowEntries) -> Self {
        Self(row.pairs().filter(|(_, value)| *value != 0.0).collect())
    }

    #[inline(always)]
    pub(super) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// The row times a change.
    #[inline(always)]
    pub(super) fn dot(&self, change: &[ColumnBlock]) -> ColumnBlock {
        let mut sum = ZERO;
        for &(place, value) in &self.0 {
            add(&mut sum, value, &change[place]);
        }
        sum
    }

    /// Adds a multiple of the column to a change.
    #[inline(always)]
    pub(super) fn add_to(&self, factor: &ColumnBlock, change: &mut [ColumnBlock]) {
        for &(place, value) in &self.0 {
            add(&mut change[place], value, factor);
        }
    }
}

#[inline(always)]
pub(super) fn add(sum: &mut ColumnBlock, factor: f64, block: &ColumnBlock) {
    for lane in 0..LANES {
        sum[lane] = f64::mul_add(factor, block[lane], sum[lane]);
    }
}

/// Σ aⱼ bₖ₋ⱼ over j = `from`…k, with the `terms` coefficients of a that are not zero.
#[inline(always)]
pub(super) fn product(
    a: &[f64],
    terms: usize,
    b: &BlockSeries,
    k: usize,
    from: usize,
) -> ColumnBlock {
    let (mut even, mut odd) = (ZERO, ZERO);
    let end = terms.min(k + 1);
    let mut j = from;
    while j + 1 < end {
        add(&mut even, a[j], &b[k - j]);
        add(&mut odd, a[j + 1], &b[k - j - 1]);
        j += 2;
    }
    if j < end {
        add(&mut even, a[j], &b[k - j]);
    }
    std::array::from_fn(|lane| even[lane] + odd[lane])
}

/// Writes the state matrix times a change to `out`.
#[inline(always)]
pub(super) fn times(matrix: &StateMatrix, change: &[ColumnBlock], out: &mut [ColumnBlock]) {
    match matrix {
        StateMatrix::Modal(stiffness, damping) => {
            let (displacements, velocities) = change.split_at(stiffness.len());
            let (upper, lower) = out.split_at_mut(stiffness.len());
            upper.copy_from_slice(velocities);
            for (i, out) in lower.iter_mut().enumerate() {
                *out = ZERO;
                add(out, -stiffness[i], &displacements[i]);
                add(out, -damping[i], &velocities[i]);
            }
        }
        StateMatrix::Small(columns) | StateMatrix::Dense(columns) => {
            out.fill(ZERO);
            for (column, entry) in columns.chunks(change.len()).zip(change) {
                for (out, value) in out.iter_mut().zip(column) {
                    add(out, *value, entry);
                }
            }
        }
        StateMatrix::Sparse(starts, entries) => {
            for (i, out) in out.iter_mut().enumerate() {
                *out = ZERO;
                for &(place, value) in &entries[starts[i]..starts[i + 1]] {
                    add(out, value, &change[place]);
                }
            }
        }
    }
}
