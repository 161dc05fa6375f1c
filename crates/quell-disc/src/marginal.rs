//! Values of any parameter at which a motion is marginal, by exact exponents along a line of discs.
//!
//! The D-partition (`partition`) gives the marginal frictions of one load under a sine. Under any other waveform the Hill determinant
//! is not tridiagonal, and for waves with jumps it converges slowly with its size, while the exponents of every waveform are known to
//! rounding (`quell-linear/src/floquet.rs`). This module therefore follows all exponents along the line and locates where one crosses
//! the imaginary axis. The parameter may be friction, speed, or the amplitude or frequency of the dither.
//!
//! The rates of all exponents, conjugates included and in descending order, are continuous along the line, whichever exponents
//! they belong to. Where one of them has the same sign at two points and at their middle and is larger than its distance from the
//! chord, no crossing exists there; where it changes its sign once and by more than that distance, the crossing is refined in
//! its bracket; in every other case the interval is halved. A rate that is zero within its error at all three points is marginal
//! along the line and is no crossing: at ξ = 0 and on the lines of table 5.1 an exponent is imaginary for every friction.
//!
//! Two crossings within the last interval (`DEPTH` halvings of a step of the grid) are missed, and so is a tongue within a step of
//! the grid without any sign of it at its ends and its middle. The grid of a line over speeds therefore has points in and next to
//! every predicted tongue ([`tongue_grid`]).

use core::ops::RangeInclusive;

use quell_linear::eigenvalues;
use quell_linear::floquet::{FollowerDither, NotFollowerDither};
use quell_model::Disc;
use quell_model::disc::Contributions;
use quell_numerics::eigen::EigenError;
use quell_numerics::floquet::{Effort, Exponent};
use quell_numerics::order::{ascending, ascending_by, descending_by};
use quell_numerics::roots::{Closeness, try_find_root};

use crate::dithered;
use crate::equations::linearised;
use crate::resonance::{Order, Resonance, Tongue, Waves};

/// Halvings of a step of the grid.
const DEPTH: u32 = 9;

/// Most evaluations of the exponents along one line, after which intervals are no longer halved.
const MOST: usize = 6000;

/// Steps per decade of a grid of frictions.
const PER_DECADE: f64 = 12.0;

/// Smallest and largest friction that are searched, relative to the one at which the first wave is unstable by itself.
const FRICTIONS: [f64; 2] = [1e-5, 30.0];

/// Effort of the exponents that are followed: the extrapolated rates are then accurate to about 10⁻¹¹.
const EFFORT: Effort = Effort { enough: 1e-11, at_least: 1e-9, finest: 8192 };

/// Distances of points of a grid from the meeting of two waves, at which an exponent may be exactly marginal.
const BESIDE: [f64; 3] = [1e-6, 1e-4, 1e-2];

/// Points in a predicted tongue, as shares of its width.
const ACROSS: [f64; 5] = [0.03, 0.25, 0.5, 0.75, 0.97];

/// An exponent of a disc, one of each conjugate pair.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DiscExponent {
    /// Growth rate Re ρ.
    pub rate: f64,
    /// Bound on its error.
    pub error: f64,
    /// Frequency |Im ρ|; under dither from 0 to half of the frequency at which the dither repeats itself.
    pub frequency: f64,
    /// Whether it has no conjugate: its multiplier, or without dither the exponent itself, is real.
    pub alone: bool,
}

/// A value at which an exponent is imaginary.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MarginalValue {
    /// The value of the parameter.
    pub value: f64,
    /// Frequency of the exponent.
    pub frequency: f64,
    /// Whether the motion grows at larger values.
    pub grows_beyond: bool,
}

impl DiscExponent {
    fn under(period: f64, found: Exponent) -> Self {
        let Exponent { growth_rate: rate, error, frequency, .. } = found;
        // The frequency of a real multiplier is exactly 0 or π/T.
        let alone = frequency == 0.0 || frequency == core::f64::consts::PI / period;
        Self { rate, error, frequency, alone }
    }

    /// Whether the rate is zero within its error.
    fn is_zero(&self) -> bool {
        self.rate.abs() <= self.error
    }
}

