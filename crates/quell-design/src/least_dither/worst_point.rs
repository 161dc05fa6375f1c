//! The least amplitude that is quiet in a whole box of operating points, and the point that decides it.
//!
//! Every point p of the box has a set of quiet amplitudes. The least amplitude in all of them is max over p of the upper end of a
//! set of loud amplitudes. That end is not smooth in p, and may end at a tip beyond which every amplitude is quiet (two thresholds meet
//! there), so that it is climbed by a pattern search, which needs no derivative and stops at the tip as at a smooth maximum. Each step
//! of a climb goes to a point at which the amplitude reached before is loud, so that every amplitude up to the top is loud somewhere on
//! its way: the search goes on from the top, until no known set is loud there.

use super::quiet::{QuietAmplitudes, least_of_all};
use crate::NoAnswer;
use crate::tasks::{Tasks, answers};
use quell_numerics::interval::RealInterval;

/// Loud sets that are climbed at most.
const ROUNDS: usize = 24;

/// What is searched.
#[derive(Clone, Copy, Debug)]
pub(super) struct BoxSearch<'a> {
    /// Both ends of every coordinate of the box.
    pub(super) ranges: &'a [RealInterval],
    /// The amplitude from which a quiet one is sought.
    pub(super) from: f64,
    /// First step of the climb, as a share of each range.
    pub(super) step: f64,
    /// Step at which it ends, the same way.
    pub(super) closeness: f64,
    /// Who judges points that are known at the beginning.
    pub(super) tasks: &'a dyn Tasks,
}

/// An operating point with its quiet amplitudes.
pub(super) type JudgedPoint = (Vec<f64>, QuietAmplitudes);

/// The quiet amplitudes of an operating point, or why they are unknown.
pub(super) type QuietAt<'a> = dyn Fn(&[f64]) -> Result<QuietAmplitudes, NoAnswer> + Sync + 'a;

/// The least amplitude of a box.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct LeastOfBox {
    /// The amplitude.
    pub(super) amplitude: f64,
    /// The point that decides; `None` where the lower bound of the amplitude is quiet everywhere.
    pub(super) worst: Option<Vec<f64>>,
    /// Every point at which a loud set was climbed.
    pub(super) decisive: Vec<Vec<f64>>,
}

/// Why no amplitude is quiet in the whole box.
#[derive(Clone, Debug, PartialEq)]
pub enum NoLeast {
    /// No allowed amplitude is quiet at this point, beyond those that other points need.
    NeverQuiet {
        /// The point.
        point: Vec<f64>,
    },
    /// A point has no answer.
    Failed {
        /// The point.
        point: Vec<f64>,
        /// Why.
        why: NoAnswer,
    },
}

/// The quiet amplitudes of every one of some points.
pub(super) fn judged(
    tasks: &dyn Tasks,
    points: Vec<Vec<f64>>,
    quiet: &QuietAt<'_>,
) -> Result<Vec<JudgedPoint>, NoLeast> {
    let sets = answers(tasks, &points, |point| quiet(point));
    let judged = points.into_iter().zip(sets).map(|(point, set)| match set {
        Ok(set) => Ok((point, set)),
        Err(why) => Err(NoLeast::Failed { point, why }),
    });
    judged.collect()
}

/// The least amplitude that is quiet at every point, starting from the sets of some points.
pub(super) fn least_of_box(
    search: BoxSearch<'_>,
    points: Vec<Vec<f64>>,
    quiet: &QuietAt<'_>,
) -> Result<LeastOfBox, NoLeast> {
    least_from(search, judged(search.tasks, points, quiet)?, quiet)
}

