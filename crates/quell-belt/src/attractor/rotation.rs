//! Rotation number: how many turns the slow motion makes in a period of the strobe, and the fraction at which it locks.
//!
//! A turn is counted about the centre of the section, clockwise in the (x, x′) plane as the mass goes. On a closed orbit of q
//! periods the turns are an exact integer p, and the response is locked at p/q; the slow frequency is 2πp/(qT). On a
//! closed curve the turns of each period are averaged with the bump of `average`, and the error is the difference of the
//! two halves of the record. Limit: turns are counted modulo 1, which is no limit where the dither is twice as
//! fast as the slow motion or faster.

use super::average::{mean, weights};

/// Fractions up to this denominator are distinguished from a quasi-periodic motion by how far it has moved. Of the 1024 periods of a
/// record an irrational number p/q + 1/(√5q²) needs 2.2 q.
const DENOMINATORS: u32 = 64;

/// A locked motion: `turns` in `periods`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Ratio {
    /// p.
    pub turns: i64,
    /// q.
    pub periods: u32,
}

/// Turns a period.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rotation {
    /// The number.
    pub turns_per_period: f64,
    /// Its error; zero where the motion is locked.
    pub error: f64,
    /// The fraction in lowest terms where it is locked.
    pub ratio: Option<Ratio>,
}

impl Rotation {
    /// Of a closed orbit of the section: its states once round.
    pub(super) fn of_orbit(section: &[(f64, f64)], centre: [f64; 2]) -> Self {
        let closed = section.iter().copied().chain(section.first().copied());
        let turns = increments(&closed.collect::<Vec<_>>(), centre).iter().sum::<f64>().round();
        #[expect(clippy::cast_possible_truncation, reason = "a whole number below the length")]
        let turns = turns as i64;
        let periods = u32::try_from(section.len()).unwrap_or(u32::MAX).max(1);
        let common = divisor(turns.unsigned_abs(), u64::from(periods)).max(1);
        let ratio = Ratio {
            turns: turns / i64::try_from(common).unwrap_or(1),
            periods: u32::try_from(u64::from(periods) / common).unwrap_or(periods),
        };
        Self { turns_per_period: turns as f64 / f64::from(periods), error: 0.0, ratio: Some(ratio) }
    }

    /// Of a limit cycle without dither, which makes so many turns in a period of the strobe: exact, and not modulo 1.
    pub(super) fn of_cycle(turns_per_period: f64) -> Self {
        Self { turns_per_period, error: 0.0, ratio: None }
    }

    /// Whether a motion of so many periods has filled its curve: measured against every fraction p/q of a small denominator it
    /// has moved by more than 1/q of a turn, the gap between the q states that it nearly repeats.
    pub(super) fn fills(&self, periods: usize) -> bool {
        (1..=DENOMINATORS).all(|q| {
            let q = f64::from(q);
            let nearest = (self.turns_per_period * q).round() / q;
            periods as f64 * (self.turns_per_period - nearest).abs() * q >= 1.0
        })
    }

    /// Of a long section of motion on a closed curve.
    pub(super) fn of_curve(section: &[(f64, f64)], centre: [f64; 2]) -> Self {
        let steps = increments(section, centre);
        let over = |steps: &[f64]| mean(&weights(steps.len()), steps.iter().copied());
        let (first, second) = steps.split_at(steps.len() / 2);
        Self {
            turns_per_period: over(&steps),
            error: (over(first) - over(second)).abs(),
            ratio: None,
        }
    }
}

/// Turns between neighbours of a section, each in (−½, ½].
fn increments(section: &[(f64, f64)], [cx, cv]: [f64; 2]) -> Vec<f64> {
    let angle = |&(x, v): &(f64, f64)| libm::atan2(v - cv, x - cx);
    section
        .windows(2)
        .map(|pair| {
            let turn = (angle(&pair[0]) - angle(&pair[1])) / std::f64::consts::TAU;
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

    /// 1/10 − 2·10⁻⁵ moves by a fiftieth of a turn in 1024 periods, less than the tenth between its strands; the golden mean fills.
    #[test]
    fn a_creep_does_not_fill_its_curve() {
        let of = |turns_per_period| Rotation { turns_per_period, error: 0.0, ratio: None };
        assert!(!of(0.1 - 2e-5).fills(1024) && of(0.1 - 2e-5).fills(8192));
        assert!(of(0.5 * (5.0_f64.sqrt() - 1.0)).fills(1024));
        assert!(!of(0.25).fills(1_000_000));
    }

    #[test]
    fn a_planted_rotation_is_found() {
        // A curve that is no circle, walked unevenly: the number of turns does not mind.
        let point = |turns: f64| {
            let angle = std::f64::consts::TAU * turns;
            let angle = angle + 0.4 * angle.sin();
            (1.0 + 2.0 * angle.cos() + 0.3 * (2.0 * angle).cos(), -angle.sin())
        };
        let number = 0.1 * 2.0_f64.sqrt();
        let section: Vec<(f64, f64)> = (0..1024).map(|k| point(number * f64::from(k))).collect();
        let found = Rotation::of_curve(&section, [1.0, 0.0]);
        assert!((found.turns_per_period - number).abs() <= found.error.max(1e-12), "{found:?}");
        assert!(found.error < 1e-6, "{found:?}");
        let section: Vec<(f64, f64)> = (0..68).map(|k| point(f64::from(5 * k) / 68.0)).collect();
        let found = Rotation::of_orbit(&section, [1.0, 0.0]);
        assert_eq!(found.ratio, Some(Ratio { turns: 5, periods: 68 }));
        // Twice round: the same fraction in lowest terms.
        let twice: Vec<(f64, f64)> = (0..26).map(|k| point(f64::from(k) / 13.0)).collect();
        let found = Rotation::of_orbit(&twice, [1.0, 0.0]);
        assert_eq!(found.ratio, Some(Ratio { turns: 1, periods: 13 }));
    }
}
