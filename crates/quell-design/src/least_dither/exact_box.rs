//! The exact least amplitude of a box of operating points, sought near that of averaging.

use super::quiet::QuietAmplitudes;
use super::search::{DesignPoint, box_points};
use super::worst_point::{BoxSearch, LeastOfBox, NoLeast, judged, least_from};
use super::{DesignProblem, DesignStart};
use crate::NoAnswer;
use crate::tasks::Tasks;
use quell_numerics::interval::RealInterval;

/// Window of exact thresholds about the amplitude of averaging, as factors.
pub(super) const WINDOW: RealInterval = RealInterval::new(0.85, 1.15);

/// First step over the box about the points of averaging, as a share of its ranges.
const FIRST_STEP: f64 = 0.015625;

/// Last step of a design, and where runs are judged: each takes many of them.
const CLOSENESS: f64 = 1e-7;
const CLOSENESS_OF_RUNS: f64 = 1e-3;

/// Share by which a search begins below the end of a loud set, so that the set decides.
const BELOW: f64 = 1e-12;

/// The quiet amplitudes of an operating point in a range, or why they are unknown.
pub(super) type QuietSet<'a> =
    dyn Fn(&[f64], RealInterval) -> Result<QuietAmplitudes, NoAnswer> + Sync + 'a;

/// A box of operating points with the amplitudes that are allowed.
#[derive(Clone, Copy, Debug)]
pub(super) struct ExactBox<'a> {
    /// Both ends of every coordinate.
    pub(super) over: &'a [RealInterval],
    /// Smallest and largest amplitude.
    pub(super) amplitude: RealInterval,
    /// The runs that must end quiet.
    pub(super) start: DesignStart,
    /// Last step over the box, as a share of its ranges.
    pub(super) closeness: f64,
    /// Who judges points.
    pub(super) tasks: &'a dyn Tasks,
}

/// What is known of the least amplitude at a neighbouring choice, or by averaging.
#[derive(Clone, Copy, Debug)]
pub(super) struct Near<'a> {
    pub(super) amplitude: f64,
    /// The points at which loud sets were climbed.
    pub(super) decisive: &'a [Vec<f64>],
    /// The point that decides.
    pub(super) worst: Option<&'a Vec<f64>>,
}

impl<'a> From<&'a DesignPoint> for Near<'a> {
    fn from(point: &'a DesignPoint) -> Self {
        Self { amplitude: point.amplitude, decisive: &point.decisive, worst: point.worst.as_ref() }
    }
}

impl<'a> ExactBox<'a> {
    /// That of a problem.
    pub(super) fn of(problem: &DesignProblem<'a>) -> Self {
        let closeness = match problem.start {
            DesignStart::Local => CLOSENESS,
            DesignStart::Rest | DesignStart::Squeal => CLOSENESS_OF_RUNS,
        };
        let DesignProblem { over, amplitude, start, tasks, .. } = *problem;
        Self { over, amplitude, start, closeness, tasks }
    }

    /// The points that decide at a neighbouring choice, and points on both sides of each: an exact tip may end before that of averaging.
    fn neighbourhood(&self, near: Near<'_>) -> Vec<Vec<f64>> {
        let mut points = near.decisive.to_vec();
        points.extend(near.worst.cloned());
        points.dedup();
        if points.is_empty() {
            return box_points(self.over);
        }
        for point in points.clone() {
            for (coordinate, RealInterval { lower, upper }) in self.over.iter().enumerate() {
                for sign in [1.0, -1.0] {
                    let mut next = point.clone();
                    let value = point[coordinate] + sign * FIRST_STEP * (upper - lower);
                    next[coordinate] = value.clamp(*lower, *upper);
                    if !points.contains(&next) {
                        points.push(next);
                    }
                }
            }
        }
        points
    }

    /// The exact least amplitude from `lowest` on.
    pub(super) fn least(
        &self,
        exact: &QuietSet<'_>,
        near: Near<'_>,
        lowest: f64,
    ) -> Result<LeastOfBox, NoLeast> {
        let RealInterval { lower: from, upper: to } = self.amplitude;
        let points = self.neighbourhood(near);
        // Runs from afar may need much more than the local threshold.
        let upper = match self.start {
            DesignStart::Local => (near.amplitude.max(lowest) * WINDOW.upper).min(to),
            DesignStart::Rest | DesignStart::Squeal => to,
        };
        let least = |points: Vec<Vec<f64>>, range: RealInterval, near: Option<f64>| {
            let lower = range.lower;
            let quiet = |point: &[f64]| exact(point, range);
            // Averaging has shown that smaller amplitudes are loud somewhere: the search begins at the loud sets that end near its
            // amplitude.
            let mut begin = lower;
            let known = judged(self.tasks, points, &quiet)?;
            for ((_, set), near) in known.iter().zip(near.into_iter().cycle()) {
                let ends = set.intervals().iter().map(|quiet| quiet.lower);
                let ends = ends.filter(|low| *low > lower);
                let nearest = ends.min_by(|a, b| (a - near).abs().total_cmp(&(b - near).abs()));
                begin = begin.max(nearest.map_or(lower, |end| end * (1.0 - BELOW)));
            }
            let (step, closeness) = (FIRST_STEP, self.closeness);
            let Self { over: ranges, tasks, .. } = *self;
            let search = BoxSearch { ranges, from: begin, step, closeness, tasks };
            least_from(search, known, &quiet)
        };
        let lower = lowest.clamp(from, upper);
        let about = Some(near.amplitude.max(lower));
        let found = match least(points.clone(), RealInterval::new(lower, upper), about) {
            // The quiet amplitudes of the points do not meet in the window: they may beyond it.
            Err(NoLeast::NeverQuiet { .. }) if upper < to => {
                least(points, RealInterval::new(lower, to), about)?
            }
            found => found?,
        };
        // By exact thresholds nothing is loud near the amplitude of averaging: the whole range is searched, and the whole box.
        if found.worst.is_none() && lower > from {
            return least(box_points(self.over), RealInterval::new(from, upper), None);
        }
        Ok(found)
    }
}
