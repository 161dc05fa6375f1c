//! Rotation number: the number of revolutions of the slow motion per period of the section, and the fraction at which it locks.
//!
//! Revolutions are counted about the mean of the motion at each phase of the period, clockwise in the (x, x′) plane like the
//! motion of the mass, with at least ten samples in 2π, so that none is missed or counted twice. On a closed orbit of q
//! periods the revolutions are an exact integer p, and the response is locked at p/q; the slow frequency is 2πp/(qT). On a
//! closed curve the revolutions are averaged with the bump of `average`, and the error is the difference of the
//! two halves of the record. Limit: with more than `MOST_SAMPLES` per period (R < 0.04) whole revolutions may be missed.

use std::f64::consts::TAU;

use super::average::{Moments, mean, weights};

/// Samples in 2π, the time of a slow revolution. With two or fewer per revolution its direction would be undetermined; more only
/// take longer.
const SAMPLES: f64 = 10.0;

/// Fewest samples in a period of a closed orbit: the two states of an orbit of two periods are half a revolution apart, which
/// leaves the direction undetermined. More only take longer.
const SAMPLES_OF_AN_ORBIT: usize = 4;

/// Most samples per period, a bound on memory for slow dithers. Whole revolutions may be missed where ten samples in 2π need
/// more.
const MOST_SAMPLES: usize = 256;

/// Number of samples in a period of the section that resolves the slow revolution.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a small count")]
pub(super) fn samples_per_period(period: f64) -> usize {
    ((SAMPLES * period / TAU).ceil() as usize).clamp(1, MOST_SAMPLES)
}

/// [`samples_per_period`] for a closed orbit, which is short.
pub(super) fn samples_per_orbit_period(period: f64) -> usize {
    samples_per_period(period).max(SAMPLES_OF_AN_ORBIT)
}

/// Largest denominator of the fractions that are distinguished from a quasi-periodic motion by the distance covered. Of the 1024
/// periods of a record an irrational number p/q + 1/(√5q²) needs 2.2 q. A motion that creeps near a fraction of a larger
/// denominator counts as filling its curve; with a much larger limit no motion would fill its curve within a record.
const DENOMINATORS: u32 = 64;

/// How often a motion must have crossed every gap of its curve. Crossings are counted by the mean speed so far. Where a locked orbit lies in a
/// gap, a motion that creeps towards it slows down and never crosses, although by its speed before it should have: with 1 a run of figure 2.11
/// that locks after 20 000 periods counted as a curve. With a larger value curves near locking take longer.
const CROSSINGS: f64 = 3.0;

/// A locked motion: `turns` revolutions in `periods` periods.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Ratio {
    /// p.
    pub turns: i64,
    /// q.
    pub periods: u32,
}

/// Revolutions per period.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rotation {
    /// The rotation number.
    pub turns_per_period: f64,
    /// Its error; zero for a locked motion.
    pub error: f64,
    /// The fraction in lowest terms, for a locked motion.
    pub ratio: Option<Ratio>,
}

impl Rotation {
    /// Of a closed orbit: the states of one complete orbit, `samples` per period.
    pub(super) fn of_orbit(states: &[(f64, f64)], samples: usize) -> Self {
        let count = (states.len() / samples) as f64;
        let centres = centres(states, samples, |phase| {
            let sum = phase.iter().fold((0.0, 0.0), |sum, (x, v)| (sum.0 + x, sum.1 + v));
            [sum.0 / count, sum.1 / count]
        });
        let mut closed = states.to_vec();
        closed.extend(states.first().copied());
        let turns = increments(&closed, &centres).iter().sum::<f64>().round();
        #[expect(clippy::cast_possible_truncation, reason = "a whole number below the length")]
        let turns = turns as i64;
        let periods = u32::try_from(states.len() / samples).unwrap_or(u32::MAX).max(1);
        let common = divisor(turns.unsigned_abs(), u64::from(periods)).max(1);
        let ratio = Ratio {
            turns: turns / i64::try_from(common).unwrap_or(1),
            periods: u32::try_from(u64::from(periods) / common).unwrap_or(periods),
        };
        Self { turns_per_period: turns as f64 / f64::from(periods), error: 0.0, ratio: Some(ratio) }
    }

    /// Of a limit cycle without dither with this number of revolutions in a period of the section: exact, and not modulo 1.
    pub(super) fn of_cycle(turns_per_period: f64) -> Self {
        Self { turns_per_period, error: 0.0, ratio: None }
    }

    /// Whether a motion has filled its curve in `periods` periods: relative to every fraction p/q of a small denominator it
    /// has moved by more than `CROSSINGS`/q of a revolution, 1/q being the gap between the q states that it nearly repeats.
    pub(super) fn fills(&self, periods: usize) -> bool {
        (1..=DENOMINATORS).all(|q| {
            let q = f64::from(q);
            let nearest = (self.turns_per_period * q).round() / q;
            periods as f64 * (self.turns_per_period - nearest).abs() * q >= CROSSINGS
        })
    }