/// All exponents of a disc, dithered or not, the fastest first.
///
/// # Errors
/// [`NotFollowerDither`] where they do not describe this disc or the matrices overflow.
pub fn exponents(disc: &Disc) -> Result<Vec<DiscExponent>, NotFollowerDither> {
    if let Some(prepared) = dithered::prepared(disc)? {
        return Ok(dithered_exponents(&prepared, 1.0)?);
    }
    let linear = linearised(&disc.undithered(), Contributions::ALL)?;
    let values = eigenvalues::all(&linear, &linear.mean_friction())?;
    let error = eigenvalues::growth(&linear, &linear.mean_friction())?.error;
    let upper = values.into_iter().filter(|value| value.im >= 0.0);
    let one = |value: num_complex::Complex64| DiscExponent {
        rate: value.re,
        error,
        frequency: value.im,
        alone: value.im == 0.0,
    };
    Ok(upper.map(one).collect())
}

/// All exponents of a prepared disc with its friction times a factor.
fn dithered_exponents(
    prepared: &FollowerDither,
    factor: f64,
) -> Result<Vec<DiscExponent>, EigenError> {
    let found = prepared.exponents(factor, EFFORT)?.into_iter();
    Ok(found.map(|exponent| DiscExponent::under(prepared.period(), exponent)).collect())
}

/// Frictions that are searched for marginal ones.
#[derive(Clone, Debug, PartialEq)]
pub struct MarginalFrictions {
    /// Factors on the friction of the loads at which an exponent is imaginary, ascending.
    pub factors: Vec<MarginalValue>,
    /// The largest factor that was searched.
    pub up_to: f64,
}

/// Every factor on the friction of a dithered disc, up to thirty times that at which a wave would be unstable by itself, at which
/// an exponent is imaginary.
///
/// # Errors
/// [`NotFollowerDither`] where the exponents do not describe this disc.
pub fn marginal_frictions(disc: &Disc) -> Result<Option<MarginalFrictions>, NotFollowerDither> {
    let Some(prepared) = dithered::prepared(disc)? else { return Ok(None) };
    let [low, high] = FRICTIONS.map(|share| share * own_threshold(disc));
    let up_to = high.max(2.0);
    let low = low.min(1e-3 * up_to);
    let steps = (PER_DECADE * libm::log10(up_to / low)).ceil();
    let at = |step: f64| low * libm::pow(up_to / low, step / steps);
    let mut grid = vec![0.0];
    let mut step = 0.0;
    while step < steps {
        grid.push(at(step));
        step += 1.0;
    }
    grid.push(up_to);
    let line = |factor: f64| dithered_exponents(&prepared, factor);
    let factors = marginal_values(&line, &grid)?;
    Ok(Some(MarginalFrictions { factors, up_to }))
}

/// The friction over that of the disc at which its first wave is unstable by itself under the mean of its friction,
/// c(β/l + |Ω|) + 2ξβ²/(l g²); 1 where nothing damps the waves.
fn own_threshold(disc: &Disc) -> f64 {
    let speed = disc.speed().abs();
    let mut least = f64::INFINITY;
    for (index, load) in disc.loads().iter().enumerate().filter(|(_, load)| load.friction != 0.0) {
        for (number, mode) in disc.modes().iter().enumerate().filter(|(_, mode)| mode.diameters > 0)
        {
            let l = mode.diameters as f64;
            let square = 0.5 * disc.shape(number, index) * disc.shape(number, index);
            let own = 2.0 * mode.damping * mode.ratio * mode.ratio / (l * square);
            let alone = load.damping * (mode.ratio / l + speed) + own;
            least = least.min(alone / load.friction.abs());
        }
    }
    if least > 0.0 && least.is_finite() { least } else { 1.0 }
}

/// Points of a line over speeds at a dither frequency: equal steps, points next to every meeting of two waves, and points in every
/// predicted tongue.
pub fn tongue_grid(disc: &Disc, speeds: &RangeInclusive<f64>, steps: u32) -> Vec<f64> {
    let (from, to) = (*speeds.start(), *speeds.end());
    let equal = |k: u32| (to - from).mul_add(f64::from(k) / f64::from(steps), from);
    let mut grid: Vec<f64> = (0..=steps).map(equal).collect();
    if let Ok(waves) = Waves::new(disc) {
        for order in [Order::First, Order::Second] {
            let waves = waves.clone().with_order(order);
            let near = from - 0.1..=to + 0.1;
            let meetings = waves.undithered(near.clone()).into_iter().chain(waves.dithered(near));
            for resonance in meetings.filter(Resonance::pair_can_be_unstable) {
                grid.extend(
                    BESIDE.iter().flat_map(|by| [resonance.speed - by, resonance.speed + by]),
                );
                if let Tongue::Between { lower, upper, peak_speed, .. } = resonance.tongue {
                    grid.push(peak_speed);
                    grid.extend(ACROSS.iter().map(|share| (upper - lower).mul_add(*share, lower)));
                }
            }
        }
    }
    grid.retain(|speed| (from..=to).contains(speed));
    ascending(&mut grid);
    grid.dedup_by(|a, b| (*a - *b).abs() <= 1e-9);
    grid
}

