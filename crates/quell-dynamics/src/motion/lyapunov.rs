//! Lyapunov exponents through events: mean rates at which small changes of a motion grow.
//!
//! The changes are those of [`MotionVariation`], with a saltation matrix at every event. They are orthonormalised again and again
//! (modified Gram–Schmidt); the mean logarithm of the lengths is the exponent. Method: Benettin et al. (1980); through events:
//! Müller (1995).
//!
//! A stick erases the change of its slip velocity at once: the exponent of that direction is −∞, which is reported as
//! [`LyapunovExponent::Erased`]. The error is the standard error of the mean over [`BLOCKS`] blocks: it does not see a transient that is
//! longer than the run.

use super::variation::MotionVariation;
use super::{
    MOTION_TOLERANCE, Motion, MotionEvent, MotionMoment, MotionObserver, MotionSegment,
    MotionStart, MotionStopped,
};

/// Number of blocks from whose means the error is estimated.
const BLOCKS: usize = 16;

/// Time between two orthonormalisations, over the time scale of the system.
const INTERVAL: f64 = 4.0;

/// A length below this share of the others' is rounding: its direction has been erased.
const ERASED: f64 = 1e-13;

/// A Lyapunov exponent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LyapunovExponent {
    /// Mean rate of growth, per unit of time.
    Rate {
        /// The exponent.
        value: f64,
        /// Its standard error.
        error: f64,
    },
    /// Sticks erase the direction: −∞.
    Erased,
}

/// Lyapunov exponents of a motion.
#[derive(Clone, Debug, PartialEq)]
pub struct LyapunovExponents {
    /// The exponents, the largest first.
    pub exponents: Vec<LyapunovExponent>,
    /// Time over which they were averaged.
    pub time: f64,
    /// State at the end.
    pub state: Vec<f64>,
}

/// Accumulates the logarithms of lengths.
struct GrowthMeter<'a> {
    variation: MotionVariation<'a>,
    size: usize,
    interval: f64,
    last: f64,
    /// Σ ln of each direction, block by block.
    blocks: Vec<Vec<f64>>,
    begin: f64,
    span: f64,
    erased: Vec<bool>,
}

impl GrowthMeter<'_> {
    fn orthonormalise(&mut self, time: f64) {
        let block = (((time - self.begin) / self.span) * BLOCKS as f64).floor();
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "between 0 and BLOCKS"
        )]
        let block = (block.max(0.0) as usize).min(BLOCKS - 1);
        let columns = self.variation.columns_mut();
        let largest = columns.iter().fold(0.0, |m: f64, c| m.max(c.abs()));
        let count = columns.len() / self.size;
        for index in 0..count {
            let (before, rest) = columns.split_at_mut(index * self.size);
            let column = &mut rest[..self.size];
            // Twice is enough for orthogonality to rounding.
            for _ in 0..2 {
                for other in before.chunks(self.size) {
                    let along: f64 = other.iter().zip(column.iter()).map(|(a, b)| a * b).sum();
                    for (entry, other) in column.iter_mut().zip(other) {
                        *entry -= along * other;
                    }
                }
            }
            let length = column.iter().map(|entry| entry * entry).sum::<f64>().sqrt();
            if length <= ERASED * largest {
                self.erased[index] = true;
                // Any direction orthogonal to the others goes on in its place.
                replace(before, column, self.size);
                continue;
            }
            self.blocks[block][index] += libm::log(length);
            for entry in column {
                *entry /= length;
            }
        }
        self.last = time;
    }
}

/// A unit vector orthogonal to the columns before.
fn replace(before: &[f64], column: &mut [f64], size: usize) {
    let mut best = 0.0;
    for axis in 0..size {
        let mut candidate = vec![0.0; size];
        candidate[axis] = 1.0;
        for _ in 0..2 {
            for other in before.chunks(size) {
                let along: f64 = other.iter().zip(&candidate).map(|(a, b)| a * b).sum();
                for (entry, other) in candidate.iter_mut().zip(other) {
                    *entry -= along * other;
                }
            }
        }
        let length = candidate.iter().map(|entry| entry * entry).sum::<f64>().sqrt();
        if length > best {
            best = length;
            for (entry, value) in column.iter_mut().zip(&candidate) {
                *entry = value / length;
            }
        }
    }
}

impl MotionObserver for GrowthMeter<'_> {
    fn segment(&mut self, segment: &MotionSegment<'_>) {
        self.variation.segment(segment);
        let time = segment.clock().after(segment.duration()).time();
        if time - self.last >= self.interval {
            self.orthonormalise(time);
        }
    }

    fn event(&mut self, event: &MotionEvent<'_>) {
        self.variation.event(event);
        self.variation.events.clear();
    }

    fn moment(&mut self, moment: &MotionMoment<'_>) {
        self.variation.moment(moment);
    }
}

impl Motion<'_> {
    /// The `count` largest Lyapunov exponents of the motion from a start, over `time`.
    ///
    /// # Errors
    /// [`MotionStopped`] where the run ends early.
    ///
    /// # Panics
    /// If `count` exceeds the length of the state.
    pub fn lyapunov_exponents(
        &self,
        start: &MotionStart,
        time: f64,
        count: usize,
    ) -> Result<LyapunovExponents, MotionStopped> {
        let size = self.size();
        assert!(count <= size, "number of exponents");
        let mut variation = MotionVariation::new(self);
        variation.columns_mut().truncate(count * size);
        let mut growth = GrowthMeter {
            variation,
            size,
            interval: INTERVAL * self.time_scale(),
            last: start.time,
            blocks: vec![vec![0.0; count]; BLOCKS],
            begin: start.time,
            span: time,
            erased: vec![false; count],
        };
        let until = start.time + time;
        let end = self.run(start, until, MOTION_TOLERANCE, &mut growth)?;
        growth.orthonormalise(until);
        let length = time / BLOCKS as f64;
        let exponents = (0..count).map(|index| {
            if growth.erased[index] {
                return LyapunovExponent::Erased;
            }
            let rates: Vec<f64> = growth.blocks.iter().map(|block| block[index] / length).collect();
            let value = rates.iter().sum::<f64>() / BLOCKS as f64;
            let squares: f64 = rates.iter().map(|rate| (rate - value) * (rate - value)).sum();
            let error = (squares / (BLOCKS * (BLOCKS - 1)) as f64).sqrt();
            LyapunovExponent::Rate { value, error }
        });
        let mut exponents: Vec<LyapunovExponent> = exponents.collect();
        let rank = |exponent: &LyapunovExponent| match exponent {
            LyapunovExponent::Rate { value, .. } => *value,
            LyapunovExponent::Erased => f64::NEG_INFINITY,
        };
        exponents.sort_by(|a, b| rank(b).total_cmp(&rank(a)));
        Ok(LyapunovExponents { exponents, time, state: end.state })
    }
}
