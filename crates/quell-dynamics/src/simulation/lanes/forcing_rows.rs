//! The forcing of all lanes, side by side.

use quell_numerics::elementary::sin_cos_of_phase;
use quell_numerics::lane::Lane;

use super::super::clock::Clock;
use super::super::forcing::{Forcing, ForcingShape, StraightPiece};
use super::super::lane_row::LaneRow;
use super::super::slip::DitherSeries;
use super::super::taylor::ORDER;

/// The forcing of one direction in all lanes.
pub(super) struct ForcingRows {
    pub(super) shape: ForcingShape,
    pub(super) mean: LaneRow,
    rate: LaneRow,
    phase: LaneRow,
    /// D Rᵏ/k! of a harmonic forcing; the coefficients themselves for several dithers.
    table: [LaneRow; ORDER + 1],
    line: StraightPiece<LaneRow>,
}

impl ForcingRows {
    pub(super) fn new(shape: ForcingShape) -> Self {
        Self {
            shape,
            mean: LaneRow::ZERO,
            rate: LaneRow::ZERO,
            phase: LaneRow::ZERO,
            table: [LaneRow::ZERO; ORDER + 1],
            line: StraightPiece {
                began: LaneRow::ZERO,
                value: LaneRow::ZERO,
                slope: LaneRow::ZERO,
            },
        }
    }

    /// Writes the constants of a run.
    pub(super) fn admit(&mut self, lane: usize, forcing: &Forcing) {
        self.mean.0[lane] = forcing.mean();
        let (rate, phase, table) = forcing.wave();
        self.rate.0[lane] = rate;
        self.phase.0[lane] = phase;
        for (row, entry) in self.table.iter_mut().zip(table) {
            row.0[lane] = if self.shape == ForcingShape::Harmonic { entry } else { 0.0 };
        }
    }

    /// Clears an empty lane.
    pub(super) fn evict(&mut self, lane: usize) {
        for row in
            [&mut self.mean, &mut self.rate, &mut self.phase].into_iter().chain(&mut self.table)
        {
            row.0[lane] = 0.0;
        }
        self.set_line(lane, StraightPiece::default());
    }

    #[inline(always)]
    fn set_line(&mut self, lane: usize, line: StraightPiece) {
        self.line.began.0[lane] = line.began;
        self.line.value.0[lane] = line.value;
        self.line.slope.0[lane] = line.slope;
    }

    /// Writes what the next step from the moment `clock` starts from.
    #[inline(always)]
    pub(super) fn load(&mut self, lane: usize, clock: Clock, forcing: &Forcing) {
        match self.shape {
            ForcingShape::Constant | ForcingShape::Harmonic => {}
            ForcingShape::Straight => self.set_line(lane, forcing.straight_piece()),
            ForcingShape::Several => {
                for (row, entry) in self.table.iter_mut().zip(forcing.series(clock)) {
                    row.0[lane] = entry;
                }
            }
        }
    }

    /// Taylor coefficients in every lane.
    #[inline(always)]
    pub(super) fn series<V: Lane>(&self, time: V, low: V) -> DitherSeries<'_, V> {
        let mean: V = self.mean.load();
        let mut phasor = [V::splat(1.0); 4];
        let mut line = [mean, V::splat(0.0)];
        match self.shape {
            ForcingShape::Constant => {}
            // The table holds the whole series.
            ForcingShape::Several => line[0] = V::splat(0.0),
            ForcingShape::Straight => {
                let StraightPiece { began, value, slope } = &self.line;
                let piece = StraightPiece {
                    began: began.load(),
                    value: value.load(),
                    slope: slope.load::<V>(),
                };
                line = [piece.at(time, low) + mean, piece.slope];
            }
            ForcingShape::Harmonic => {
                let (sine, cosine) =
                    sin_cos_of_phase(self.rate.load::<V>(), time, low, self.phase.load());
                phasor = [sine, cosine, -sine, -cosine];
            }
        }
        DitherSeries { table: &self.table, phasor, line }
    }
}
