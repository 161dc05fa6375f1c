//! Readings of a sensor: a row over the state, or a derivative of it over time, at given times.
//!
//! Derivatives are those of the Taylor series of a step, so that an acceleration has the jumps that friction gives it.

use super::observer::{MotionObserver, MotionSegment};
use super::rows::RowEntries;
use crate::simulation::Series;

/// Samples a row and its rate of change.
#[derive(Clone, Debug)]
pub struct ReadingSampler<'t> {
    row: RowEntries,
    order: usize,
    times: &'t [f64],
    /// The readings.
    pub values: Vec<f64>,
    /// Their rates of change.
    pub rates: Vec<f64>,
}

impl<'t> ReadingSampler<'t> {
    /// For the derivative of this order of a row over the displacements, at ascending times. The run must go beyond the last one.
    pub fn new(row: &[f64], order: usize, times: &'t [f64]) -> Self {
        let count = times.len();
        Self {
            row: RowEntries::at(row, 0),
            order,
            times,
            values: Vec::with_capacity(count),
            rates: Vec::with_capacity(count),
        }
    }
}

/// The series of the rate of change.
fn differentiated(series: &Series) -> Series {
    let mut slope = *series;
    for (power, coefficient) in slope.iter_mut().enumerate() {
        let next = series.get(power + 1).copied().unwrap_or(0.0);
        *coefficient = (power + 1) as f64 * next;
    }
    slope
}

impl MotionObserver for ReadingSampler<'_> {
    fn segment(&mut self, segment: &MotionSegment<'_>) {
        let Some(time) = self.times.get(self.values.len()) else { return };
        if segment.clock().until(*time) > segment.duration() {
            return;
        }
        let mut series = segment.row_of(&self.row);
        for _ in 0..self.order {
            series = differentiated(&series);
        }
        let slope = differentiated(&series);
        while let Some(time) = self.times.get(self.values.len()) {
            let since = segment.clock().until(*time);
            if since > segment.duration() {
                break;
            }
            let since = since.max(0.0);
            self.values.push(MotionSegment::value(&series, since));
            self.rates.push(MotionSegment::value(&slope, since));
        }
    }
}