/// The exponents of a point of a line in descending order of their rates, conjugates included: their number is then the same along
/// the line.
#[derive(Clone)]
struct LinePoint {
    at: f64,
    exponents: Vec<DiscExponent>,
}

/// The exponents along a line.
struct Line<'a, E> {
    exponents: &'a dyn Fn(f64) -> Result<Vec<DiscExponent>, E>,
    evaluations: usize,
    found: Vec<MarginalValue>,
}

/// Every value between the ends of a grid at which an exponent is imaginary, in ascending order.
///
/// # Errors
/// Those of the exponents.
pub fn marginal_values<E>(
    exponents: &dyn Fn(f64) -> Result<Vec<DiscExponent>, E>,
    grid: &[f64],
) -> Result<Vec<MarginalValue>, E> {
    let mut line = Line { exponents, evaluations: 0, found: Vec::new() };
    let mut before: Option<LinePoint> = None;
    for value in grid {
        let point = line.point(*value)?;
        if let Some(before) = before {
            line.search(&before, &point, DEPTH)?;
        }
        before = Some(point);
    }
    let mut found = line.found;
    ascending_by(&mut found, |a| a.value);
    Ok(found)
}

/// What a rate does between two points of a line.
#[derive(Clone, Copy, PartialEq, Eq)]
enum RateCourse {
    /// It does not change its sign, or is zero along the line.
    Calm,
    /// It changes its sign once, in the first or the second half.
    Crosses { in_first: bool },
    /// Unknown; whether it changes its sign in the first and in the second half.
    Rough { in_halves: [bool; 2] },
}

/// The course of a rate through three points.
fn course(all: [&DiscExponent; 3]) -> RateCourse {
    if all.iter().all(|exponent| exponent.is_zero()) {
        return RateCourse::Calm;
    }
    let [first, middle, last] = all.map(|exponent| exponent.rate);
    let bend = (middle - 0.5 * (first + last)).abs();
    let grows = all.map(|exponent| exponent.rate > exponent.error);
    let in_halves = [grows[0] != grows[1], grows[1] != grows[2]];
    match in_halves {
        [false, false] => {
            let least = first.abs().min(middle.abs()).min(last.abs());
            if least > bend { RateCourse::Calm } else { RateCourse::Rough { in_halves } }
        }
        [true, true] => RateCourse::Rough { in_halves },
        [in_first, _] if (first - last).abs() > 4.0 * bend => RateCourse::Crosses { in_first },
        _ => RateCourse::Rough { in_halves },
    }
}

