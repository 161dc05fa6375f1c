//! The readings of a study as a function of its free numbers, and their derivatives.
//!
//! A reading is offset + gain · u · x⁽ᵏ⁾(t₀ + s + tᵢ), where x is the exact motion of the study with its numbers, k the order of the quantity and
//! u the units. s is the shift and t₀ where it counts from: the start of the run plus the settling time; in a study whose motion nothing paces,
//! the highest displacement in a window after it, because the phase of a limit cycle after a long time depends on everything.
//!
//! Derivatives by shift, offset and gain are exact. Those by numbers of the study are central differences of exact trajectories, with steps for
//! which the readings change by 10⁻⁴ of their size: the error is 10⁻⁸ of truncation and 10⁻⁸ of rounding. Where a step leads out of the valid
//! studies, the difference is one-sided.

use std::sync::atomic::{AtomicBool, Ordering};

use quell_dynamics::motion::{MOTION_TOLERANCE, Motion, ReadingSampler};
use quell_input::record::TimeSeries;
use quell_numerics::damped_least_squares::FittedFunction;

use super::request::FreeNumber;
use crate::complaint::Failure;
use crate::run::failed;
use crate::run::recorded_motion::ObservedMotion;
use crate::study::Study;

/// Change of the readings in a step of a difference, relative to their size.
const CHANGE: f64 = 1e-4;

/// Range of the change in which a step is kept.
const KEPT: (f64, f64) = (1e-6, 1e-3);

/// Relative step of a number at first, and bounds of it.
const STEP: (f64, f64, f64) = (1e-5, 1e-10, 1e-2);

/// Points of the grid on which the highest displacement is sought.
const GRID: usize = 2000;

/// A study with free numbers against the samples of a record.
pub(super) struct RecordModel<'a> {
    pub(super) study: &'a Study,
    pub(super) free: &'a [FreeNumber],
    pub(super) record: &'a TimeSeries,
    /// Number of samples that are used, from the first.
    pub(super) count: usize,
    /// Settling time in units of the equations.
    pub(super) settle: f64,
    /// Length in units of the record within which the highest displacement is sought; `None` where the shift counts from the start.
    pub(super) marker: Option<f64>,
    /// Steps of the differences, of each free number.
    pub(super) steps: Vec<f64>,
    pub(super) stop: &'a AtomicBool,
    /// Size of the readings.
    pub(super) size: f64,
    /// Why the last values do not exist.
    pub(super) why: Option<String>,
}

/// Readings without offset and gain, and their rates, in units of the record.
pub(super) struct PlainReadings {
    pub(super) values: Vec<f64>,
    /// Per unit of time of the record.
    pub(super) rates: Vec<f64>,
}

impl<'a> RecordModel<'a> {
    /// For free numbers that begin at `start`.
    pub(super) fn new(
        study: &'a Study,
        free: &'a [FreeNumber],
        record: &'a TimeSeries,
        (settle, marker): (f64, Option<f64>),
        start: &[f64],
        stop: &'a AtomicBool,
    ) -> Self {
        let mean = record.values.iter().sum::<f64>() / record.values.len() as f64;
        let squares: f64 = record.values.iter().map(|y| (y - mean) * (y - mean)).sum();
        let steps = start
            .iter()
            .map(|value| STEP.0 * if *value == 0.0 { 1.0 } else { value.abs() })
            .collect();
        Self {
            study,
            free,
            record,
            count: record.times.len(),
            settle,
            marker,
            steps,
            stop,
            size: (squares / record.values.len() as f64).sqrt(),
            why: None,
        }
    }

    /// Where a number of the measurement is among the free ones.
    fn place(&self, number: &FreeNumber) -> Option<usize> {
        self.free.iter().position(|free| free == number)
    }

    fn number(&self, number: &FreeNumber, at: &[f64], default: f64) -> f64 {
        self.place(number).map_or(default, |place| at[place])
    }

