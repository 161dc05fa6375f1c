//! One number per lane, the lanes side by side.

use quell_numerics::lane::{Lane, MOST_LANES};

/// One number of every lane.
#[derive(Debug)]
#[repr(align(64))]
pub(super) struct LaneRow(pub(super) [f64; MOST_LANES]);

impl LaneRow {
    pub(super) const ZERO: Self = Self([0.0; MOST_LANES]);

    #[inline(always)]
    pub(super) fn load<V: Lane>(&self) -> V {
        V::load(&self.0)
    }

    #[inline(always)]
    pub(super) fn store<V: Lane>(&mut self, value: V) {
        value.store(&mut self.0);
    }
}
