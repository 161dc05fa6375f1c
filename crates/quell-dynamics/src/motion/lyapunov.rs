//! Lyapunov exponents through events: mean rates at which small changes of a motion grow.
//!
//! The changes are those of [`MotionVariation`], with a saltation matrix at every event. They are orthonormalised again and again
//! (modified Gram–Schmidt); the mean logarithm of the lengths is the exponent. Method: Benettin et al. (1980); through events:
//! Müller (1995).
//!
//! A stick erases the change of its slip velocity at once: the exponent of that direction is −∞, which is reported as
//! [`LyapunovExponent::Erased`]. The error is the standard error of the mean over [`BLOCKS`] blocks: it does not see a transient that is
//! longer than the run.

use std::fmt;

use quell_numerics::interval::RealInterval;
use quell_numerics::order::descending_by;

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

impl LyapunovExponent {
    /// The exponent; −∞ of an erased direction.
    pub fn rate(&self) -> f64 {
        match self {
            Self::Rate { value, .. } => *value,
            Self::Erased => f64::NEG_INFINITY,
        }
    }

    /// Its interval of three standard errors to each side.
    fn interval(&self) -> RealInterval {
        match self {
            Self::Rate { value, error } => {
                RealInterval::new(value - ERRORS * error, value + ERRORS * error)
            }
            Self::Erased => RealInterval::new(f64::NEG_INFINITY, f64::NEG_INFINITY),
        }
    }
}

/// What the largest exponent says about a motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum LyapunovVerdict {
    /// Small changes do not grow.
    Regular,
    /// Some grow exponentially: the motion is chaotic.
    Irregular,
    /// The interval of the deciding exponent contains 0.
    Unknown,
}

impl LyapunovVerdict {
    /// Word in outputs.
    pub fn name(self) -> &'static str {
        match self {
            Self::Regular => "regular",
            Self::Irregular => "irregular (chaotic)",
            Self::Unknown => "unknown",
        }
    }
}

/// Why there are no exponents.
#[derive(Clone, Debug, PartialEq)]
pub enum NoExponents {
    /// The run ended early.
    Stopped(MotionStopped),
    /// The variational equation could not be integrated.
    NoVariation,
}

impl fmt::Display for NoExponents {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Stopped(why) => why.fmt(f),
            Self::NoVariation => f.write_str("the variational equation could not be integrated"),
        }
    }
}

impl std::error::Error for NoExponents {}

/// Standard errors in the interval of an exponent.
const ERRORS: f64 = 3.0;

/// Lyapunov exponents of a motion.
#[derive(Clone, Debug, PartialEq)]
pub struct LyapunovExponents {
    /// The exponents, the largest first.
    pub exponents: Vec<LyapunovExponent>,
    /// Of each the mean from the beginning up to the end of every block; empty for an erased direction.
    pub means: Vec<Vec<f64>>,
    /// Time over which they were averaged.
    pub time: f64,
    /// State at the end.
    pub state: Vec<f64>,
}

impl LyapunovExponents {
    /// What the exponents say, within three standard errors. `moves_freely` is true of a motion without dither that is no
    /// equilibrium: one exponent is exactly 0, that of a shift in time, and the others decide.
    pub fn verdict(&self, moves_freely: bool) -> LyapunovVerdict {
        let Some(deciding) = self.deciding(moves_freely) else {
            return LyapunovVerdict::Unknown;
        };
        let RealInterval { lower: low, upper: high } = deciding.interval();
        if low > 0.0 {
            LyapunovVerdict::Irregular
        } else if high < 0.0 {
            LyapunovVerdict::Regular
        } else {
            LyapunovVerdict::Unknown
        }
    }

    /// The dimension of Kaplan and Yorke, k + (λ₁ + … + λ_k)/|λ_{k+1}| with the largest k whose sum is not negative. Under dither
    /// it is that of the section at whole periods.
    ///
    /// `None` if the errors leave k open, or if no sum is negative: some exponents were not computed, or volumes grow.
    pub fn kaplan_yorke_dimension(&self, moves_freely: bool) -> Option<f64> {
        let (mut low, mut high) = (0.0, 0.0);
        for (index, RealInterval { lower: least, upper: most }) in
            self.known(moves_freely).into_iter().enumerate()
        {
            let (next_low, next_high) = (low + least, high + most);
            if next_high < 0.0 {
                let sum = 0.5 * (low + high);
                let rate = 0.5 * (least + most);
                let part = if rate.is_finite() { sum / rate.abs() } else { 0.0 };
                return Some(index as f64 + part);
            }
            if next_low < 0.0 {
                return None;
            }
            (low, high) = (next_low, next_high);
        }
        None
    }

