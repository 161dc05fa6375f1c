//! Roots of v_r on the steps that may have one, gathered from all batches so that they fill the
//! lanes.

use quell_model::friction::SlidingLaw;
use quell_numerics::lane::{Lane, MOST_LANES};
use quell_numerics::polynomial::side_by_side::first_crossings;

use super::super::lane_row::LaneRow;
use super::super::taylor::ORDER;
use super::batch::{Batch, MOST_BATCHES};

/// The search for roots of v_r on the steps that may have one, from all batches side by side.
pub(super) struct RootSearch<V> {
    /// Batch and lane of each candidate.
    candidates: Vec<(usize, usize)>,
    slip: [f64; (ORDER + 1) * MOST_LANES],
    zeros: LaneRow,
    length: LaneRow,
    wanted: LaneRow,
    lanes: std::marker::PhantomData<V>,
}

impl<V: Lane> RootSearch<V> {
    #[inline(always)]
    pub(super) fn new() -> Self {
        Self {
            candidates: Vec::with_capacity(MOST_BATCHES * MOST_LANES),
            slip: [0.0; (ORDER + 1) * MOST_LANES],
            zeros: LaneRow::ZERO,
            length: LaneRow::ZERO,
            wanted: LaneRow::ZERO,
            lanes: std::marker::PhantomData,
        }
    }

    #[inline(always)]
    pub(super) fn run<L: SlidingLaw>(&mut self, batches: &mut [Batch<'_, V, L>]) {
        self.candidates.clear();
        for (number, batch) in batches.iter().enumerate() {
            if batch.all_clear {
                continue;
            }
            let lanes = (0..V::LANES).filter(|&lane| batch.lanes.is_unproven(lane));
            self.candidates.extend(lanes.map(|lane| (number, lane)));
        }
        for first in (0..self.candidates.len()).step_by(V::LANES) {
            let last = self.candidates.len().min(first + V::LANES);
            self.wanted = LaneRow::ZERO;
            for (slot, &(batch, lane)) in self.candidates[first..last].iter().enumerate() {
                let state = &batches[batch].lanes;
                for k in 0..=ORDER {
                    self.slip[k * V::LANES + slot] = state.slip_series[k * V::LANES + lane];
                }
                self.zeros.0[slot] = state.zeros_before.0[lane];
                self.length.0[slot] = state.length.0[lane];
                self.wanted.0[slot] = 1.0;
            }
            let (found, time) = self.roots();
            for (slot, &(batch, lane)) in self.candidates[first..last].iter().enumerate() {
                let state = &mut batches[batch].lanes;
                state.found.0[lane] = found.0[slot];
                state.duration.0[lane] = time.0[slot];
            }
        }
        for batch in batches.iter_mut().filter(|batch| !batch.all_clear) {
            batch.lanes.cut_at_roots();
        }
    }

    /// The codes of [`first_crossings`], and the roots.
    #[inline(always)]
    fn roots(&self) -> (LaneRow, LaneRow) {
        let mut slip = [V::splat(0.0); ORDER + 1];
        for (k, coefficient) in slip.iter_mut().enumerate() {
            *coefficient = V::load(&self.slip[k * V::LANES..]);
        }
        let (zeros, length) = (self.zeros.load(), self.length.load());
        let crossings = first_crossings(&slip, zeros, length, self.wanted.load());
        let mut rows = (LaneRow::ZERO, LaneRow::ZERO);
        rows.0.store(crossings.found);
        rows.1.store(crossings.time);
        rows
    }
}
