//! Roots of v_r on the steps that may have one, gathered from all benches so that they fill the
//! lanes.

use quell_model::friction::SlidingLaw;
use quell_numerics::lane::{Lane, MOST_LANES};
use quell_numerics::polynomial::side_by_side::first_crossings;

use super::super::ORDER;
use super::bench::{Bench, MOST_BENCHES};
use super::rows::Row;

/// The search for roots of v_r on the steps that may have one, from all benches side by side.
pub(super) struct RootSearch<V> {
    /// Bench and lane of each candidate.
    candidates: Vec<(usize, usize)>,
    slip: [f64; (ORDER + 1) * MOST_LANES],
    zeros: Row,
    length: Row,
    wanted: Row,
    lanes: std::marker::PhantomData<V>,
}

impl<V: Lane> RootSearch<V> {
    #[inline(always)]
    pub(super) fn new() -> Self {
        Self {
            candidates: Vec::with_capacity(MOST_BENCHES * MOST_LANES),
            slip: [0.0; (ORDER + 1) * MOST_LANES],
            zeros: Row::ZERO,
            length: Row::ZERO,
            wanted: Row::ZERO,
            lanes: std::marker::PhantomData,
        }
    }

    #[inline(always)]
    pub(super) fn run<L: SlidingLaw>(&mut self, benches: &mut [Bench<'_, V, L>]) {
        self.candidates.clear();
        for (number, bench) in benches.iter().enumerate() {
            if bench.all_clear {
                continue;
            }
            let lanes = (0..V::LANES).filter(|&lane| bench.board.is_unproven(lane));
            self.candidates.extend(lanes.map(|lane| (number, lane)));
        }
        for first in (0..self.candidates.len()).step_by(V::LANES) {
            let last = self.candidates.len().min(first + V::LANES);
            self.wanted = Row::ZERO;
            for (slot, &(bench, lane)) in self.candidates[first..last].iter().enumerate() {
                let board = &benches[bench].board;
                for k in 0..=ORDER {
                    self.slip[k * V::LANES + slot] = board.slip_series[k * V::LANES + lane];
                }
                self.zeros.0[slot] = board.zeros_before.0[lane];
                self.length.0[slot] = board.length.0[lane];
                self.wanted.0[slot] = 1.0;
            }
            let (found, time) = self.roots();
            for (slot, &(bench, lane)) in self.candidates[first..last].iter().enumerate() {
                let board = &mut benches[bench].board;
                board.found.0[lane] = found.0[slot];
                board.duration.0[lane] = time.0[slot];
            }
        }
        for bench in benches.iter_mut().filter(|bench| !bench.all_clear) {
            bench.board.go_back_to_roots();
        }
    }

    /// What [`first_crossings`] says, and the root.
    #[inline(always)]
    fn roots(&self) -> (Row, Row) {
        let mut slip = [V::splat(0.0); ORDER + 1];
        for (k, coefficient) in slip.iter_mut().enumerate() {
            *coefficient = V::load(&self.slip[k * V::LANES..]);
        }
        let (zeros, length) = (self.zeros.load(), self.length.load());
        let crossings = first_crossings(&slip, zeros, length, self.wanted.load());
        let mut rows = (Row::ZERO, Row::ZERO);
        rows.0.store(crossings.found);
        rows.1.store(crossings.time);
        rows
    }
}