    /// The place of the exponent that is 0 because the motion may be shifted in time: the one nearest to 0.
    pub fn shift_in_time(&self, moves_freely: bool) -> Option<usize> {
        let distance = |&index: &usize| self.exponents[index].rate().abs();
        let places = 0..self.exponents.len();
        moves_freely
            .then(|| places.min_by(|a, b| distance(a).total_cmp(&distance(b))))
            .flatten()
            .filter(|&index| self.exponents[index] != LyapunovExponent::Erased)
    }

    /// The exponent that decides: the largest without that of a shift in time.
    pub fn deciding(&self, moves_freely: bool) -> Option<LyapunovExponent> {
        let shift = self.shift_in_time(moves_freely);
        let mut others =
            self.exponents.iter().enumerate().filter(|(index, _)| Some(*index) != shift);
        others.next().map(|(_, exponent)| *exponent)
    }

    /// The intervals of the exponents; that of a shift in time is 0.
    fn known(&self, moves_freely: bool) -> Vec<RealInterval> {
        let shift = self.shift_in_time(moves_freely);
        let intervals = self.exponents.iter().enumerate().map(|(index, exponent)| {
            if Some(index) == shift { RealInterval::point(0.0) } else { exponent.interval() }
        });
        intervals.collect()
    }
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
        let counts = time > self.begin;
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
            let length = orthogonalise(before, column);
            if length <= ERASED * largest {
                self.erased[index] |= counts;
                // Any direction orthogonal to the others goes on in its place.
                replace(before, column);
                continue;
            }
            if counts {
                self.blocks[block][index] += libm::log(length);
            }
            for entry in column {
                *entry /= length;
            }
        }
        self.last = time;
    }
}

/// Takes the unit vectors before out of a column. Returns the length of what remains.
fn orthogonalise(before: &[f64], column: &mut [f64]) -> f64 {
    // Twice is enough for orthogonality to rounding.
    for _ in 0..2 {
        for other in before.chunks(column.len()) {
            let along: f64 = other.iter().zip(column.iter()).map(|(a, b)| a * b).sum();
            for (entry, other) in column.iter_mut().zip(other) {
                *entry -= along * other;
            }
        }
    }
    column.iter().map(|entry| entry * entry).sum::<f64>().sqrt()
}