/// The same, starting from points whose sets are known.
pub(super) fn least_from(
    search: BoxSearch<'_>,
    mut known: Vec<JudgedPoint>,
    quiet: &QuietAt<'_>,
) -> Result<LeastOfBox, NoLeast> {
    let mut decisive: Vec<Vec<f64>> = Vec::new();
    let mut from = search.from;
    for _ in 0..ROUNDS {
        let found = least_of_all(&known.iter().map(|(_, set)| set), from);
        let (amplitude, place) =
            found.map_err(|place| NoLeast::NeverQuiet { point: known[place].0.clone() })?;
        let Some(place) = place else { break };
        let climbed = climbed(search, known[place].clone(), amplitude, quiet)?;
        from = climbed.amplitude;
        decisive.push(climbed.point.clone());
        known.push((climbed.point, climbed.set));
    }
    let (amplitude, place) = least_of_all(&known.iter().map(|(_, set)| set), from)
        .map_err(|place| NoLeast::NeverQuiet { point: known[place].0.clone() })?;
    // After all rounds a known point may still need more than the last top.
    let worst = place.map(|place| known[place].0.clone()).or_else(|| decisive.last().cloned());
    Ok(LeastOfBox { amplitude, worst, decisive })
}

/// The top of a climb.
struct Climbed {
    point: Vec<f64>,
    set: QuietAmplitudes,
    /// The least quiet amplitude there.
    amplitude: f64,
}

/// Moves a point to where the least quiet amplitude from `amplitude` on is largest.
fn climbed(
    search: BoxSearch<'_>,
    (mut point, mut set): JudgedPoint,
    mut amplitude: f64,
    quiet: &QuietAt<'_>,
) -> Result<Climbed, NoLeast> {
    let mut step = search.step;
    while step > search.closeness {
        let mut moved = false;
        for (coordinate, RealInterval { lower, upper }) in search.ranges.iter().enumerate() {
            for sign in [1.0, -1.0] {
                let value =
                    (point[coordinate] + sign * step * (upper - lower)).clamp(*lower, *upper);
                if value == point[coordinate] {
                    continue;
                }
                let mut next = point.clone();
                next[coordinate] = value;
                let there =
                    quiet(&next).map_err(|why| NoLeast::Failed { point: next.clone(), why })?;
                let Some(least) = there.least_from(amplitude) else {
                    return Err(NoLeast::NeverQuiet { point: next });
                };
                if least > amplitude {
                    (point, set, amplitude, moved) = (next, there, least, true);
                    break;
                }
            }
        }
        if !moved {
            step *= 0.5;
        }
    }
    Ok(Climbed { point, set, amplitude })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tasks::InTurn;

    const RANGES: [RealInterval; 1] = [RealInterval::new(0.0, 1.0)];

    fn search(ranges: &[RealInterval]) -> BoxSearch<'_> {
        BoxSearch { ranges, from: 0.0, step: 0.125, closeness: 1e-9, tasks: &InTurn }
    }

    fn grid(count: u32) -> Vec<Vec<f64>> {
        (0..=count).map(|k| vec![f64::from(k) / f64::from(count)]).collect()
    }

    #[test]
    fn a_tip_is_found_and_a_smooth_maximum() {
        // Loud up to 1 + p while p < 0.3, and quiet at every amplitude beyond: a tip.
        let loud = |point: &[f64]| {
            let quiet = point[0] > 0.3;
            let top = (!quiet).then_some((1.0 + point[0], true));
            Ok(QuietAmplitudes::of_changes(RealInterval::new(0.0, 5.0), quiet, top))
        };
        let least = least_of_box(search(&RANGES), grid(8), &loud).expect("a least amplitude");
        assert!((least.amplitude - 1.3).abs() < 1e-7, "{least:?}");
        assert!((least.worst.expect("a point")[0] - 0.3).abs() < 1e-7);
        let smooth = |point: &[f64]| {
            let top = 2.0 - (point[0] - 0.61).powi(2);
            Ok(QuietAmplitudes::of_changes(RealInterval::new(0.0, 5.0), false, [(top, true)]))
        };
        let least = least_of_box(search(&RANGES), grid(8), &smooth).expect("a least amplitude");
        assert!((least.amplitude - 2.0).abs() < 1e-12, "{least:?}");
    }

    #[test]
    fn a_point_that_is_never_quiet_is_named() {
        let never = |point: &[f64]| {
            let quiet = point[0] < 0.9;
            Ok(QuietAmplitudes::of_changes(RealInterval::new(0.0, 5.0), quiet, []))
        };
        let why = least_of_box(search(&RANGES), grid(8), &never).expect_err("not quiet at 1");
        assert_eq!(why, NoLeast::NeverQuiet { point: vec![1.0] });
    }
}