impl<E> Line<'_, E> {
    fn point(&mut self, at: f64) -> Result<LinePoint, E> {
        self.evaluations += 1;
        let mut exponents = Vec::new();
        for exponent in (self.exponents)(at)? {
            exponents.push(exponent);
            if !exponent.alone {
                exponents.push(exponent);
            }
        }
        descending_by(&mut exponents, |a| a.rate);
        Ok(LinePoint { at, exponents })
    }

    /// Searches between two points.
    fn search(&mut self, first: &LinePoint, last: &LinePoint, depth: u32) -> Result<(), E> {
        let at = 0.5 * (first.at + last.at);
        if !(at > first.at && at < last.at) {
            return Ok(());
        }
        let middle = self.point(at)?;
        let points = [first, &middle, last];
        let count = points.map(|point| point.exponents.len()).into_iter().min().unwrap_or(0);
        let courses: Vec<RateCourse> =
            (0..count).map(|rank| course(points.map(|point| &point.exponents[rank]))).collect();
        let is_rough = |course: &RateCourse| matches!(course, RateCourse::Rough { .. });
        if courses.iter().any(is_rough) && depth > 0 && self.evaluations < MOST {
            self.search(first, &middle, depth - 1)?;
            return self.search(&middle, last, depth - 1);
        }
        for (rank, course) in courses.into_iter().enumerate() {
            let halves = match course {
                RateCourse::Calm => [false, false],
                RateCourse::Crosses { in_first } => [in_first, !in_first],
                RateCourse::Rough { in_halves } => in_halves,
            };
            for (half, crosses) in halves.into_iter().enumerate() {
                if crosses {
                    self.refine(rank, points[half], points[half + 1])?;
                }
            }
        }
        Ok(())
    }

    /// Adds the crossing of a rate between two points.
    fn refine(&mut self, rank: usize, low: &LinePoint, high: &LinePoint) -> Result<(), E> {
        let ends = [&low.exponents[rank], &high.exponents[rank]];
        let grows_beyond = ends[1].rate > ends[0].rate;
        // A conjugate has the same rates at both ends.
        if rank > 0 {
            let before = [&low.exponents[rank - 1], &high.exponents[rank - 1]];
            if (0..2).all(|end| before[end].rate == ends[end].rate && !ends[end].alone) {
                return Ok(());
            }
        }
        // Where another exponent is zero along the line, a rate leaves it at its error.
        let zero = ends.iter().find(|end| end.is_zero()).map_or(0.0, |end| end.error);
        let closeness = Closeness { absolute: 0.0, relative: 4.0 * f64::EPSILON };
        let rate = |at: f64| -> Result<f64, E> {
            let point = self.point(at)?;
            Ok(point.exponents.get(rank).map_or(0.0, |exponent| exponent.rate - zero))
        };
        let Ok(root) = try_find_root(rate, low.at, high.at, closeness)? else { return Ok(()) };
        let value = root.location;
        let frequency = self.point(value)?.exponents.get(rank).map_or(0.0, |known| known.frequency);
        let is_known = |known: &MarginalValue| {
            (known.value - value).abs() <= 1e-9 * value.abs()
                && (known.frequency - frequency).abs() <= 1e-6
        };
        if !self.found.iter().any(is_known) {
            self.found.push(MarginalValue { value, frequency, grows_beyond });
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn exponent(rate: f64, frequency: f64) -> DiscExponent {
        DiscExponent { rate, error: 1e-13, frequency, alone: frequency == 0.0 }
    }

    fn found(of: impl Fn(f64) -> Vec<DiscExponent>, grid: &[f64]) -> Vec<f64> {
        let line = |value: f64| Ok::<_, EigenError>(of(value));
        let found = marginal_values(&line, grid).expect("no error");
        found.iter().map(|marginal| marginal.value).collect()
    }

    #[test]
    fn planted_crossings_are_found() {
        // One crossing, one that is marginal everywhere, one that touches zero from below and does not cross.
        let of = |x: f64| {
            vec![
                exponent(x * x - 0.3, 1.0),
                exponent(0.0, 0.5 + 0.1 * x),
                exponent(-1e-4 - (x - 0.7) * (x - 0.7), 2.0),
            ]
        };
        let grid: Vec<f64> = (0..=4).map(|k| f64::from(k) * 0.25).collect();
        let values = found(of, &grid);
        assert_eq!(values.len(), 1);
        assert!((values[0] - f64::sqrt(0.3)).abs() < 1e-13);
    }

    #[test]
    fn an_excursion_within_a_step_is_found() {
        // It grows between 0.49 and 0.53, the grid has no point there.
        let of = |x: f64| vec![exponent(-(x - 0.49) * (x - 0.53), 1.0)];
        let values = found(of, &[0.0, 1.0]);
        assert_eq!(values.len(), 2);
        assert!((values[0] - 0.49).abs() < 1e-12 && (values[1] - 0.53).abs() < 1e-12);
    }

    #[test]
    fn a_pair_that_splits_into_two_real_ones_is_followed() {
        // μ = −0.2 ± √(x − 0.5): real from 0.5 on, crossing at 0.54.
        let of = |x: f64| {
            let inside = x - 0.5;
            if inside < 0.0 {
                return vec![exponent(-0.2, (-inside).sqrt())];
            }
            vec![exponent(-0.2 + inside.sqrt(), 0.0), exponent(-0.2 - inside.sqrt(), 0.0)]
        };
        let grid: Vec<f64> = (0..=8).map(|k| f64::from(k) * 0.125).collect();
        let values = found(of, &grid);
        assert_eq!(values.len(), 1);
        assert!((values[0] - 0.54).abs() < 1e-12, "{values:?}");
    }
}
