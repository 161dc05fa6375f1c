//! Rotation number: how many turns the slow motion makes in a period of the strobe, and the fraction at which it locks.
//!
//! A turn is counted about the centre of the section, clockwise in the (x, x′) plane as the mass goes. On a closed orbit of q
//! periods the turns are an exact integer p, and the response is locked at p/q; the slow frequency is 2πp/(qT). On a
//! closed curve the turns of each period are averaged with the bump of `average`, and the error is the difference of the
//! two halves of the record. Limit: turns are counted modulo 1, which is no limit where the dither is twice as
//! fast as the slow motion or faster.

use super::average::{mean, weights};

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

/// The fraction of least denominator within `error` of a value, up to the denominator `most`.
pub fn simplest_fraction(value: f64, error: f64, most: u32) -> Option<Ratio> {
    let whole = value.floor();
    #[expect(clippy::cast_possible_truncation, reason = "checked to be small")]
    let base = (whole.abs() < 1e9).then_some(whole as i64)?;
    let rest = value - whole;
    // Down the tree of Stern and Brocot between 0/1 and 1/1: it meets fractions by rising denominator along the way.
    let (mut low, mut high) = ((0_i64, 1_i64), (1_i64, 1_i64));
    let found = |(p, q): (i64, i64)| (p as f64 / q as f64 - rest).abs() <= error;
    let ratio =
        |(p, q): (i64, i64)| Some(Ratio { turns: p + base * q, periods: u32::try_from(q).ok()? });
    for end in [low, high] {
        if found(end) {
            return ratio(end);
        }
    }
    loop {
        let middle = (low.0 + high.0, low.1 + high.1);
        if middle.1 > i64::from(most) {
            return None;
        }
        if found(middle) {
            return ratio(middle);
        }
        if (middle.0 as f64) < rest * middle.1 as f64 { low = middle } else { high = middle }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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

    #[test]
    fn the_simplest_fraction_within_an_error() {
        let found = |value, error| simplest_fraction(value, error, 500);
        assert_eq!(found(5.0 / 68.0, 1e-9), Some(Ratio { turns: 5, periods: 68 }));
        assert_eq!(found(0.1, 1e-12), Some(Ratio { turns: 1, periods: 10 }));
        assert_eq!(found(0.1 + 1e-3, 2e-3), Some(Ratio { turns: 1, periods: 10 }));
        assert_eq!(found(-0.25, 1e-9), Some(Ratio { turns: -1, periods: 4 }));
        assert_eq!(found(0.5_f64.sqrt(), 1e-9), None);
        assert_eq!(found(3.0, 1e-9), Some(Ratio { turns: 3, periods: 1 }));
    }
}