    /// Of a long record of motion on a closed curve, `samples` per period.
    pub(super) fn of_curve(states: &[(f64, f64)], samples: usize) -> Self {
        let steps =
            increments(states, &centres(states, samples, |phase| Moments::of(phase).centre));
        let each = samples as f64;
        let over = |steps: &[f64]| each * mean(&weights(steps.len()), steps.iter().copied());
        let (first, second) = steps.split_at(steps.len() / 2);
        Self {
            turns_per_period: over(&steps),
            error: (over(first) - over(second)).abs(),
            ratio: None,
        }
    }
}

/// The centre of the states at each phase of the period.
fn centres(
    states: &[(f64, f64)],
    samples: usize,
    centre: impl Fn(&[(f64, f64)]) -> [f64; 2],
) -> Vec<[f64; 2]> {
    let at = |phase| states.iter().skip(phase).step_by(samples).copied().collect::<Vec<_>>();
    (0..samples).map(|phase| centre(&at(phase))).collect()
}

/// Revolutions between neighbours of a record about the centres of their phases, each in (−½, ½].
fn increments(states: &[(f64, f64)], centres: &[[f64; 2]]) -> Vec<f64> {
    let angles: Vec<f64> = states
        .iter()
        .zip(centres.iter().cycle())
        .map(|((x, v), [cx, cv])| libm::atan2(v - cv, x - cx))
        .collect();
    angles
        .windows(2)
        .map(|pair| {
            let turn = (pair[0] - pair[1]) / TAU;
            turn - (turn - 0.5).ceil()
        })
        .collect()
}

fn divisor(mut a: u64, mut b: u64) -> u64 {
    while b > 0 {
        (a, b) = (b, a % b);
    }
    a
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 1/10 − 2·10⁻⁵ crosses the tenth of a revolution between its strands once in 5000 periods, three times in 15 000; the golden
    /// mean fills.
    #[test]
    fn a_creep_does_not_fill_its_curve() {
        let of = |turns_per_period| Rotation { turns_per_period, error: 0.0, ratio: None };
        assert!(!of(0.1 - 2e-5).fills(8192) && of(0.1 - 2e-5).fills(16_384));
        assert!(of(0.5 * (5.0_f64.sqrt() - 1.0)).fills(1024));
        assert!(!of(0.25).fills(1_000_000));
    }

    #[test]
    fn a_known_rotation_number_is_recovered() {
        // A curve that is not a circle, traversed unevenly: the rotation number is unaffected.
        let point = |turns: f64| {
            let angle = TAU * turns;
            let angle = angle + 0.4 * angle.sin();
            (1.0 + 2.0 * angle.cos() + 0.3 * (2.0 * angle).cos(), -angle.sin())
        };
        let number = 0.1 * 2.0_f64.sqrt();
        let section: Vec<(f64, f64)> = (0..1024).map(|k| point(number * f64::from(k))).collect();
        let found = Rotation::of_curve(&section, 1);
        assert!((found.turns_per_period - number).abs() <= found.error.max(1e-12), "{found:?}");
        assert!(found.error < 1e-6, "{found:?}");
        let section: Vec<(f64, f64)> = (0..68).map(|k| point(f64::from(5 * k) / 68.0)).collect();
        let found = Rotation::of_orbit(&section, 1);
        assert_eq!(found.ratio, Some(Ratio { turns: 5, periods: 68 }));
        // Two revolutions of the orbit: the same fraction in lowest terms.
        let twice: Vec<(f64, f64)> = (0..26).map(|k| point(f64::from(k) / 13.0)).collect();
        let found = Rotation::of_orbit(&twice, 1);
        assert_eq!(found.ratio, Some(Ratio { turns: 1, periods: 13 }));
    }

    /// A motion with 1.3 revolutions per period, and one that closes after two periods with three revolutions: with samples
    /// between, where the section alone would give 0.3, and half a revolution in either direction.
    #[test]
    fn whole_revolutions_are_counted() {
        let samples = samples_per_period(9.0);
        assert_eq!(samples, 15);
        // The forced motion revolves too, but not as part of the slow one.
        let state = |k: u32, number: f64| {
            let (slow, forced) = (TAU * number * f64::from(k), TAU * f64::from(k));
            let (slow, forced) = (slow / samples as f64, forced / samples as f64);
            (slow.cos() + 3.0 * forced.cos(), -slow.sin() - 3.0 * forced.sin())
        };
        let record: Vec<_> = (0..15 * 1024).map(|k| state(k, 0.9 * 2.0_f64.sqrt())).collect();
        let found = Rotation::of_curve(&record, samples);
        assert!((found.turns_per_period - 0.9 * 2.0_f64.sqrt()).abs() < 1e-6, "{found:?}");
        let orbit: Vec<_> = (0..30).map(|k| state(k, 1.5)).collect();
        let found = Rotation::of_orbit(&orbit, samples);
        assert_eq!(found.ratio, Some(Ratio { turns: 3, periods: 2 }));
    }
}
