//! Roots of v_r on the steps that may have one, gathered from all batches so that they fill the
//! lanes.

use quell_model::friction::LawSeries;
use quell_numerics::dispatch::{InstructionSet, LaneWork, with_lanes};
use quell_numerics::lane::{Lane, MOST_LANES};
use quell_numerics::polynomial::side_by_side::first_crossings;

use super::super::lane_row::LaneRow;
use super::super::taylor::ORDER;
use super::batch::{Batch, MOST_BATCHES};
use super::law_lanes::LawLanes;

/// The search for roots of v_r on the steps that may have one, from all batches side by side.
pub(super) struct RootSearch {
    set: InstructionSet,
    /// Batch and lane of each candidate.
    candidates: Vec<(usize, usize)>,
    slip: [f64; (ORDER + 1) * MOST_LANES],
    zeros: LaneRow,
    length: LaneRow,
    wanted: LaneRow,
}

impl RootSearch {
    pub(super) fn new(set: InstructionSet) -> Self {
        Self {
            set,
            candidates: Vec::with_capacity(MOST_BATCHES * MOST_LANES),
            slip: [0.0; (ORDER + 1) * MOST_LANES],
            zeros: LaneRow::ZERO,
            length: LaneRow::ZERO,
            wanted: LaneRow::ZERO,
        }
    }

    #[inline(always)]
    pub(super) fn run<V: Lane, L: LawSeries>(
        &mut self,
        batches: &mut [Batch<'_>],
        laws: &[LawLanes<V, L>],
    ) {
        self.candidates.clear();
        for (number, batch) in batches.iter().enumerate() {
            if batch.all_clear {
                continue;
            }
            for lane in 0..V::LANES {
                if batch.lanes.is_unproven(lane) {
                    self.candidates.push((number, lane));
                }
            }
        }
        if !self.candidates.is_empty() {
            self.find::<V>(batches);
        }
        for (batch, laws) in batches.iter_mut().zip(laws).filter(|(batch, _)| !batch.all_clear) {
            batch.lanes.cut_at_roots(&laws.series);
        }
    }

    /// Finds the roots of the candidates and gives them back: one function for every law.
    #[inline(never)]
    fn find<V: Lane>(&mut self, batches: &mut [Batch<'_>]) {
        let lanes = V::LANES;
        for first in (0..self.candidates.len()).step_by(lanes) {
            let last = self.candidates.len().min(first + lanes);
            self.wanted = LaneRow::ZERO;
            for (slot, &(batch, lane)) in self.candidates[first..last].iter().enumerate() {
                let state = &batches[batch].lanes;
                for k in 0..=ORDER {
                    self.slip[k * lanes + slot] = state.slip_series[k * lanes + lane];
                }
                self.zeros.0[slot] = state.zeros_before.0[lane];
                self.length.0[slot] = state.length.0[lane];
                self.wanted.0[slot] = 1.0;
            }
            let (found, time) = with_lanes(self.set, Roots(self));
            for (slot, &(batch, lane)) in self.candidates[first..last].iter().enumerate() {
                let state = &mut batches[batch].lanes;
                state.found.0[lane] = found.0[slot];
                state.duration.0[lane] = time.0[slot];
            }
        }
    }
}

/// The codes of [`first_crossings`], and the roots.
struct Roots<'a>(&'a RootSearch);

impl LaneWork for Roots<'_> {
    type Output = (LaneRow, LaneRow);

    #[inline(always)]
    fn run<V: Lane>(self) -> (LaneRow, LaneRow) {
        let Self(RootSearch { slip: rows, zeros, length, wanted, .. }) = self;
        let mut slip = [V::splat(0.0); ORDER + 1];
        for (k, coefficient) in slip.iter_mut().enumerate() {
            *coefficient = V::load(&rows[k * V::LANES..]);
        }
        let crossings = first_crossings(&slip, zeros.load(), length.load(), wanted.load());
        let mut found = (LaneRow::ZERO, LaneRow::ZERO);
        found.0.store(crossings.found);
        found.1.store(crossings.time);
        found
    }
}