    /// The study with its free numbers.
    pub(super) fn study_at(&self, at: &[f64]) -> Result<Study, Failure> {
        let numbers = self.free.iter().zip(at).filter_map(|(free, value)| match free {
            FreeNumber::OfStudy(path) => Some((path.as_str(), *value)),
            _ => None,
        });
        Ok(self.study.at(numbers)?)
    }

    /// Readings of the study at these times after the first sample, in units of the record.
    pub(super) fn plain(&self, at: &[f64], times: &[f64]) -> Result<PlainReadings, Failure> {
        let motion = ObservedMotion::of(&self.study_at(at)?.system(), "fit --record")?;
        let units = motion.scales.of_record(self.record)?;
        let settled = settled(&motion, self.settle)?;
        let shift = self.number(&FreeNumber::Shift, at, 0.0);
        let mut from = settled.start.time + shift * units.time;
        if let Some(window) = self.marker {
            from += highest(&settled, window * units.time)?;
        }
        // A shift below the start of the run has no readings.
        if from < settled.start.time {
            return Err(failed("the record would begin before the run"));
        }
        let times: Vec<f64> = times.iter().map(|time| time.mul_add(units.time, from)).collect();
        let (values, rates) = settled.readings(self.record.quantity, &times)?;
        let scaled = |values: Vec<f64>, factor: f64| values.iter().map(|v| v * factor).collect();
        Ok(PlainReadings {
            values: scaled(values, units.reading),
            rates: scaled(rates, units.reading * units.time),
        })
    }

    /// Times of the samples after the first.
    fn times(&self) -> Vec<f64> {
        let first = self.record.times[0];
        self.record.times[..self.count].iter().map(|time| time - first).collect()
    }

    fn of(&self, plain: &PlainReadings, at: &[f64]) -> Vec<f64> {
        let gain = self.number(&FreeNumber::Gain, at, 1.0);
        let offset = self.number(&FreeNumber::Offset, at, 0.0);
        plain.values.iter().map(|value| gain.mul_add(*value, offset)).collect()
    }

    /// The central difference by a number of the study.
    fn difference(&mut self, at: &[f64], values: &[f64], place: usize) -> Option<Vec<f64>> {
        // Twice at most: with the step as it is, and with one that has the wanted change.
        for last in [false, true] {
            let step = self.steps[place];
            let mut moved = |sign: f64| {
                let mut at = at.to_vec();
                at[place] += sign * step;
                self.values(&at)
            };
            let (ahead, behind) = (moved(1.0), moved(-1.0));
            let (above, below, width) = match (&ahead, &behind) {
                (Some(above), Some(below)) => (above.as_slice(), below.as_slice(), 2.0 * step),
                (Some(above), None) => (above.as_slice(), values, step),
                (None, Some(below)) => (values, below.as_slice(), step),
                (None, None) => return None,
            };
            let change: Vec<f64> = above.iter().zip(below).map(|(a, b)| a - b).collect();
            let squares: f64 = change.iter().map(|c| c * c).sum();
            let size = (squares / change.len() as f64).sqrt() / self.size;
            let column = change.iter().map(|c| c / width).collect();
            if last || (KEPT.0..=KEPT.1).contains(&size) {
                return Some(column);
            }
            let value = if at[place] == 0.0 { 1.0 } else { at[place].abs() };
            let wanted = if size > 0.0 { step * CHANGE / size } else { STEP.2 * value };
            self.steps[place] = wanted.clamp(STEP.1 * value, STEP.2 * value);
        }
        None
    }
}

