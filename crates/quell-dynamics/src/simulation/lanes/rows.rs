//! Numbers of the runs, lane beside lane.

use quell_numerics::elementary::sin_cos_of_phase;
use quell_numerics::lane::{Lane, MOST_LANES};

use super::super::ORDER;
use super::super::engine::Engine;
use super::super::forcing::{Forcing, Line, Shape};
use super::super::slip::DitherSeries;

/// Numbers of all lanes side by side.
#[derive(Debug)]
#[repr(align(64))]
pub(in super::super) struct Row(pub(super) [f64; MOST_LANES]);

impl Row {
    pub(super) const ZERO: Self = Self([0.0; MOST_LANES]);

    #[inline(always)]
    pub(in super::super) fn load<V: Lane>(&self) -> V {
        V::load(&self.0)
    }

    #[inline(always)]
    pub(super) fn store<V: Lane>(&mut self, value: V) {
        value.store(&mut self.0);
    }
}

/// The forcing of one direction in all lanes.
pub(super) struct ForcingRows {
    pub(super) shape: Shape,
    pub(super) mean: Row,
    rate: Row,
    phase: Row,
    /// D Rᵏ/k! of a harmonic forcing; the coefficients themselves where there are several.
    table: [Row; ORDER + 1],
    line: Line<Row>,
}

impl ForcingRows {
    pub(super) fn new(shape: Shape) -> Self {
        Self {
            shape,
            mean: Row::ZERO,
            rate: Row::ZERO,
            phase: Row::ZERO,
            table: [Row::ZERO; ORDER + 1],
            line: Line { began: Row::ZERO, value: Row::ZERO, slope: Row::ZERO },
        }
    }

    pub(super) fn seat(&mut self, lane: usize, forcing: &Forcing) {
        self.mean.0[lane] = forcing.mean();
        let (rate, phase, table) = forcing.wave();
        self.rate.0[lane] = rate;
        self.phase.0[lane] = phase;
        for (row, entry) in self.table.iter_mut().zip(table) {
            row.0[lane] = if self.shape == Shape::Harmonic { entry } else { 0.0 };
        }
    }

    pub(super) fn leave(&mut self, lane: usize) {
        for row in
            [&mut self.mean, &mut self.rate, &mut self.phase].into_iter().chain(&mut self.table)
        {
            row.0[lane] = 0.0;
        }
        self.set_line(lane, Line::default());
    }

    #[inline(always)]
    fn set_line(&mut self, lane: usize, line: Line) {
        self.line.began.0[lane] = line.began;
        self.line.value.0[lane] = line.value;
        self.line.slope.0[lane] = line.slope;
    }

    #[inline(always)]
    pub(super) fn announce(&mut self, lane: usize, engine: &Engine<'_>, forcing: &Forcing) {
        match self.shape {
            Shape::Constant | Shape::Harmonic => {}
            Shape::Straight => self.set_line(lane, forcing.line()),
            Shape::Several => {
                for (row, entry) in self.table.iter_mut().zip(forcing.series(engine.clock)) {
                    row.0[lane] = entry;
                }
            }
        }
    }

    /// Taylor coefficients in every lane.
    #[inline(always)]
    pub(super) fn series<V: Lane>(&self, time: V, low: V) -> DitherSeries<'_, V> {
        let mean: V = self.mean.load();
        let mut turn = [V::splat(1.0); 4];
        let mut line = [mean, V::splat(0.0)];
        match self.shape {
            Shape::Constant => {}
            // The table holds the whole series.
            Shape::Several => line[0] = V::splat(0.0),
            Shape::Straight => {
                let Line { began, value, slope } = &self.line;
                let piece =
                    Line { began: began.load(), value: value.load(), slope: slope.load::<V>() };
                line = [piece.at(time, low) + mean, piece.slope];
            }
            Shape::Harmonic => {
                let (sine, cosine) =
                    sin_cos_of_phase(self.rate.load::<V>(), time, low, self.phase.load());
                turn = [sine, cosine, -sine, -cosine];
            }
        }
        DitherSeries { table: &self.table, turn, line }
    }
}
