//! What a row over the state does in a motion: its range, mean and root mean square from the Taylor series, and samples for a
//! spectrum.

use quell_numerics::dispatch::{InstructionSet, LaneWork, with_lanes};
use quell_numerics::lane::{Lane, horner};

use super::contact_meter::{integral, mean_of, moments_of, values_at};
use super::extremes::turning_points;
use super::observer::{MotionObserver, MotionSegment};
use super::rows::RowEntries;
use crate::simulation::Series;

/// The range of a quantity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct RowRange {
    pub(crate) least: f64,
    pub(crate) most: f64,
}

impl RowRange {
    pub(crate) const NONE: Self = Self { least: f64::INFINITY, most: f64::NEG_INFINITY };

    /// Peak to peak; 0 if nothing was added.
    pub(super) fn width(&self) -> f64 {
        (self.most - self.least).max(0.0)
    }

    #[inline(always)]
    fn take(&mut self, value: f64) {
        self.least = self.least.min(value);
        self.most = self.most.max(value);
    }

    /// Adds the values of a series from 0 to `duration`, the extrema between its ends included.
    #[inline(always)]
    pub(crate) fn add(&mut self, series: &Series, duration: f64) {
        self.take(horner(series, 0.0));
        self.take(horner(series, duration));
        // A bound on the distance from the first value: most steps stay within the range so far.
        let terms = series[1..].iter().rev();
        let reach = terms.fold(0.0, |sum: f64, c| f64::mul_add(sum, duration, c.abs())) * duration;
        if series[0] + reach > self.most || series[0] - reach < self.least {
            turning_points(series, duration, |since| self.take(horner(series, since)));
        }
    }
}

/// Measures a row over the state.
#[derive(Clone, Debug)]
pub struct RowMeter {
    row: RowEntries,
    first: f64,
    step: f64,
    count: usize,
    length: f64,
    extremes: RowRange,
    /// The first value: sums of the differences from it keep the digits of a small vibration about a large mean.
    reference: Option<f64>,
    sum: f64,
    squares: f64,
    set: InstructionSet,
    /// The values at `first` + n · `step`.
    pub samples: Vec<f64>,
}

impl RowMeter {
    /// For a row over the displacements, or over the states of first-order equations, with `count` samples from `first`, `step`
    /// apart.
    pub fn new(row: &[f64], first: f64, step: f64, count: usize) -> Self {
        Self {
            row: RowEntries::at(row, 0),
            first,
            step,
            count,
            length: 0.0,
            extremes: RowRange::NONE,
            reference: None,
            sum: 0.0,
            squares: 0.0,
            set: InstructionSet::widest(),
            samples: Vec::with_capacity(count),
        }
    }

    /// Adds samples that are missing at the end: the last one may round to just after it.
    pub fn finish(&mut self, state: &[f64]) {
        self.samples.resize(self.count, self.row.dot(state));
    }

    /// Mean over time.
    pub fn mean(&self) -> f64 {
        self.reference.unwrap_or(0.0) + self.sum / self.length
    }

    /// Root mean square of the deviation from the mean.
    pub fn deviation(&self) -> f64 {
        let mean = self.sum / self.length;
        (self.squares / self.length - mean * mean).max(0.0).sqrt()
    }

    /// Peak to peak.
    pub fn range(&self) -> f64 {
        self.extremes.width()
    }

    /// Largest magnitude; 0 if no time has been measured.
    pub fn largest(&self) -> f64 {
        if self.length > 0.0 {
            self.extremes.least.abs().max(self.extremes.most.abs())
        } else {
            0.0
        }
    }
}

impl MotionObserver for RowMeter {
    fn segment(&mut self, segment: &MotionSegment<'_>) {
        with_lanes(self.set, RowOnSegment { meter: self, segment });
    }
}

struct RowOnSegment<'a, 'b> {
    meter: &'a mut RowMeter,
    segment: &'a MotionSegment<'b>,
}

impl LaneWork for RowOnSegment<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn run<V: Lane>(self) {
        let Self { meter, segment } = self;
        let series = segment.row_of(&meter.row);
        let duration = segment.duration();
        let reference = *meter.reference.get_or_insert(series[0]);
        meter.length += duration;
        meter.sum += f64::mul_add(-reference, duration, integral(&series, duration));
        meter.extremes.add(&series, duration);
        let values = values_at::<V>(&series, &moments_of(duration));
        let squares = values.map(|value| (value - reference) * (value - reference));
        meter.squares = f64::mul_add(duration, mean_of(&squares), meter.squares);
        while meter.samples.len() < meter.count {
            let time = f64::mul_add(meter.samples.len() as f64, meter.step, meter.first);
            let since = segment.clock().until(time);
            if since > duration {
                break;
            }
            meter.samples.push(horner(&series, since.max(0.0)));
        }
    }
}