/// A unit vector orthogonal to the columns before.
fn replace(before: &[f64], column: &mut [f64]) {
    let mut best = 0.0;
    for axis in 0..column.len() {
        let mut candidate = vec![0.0; column.len()];
        candidate[axis] = 1.0;
        let length = orthogonalise(before, &mut candidate);
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
    /// The `count` largest Lyapunov exponents of the motion from a start, over `time` after `settle`, in which the changes turn
    /// into the directions that belong to the exponents.
    ///
    /// # Errors
    /// [`NoExponents`] where the run ends early or its changes cannot be integrated.
    ///
    /// # Panics
    /// If `count` exceeds the length of the state.
    pub fn lyapunov_exponents(
        &self,
        start: &MotionStart,
        (settle, time): (f64, f64),
        count: usize,
    ) -> Result<LyapunovExponents, NoExponents> {
        let size = self.size();
        assert!(count <= size, "number of exponents");
        let mut variation = MotionVariation::new(self).map_err(|_| NoExponents::NoVariation)?;
        variation.columns_mut().truncate(count * size);
        let begin = start.time + settle;
        let mut growth = GrowthMeter {
            variation,
            size,
            interval: INTERVAL * self.time_scale(),
            last: start.time,
            blocks: vec![vec![0.0; count]; BLOCKS],
            begin,
            span: time,
            erased: vec![false; count],
        };
        let mut from = start.clone();
        if settle > 0.0 {
            let end = self.run(&from, begin, MOTION_TOLERANCE, &mut growth);
            from = end.map_err(NoExponents::Stopped)?.restart();
            growth.orthonormalise(begin);
        }
        let until = begin + time;
        let end = self.run(&from, until, MOTION_TOLERANCE, &mut growth);
        let end = end.map_err(NoExponents::Stopped)?;
        growth.orthonormalise(until);
        let finite = growth.blocks.iter().flatten().all(|sum| sum.is_finite());
        if growth.variation.has_failed || !finite {
            return Err(NoExponents::NoVariation);
        }
        let mut found: Vec<(LyapunovExponent, Vec<f64>)> =
            (0..count).map(|index| growth.exponent(index)).collect();
        descending_by(&mut found, |a| a.0.rate());
        let (exponents, means) = found.into_iter().unzip();
        Ok(LyapunovExponents { exponents, means, time, state: end.state })
    }
}

impl GrowthMeter<'_> {
    /// An exponent with its means up to the end of each block.
    fn exponent(&self, index: usize) -> (LyapunovExponent, Vec<f64>) {
        if self.erased[index] {
            return (LyapunovExponent::Erased, Vec::new());
        }
        let length = self.span / BLOCKS as f64;
        let rates: Vec<f64> = self.blocks.iter().map(|block| block[index] / length).collect();
        let mut sum = 0.0;
        let mut means = Vec::with_capacity(BLOCKS);
        for (count, rate) in rates.iter().enumerate() {
            sum += rate;
            means.push(sum / (count + 1) as f64);
        }
        let value = sum / BLOCKS as f64;
        let squares: f64 = rates.iter().map(|rate| (rate - value) * (rate - value)).sum();
        let error = (squares / (BLOCKS * (BLOCKS - 1)) as f64).sqrt();
        (LyapunovExponent::Rate { value, error }, means)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(rates: &[(f64, f64)]) -> LyapunovExponents {
        let exponents = rates.iter().map(|&(value, error)| {
            if value == f64::NEG_INFINITY {
                LyapunovExponent::Erased
            } else {
                LyapunovExponent::Rate { value, error }
            }
        });
        let exponents = exponents.collect();
        LyapunovExponents { exponents, means: Vec::new(), time: 1.0, state: Vec::new() }
    }

    #[test]
    fn the_largest_exponent_decides_within_its_error() {
        assert_eq!(of(&[(0.1, 0.01), (-0.5, 0.01)]).verdict(false), LyapunovVerdict::Irregular);
        assert_eq!(of(&[(0.1, 0.05), (-0.5, 0.01)]).verdict(false), LyapunovVerdict::Unknown);
        assert_eq!(of(&[(-0.1, 0.01), (-0.5, 0.01)]).verdict(false), LyapunovVerdict::Regular);
        let nothing = f64::NEG_INFINITY;
        assert_eq!(of(&[(nothing, 0.0); 2]).verdict(false), LyapunovVerdict::Regular);
        // A limit cycle: the 0 of its phase decides nothing.
        let cycle = of(&[(1e-5, 1e-4), (-0.5, 0.01)]);
        assert_eq!(cycle.verdict(false), LyapunovVerdict::Unknown);
        assert_eq!(cycle.verdict(true), LyapunovVerdict::Regular);
        assert_eq!(
            of(&[(0.2, 0.01), (1e-5, 1e-4), (-0.5, 0.01)]).verdict(true),
            LyapunovVerdict::Irregular
        );
    }

    #[test]
    fn the_dimension_is_that_of_kaplan_and_yorke() {
        let dimension = |rates: &[(f64, f64)], free| of(rates).kaplan_yorke_dimension(free);
        let chaos = [(0.2, 0.001), (-0.8, 0.001)];
        assert!((dimension(&chaos, false).expect("decided") - 1.25).abs() < 1e-12);
        assert_eq!(dimension(&[(-0.1, 0.01), (-0.3, 0.01)], false), Some(0.0));
        assert_eq!(dimension(&[(0.2, 0.01), (f64::NEG_INFINITY, 0.0)], false), Some(1.0));
        assert_eq!(dimension(&[(1e-5, 1e-4), (-0.3, 0.01)], true), Some(1.0));
        assert_eq!(dimension(&[(1e-5, 1e-4), (-0.3, 0.01)], false), None);
        assert_eq!(dimension(&[(0.2, 0.001), (-0.1, 0.001)], false), None);
    }
}