impl FittedFunction for RecordModel<'_> {
    fn values(&mut self, at: &[f64]) -> Option<Vec<f64>> {
        match self.plain(at, &self.times()) {
            Ok(plain) if plain.values.len() == self.count => Some(self.of(&plain, at)),
            Ok(_) => None,
            Err(why) => {
                self.why = Some(why.to_string());
                None
            }
        }
    }

    fn columns(&mut self, at: &[f64], values: &[f64]) -> Option<Vec<Vec<f64>>> {
        let plain = self.plain(at, &self.times()).ok()?;
        let gain = self.number(&FreeNumber::Gain, at, 1.0);
        (0..self.free.len())
            .map(|place| match self.free[place] {
                FreeNumber::OfStudy(_) => self.difference(at, values, place),
                FreeNumber::Shift => Some(plain.rates.iter().map(|rate| gain * rate).collect()),
                FreeNumber::Offset => Some(vec![1.0; values.len()]),
                FreeNumber::Gain => Some(plain.values.clone()),
            })
            .collect()
    }

    fn is_stopped(&self) -> bool {
        self.stop.load(Ordering::Relaxed)
    }
}

/// The same motion from where it is after a time.
fn settled(motion: &ObservedMotion, settle: f64) -> Result<ObservedMotion, Failure> {
    if settle <= 0.0 {
        return Ok(motion.clone());
    }
    let engine = Motion::new(&motion.system).map_err(failed)?;
    let until = motion.start.time + settle;
    let end = engine.run(&motion.start, until, MOTION_TOLERANCE, &mut ()).map_err(failed)?;
    Ok(ObservedMotion { start: end.restart(), ..motion.clone() })
}

/// Time from the start to the highest displacement within a window: a zero of the velocity, by the cubic through its values and slopes.
fn highest(motion: &ObservedMotion, window: f64) -> Result<f64, Failure> {
    let step = window / GRID as f64;
    let first = motion.start.time;
    let times: Vec<f64> = (0..=GRID).map(|k| (k as f64).mul_add(step, first)).collect();
    let engine = Motion::new(&motion.system).map_err(failed)?;
    let mut places = ReadingSampler::new(&motion.row, 0, &times);
    let mut speeds = ReadingSampler::new(&motion.row, 1, &times);
    let until = first + window + engine.time_scale();
    let mut both = (&mut places, &mut speeds);
    engine.run(&motion.start, until, MOTION_TOLERANCE, &mut both).map_err(failed)?;
    let crossing = (0..GRID)
        .filter(|k| speeds.values[*k] > 0.0 && speeds.values[k + 1] <= 0.0)
        .max_by(|a, b| places.values[*a].total_cmp(&places.values[*b]));
    let Some(k) = crossing else {
        return Err(failed("the study does not vibrate, so that its phase is not defined"));
    };
    let ends = [speeds.values[k], speeds.values[k + 1]];
    let slopes = [speeds.rates[k] * step, speeds.rates[k + 1] * step];
    Ok(step.mul_add(zero_of_cubic(ends, slopes), k as f64 * step))
}

/// The zero in [0, 1] of the cubic with these values, the first above 0 and the second not, and slopes at its ends.
fn zero_of_cubic(ends: [f64; 2], slopes: [f64; 2]) -> f64 {
    let value = |s: f64| {
        let (r, t) = (1.0 - s, s);
        ends[0] * r * r * (1.0 + 2.0 * t)
            + ends[1] * t * t * (1.0 + 2.0 * r)
            + slopes[0] * t * r * r
            - slopes[1] * r * t * t
    };
    let (mut low, mut high) = (0.0_f64, 1.0_f64);
    // To rounding.
    while high - low > f64::EPSILON {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            break;
        }
        if value(middle) > 0.0 { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use super::zero_of_cubic;

    #[test]
    fn the_zero_of_a_sine_is_found_to_the_order_of_the_cubic() {
        // cos on [1.5, 1.6]: the error of the cubic is h⁴/384.
        let (a, h) = (1.5_f64, 0.1);
        let found = zero_of_cubic(
            [libm::cos(a), libm::cos(a + h)],
            [-h * libm::sin(a), -h * libm::sin(a + h)],
        );
        assert!((a + h * found - std::f64::consts::FRAC_PI_2).abs() < 1e-8);
    }
}
