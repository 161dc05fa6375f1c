//! What may happen between neighbouring points of a box of one coordinate: extremes of the distance of a dither to the ends of the quiet
//! amplitudes by averaging, and peaks of the multipliers of exact responses.
//!
//! A loud interval between two points of a grid is a dip of that distance, or a peak of the multipliers, whose flanks reach the points
//! next to it. A resonance or an antiresonance of the structure has flanks of any width. What has none is not found.

use std::sync::Mutex;

use quell_numerics::interval::RealInterval;
use quell_numerics::order::{ascending, descending_by};
use quell_numerics::roots::{Closeness, minimise};

use super::{DesignProblem, OperatingPoint};
use crate::tasks::answers;

/// Closeness of an extreme of averaging, as a share of the distance of two points: resonances of a hundred-thousandth of it are found.
const CLOSENESS: f64 = 1e-7;

/// The same for a peak of multipliers, each of which is an exact response.
const CLOSENESS_OF_PEAKS: f64 = 0.01;

/// Peaks of multipliers that are located, the largest first.
const PEAKS: usize = 4;

/// The largest distance, a factor of 10⁶: beyond the ends of the range of amplitudes nothing is known.
const FAR: f64 = 14.0;

/// Which extremes are sought.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Towards {
    /// Where a dither is nearest to being loud.
    Loud,
    /// Where it is furthest from it.
    Quiet,
}

/// The brackets of local maxima of values at ascending points; `None` is no value.
fn brackets(points: &[f64], values: &[Option<f64>]) -> Vec<(f64, (f64, f64))> {
    let triples = values.windows(3).zip(points.windows(3));
    let maxima = triples.filter_map(|(values, points)| {
        let [Some(before), Some(here), Some(after)] = values else { return None };
        let is_maximum = here >= before && here >= after && (here > before || here > after);
        is_maximum.then_some((*here, (points[0], points[2])))
    });
    maxima.collect()
}

impl DesignProblem<'_> {
    /// The points of a box of one coordinate, in ascending order; empty for other boxes.
    pub(super) fn line(&self, points: &[Vec<f64>]) -> Vec<f64> {
        if self.over.len() != 1 {
            return Vec::new();
        }
        let mut line: Vec<f64> = points.iter().flatten().copied().collect();
        ascending(&mut line);
        line.dedup();
        line
    }

    /// The logarithm of the ratio of an amplitude to the nearest end of the quiet amplitudes by averaging, negative where it is loud;
    /// `None` where averaging has no answer. The ends of the range of amplitudes are no ends of quiet ones.
    fn averaged_distance(&self, point: f64, others: &[f64], amplitude: f64) -> Option<f64> {
        let range = RealInterval::new(
            self.amplitude.lower.min(amplitude),
            self.amplitude.upper.max(amplitude),
        );
        let at = OperatingPoint { point: &[point], others };
        let quiet = self.plant.averaged(at, range).ok()?;
        let ends = quiet.intervals().iter().flat_map(|RealInterval { lower: low, upper: high }| {
            [(*low > range.lower).then_some(*low), (*high < range.upper).then_some(*high)]
        });
        let distance = |end: f64| libm::log(amplitude / end).abs();
        let nearest = ends.flatten().map(distance).filter(|distance| distance.is_finite());
        let nearest = nearest.fold(FAR, f64::min);
        Some(if quiet.contains(amplitude) { nearest } else { -nearest })
    }

    /// Points between ascending ones at which averaging has a dither nearest to being loud, or furthest from it.
    pub(super) fn averaged_extremes(
        &self,
        points: &[f64],
        (others, amplitude): (&[f64], f64),
        towards: &[Towards],
    ) -> Vec<f64> {
        let distance = |point: f64| self.averaged_distance(point, others, amplitude);
        let distances = answers(self.tasks, points, |point| distance(*point));
        let of_sign = |towards: &Towards| {
            let sign = if *towards == Towards::Loud { -1.0 } else { 1.0 };
            let values: Vec<_> =
                distances.iter().map(|distance| distance.map(|value| sign * value)).collect();
            brackets(points, &values).into_iter().map(move |(_, bracket)| (sign, bracket))
        };
        let found: Vec<(f64, (f64, f64))> = towards.iter().flat_map(of_sign).collect();
        let located = answers(self.tasks, &found, |(sign, (low, high))| {
            let closeness = Closeness { absolute: CLOSENESS * (high - low), relative: 0.0 };
            let against = |point: f64| distance(point).map_or(FAR, |value| -sign * value);
            minimise(against, *low, *high, closeness).ok().map(|extreme| extreme.location)
        });
        located.into_iter().flatten().collect()
    }

    /// What is judged about points around the peaks of known multipliers on the way to them, from ascending points with multipliers.
    pub(super) fn around_peaks<T: Send>(
        &self,
        points: &[f64],
        multipliers: &[Option<f64>],
        judge: impl Fn(f64) -> (Option<f64>, T) + Sync,
    ) -> Vec<(f64, T)> {
        let mut peaks = brackets(points, multipliers);
        descending_by(&mut peaks, |a| a.0);
        peaks.truncate(PEAKS);
        let judged = answers(self.tasks, &peaks, |(_, (low, high))| {
            let closeness =
                Closeness { absolute: CLOSENESS_OF_PEAKS * (high - low), relative: 0.0 };
            let seen = Mutex::new(Vec::new());
            let against = |point: f64| {
                let (multiplier, judged) = judge(point);
                if let Ok(mut seen) = seen.lock() {
                    seen.push((point, judged));
                }
                // A point without a multiplier is what is sought.
                multiplier.map_or(f64::MIN, |multiplier| -multiplier)
            };
            // Whether the search ends or not, what it judged on its way is known.
            let _ = minimise(against, *low, *high, closeness);
            seen.into_inner().unwrap_or_default()
        });
        judged.into_iter().flatten().collect()
    }
}

#[cfg(test)]
mod tests {
    use super::brackets;

    #[test]
    fn maxima_are_bracketed_by_their_neighbours() {
        let points = [0.0, 1.0, 2.0, 3.0, 4.0, 5.0];
        let values = [Some(1.0), Some(3.0), Some(2.0), None, Some(5.0), Some(4.0)];
        assert_eq!(brackets(&points, &values), [(3.0, (0.0, 2.0))]);
        assert!(brackets(&points[..3], &[Some(1.0); 3]).is_empty());
    }
}
