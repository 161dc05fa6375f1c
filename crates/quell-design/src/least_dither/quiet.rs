//! Amplitudes of a dither at which a structure is quiet.

use crate::{AveragingEnds, NoAnswer};
use quell_numerics::interval::RealInterval;

/// An amplitude at which averaged sliding changes.
#[derive(Clone, Copy, Debug)]
pub(super) struct AveragedChange {
    pub(super) amplitude: f64,
    /// Whether larger amplitudes are quiet.
    pub(super) becomes_quiet: bool,
    /// Why averaging does not describe the contacts there, if it does not.
    pub(super) fails: Option<AveragingEnds>,
}

/// Amplitudes at which a structure is quiet: disjoint intervals in ascending order, within the range that was searched.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct QuietAmplitudes {
    intervals: Vec<RealInterval>,
}

impl QuietAmplitudes {
    /// Of intervals in ascending order without common points.
    pub(super) fn of_intervals(intervals: Vec<RealInterval>) -> Self {
        Self { intervals }
    }

    /// From the verdict at the lower end of a range and the changes of the verdict in it, in ascending order: (amplitude, whether
    /// larger amplitudes are quiet).
    pub fn of_changes(
        range: RealInterval,
        quiet_at_first: bool,
        changes: impl IntoIterator<Item = (f64, bool)>,
    ) -> Self {
        let mut intervals = Vec::new();
        let mut begin = quiet_at_first.then_some(range.lower);
        for (at, becomes_quiet) in changes {
            match (begin, becomes_quiet) {
                (None, true) => begin = Some(at),
                (Some(since), false) => {
                    intervals.push(RealInterval::new(since, at));
                    begin = None;
                }
                (None, false) | (Some(_), true) => {}
            }
        }
        intervals.extend(begin.map(|since| RealInterval::new(since, range.upper)));
        let inside = intervals.into_iter().filter_map(|interval| interval.intersection(range));
        Self { intervals: inside.collect() }
    }

    /// The part in a range of the amplitudes that are quiet by averaging. Beyond the first change at which averaging does not describe
    /// the contacts, nothing is quiet.
    pub(super) fn by_averaging(
        range: RealInterval,
        quiet_without: bool,
        changes: &[AveragedChange],
    ) -> Self {
        let end = changes.iter().find(|change| change.fails.is_some());
        let end = end.map(|change| (change.amplitude, false));
        let valid = changes.iter().filter(|change| change.fails.is_none());
        let valid = valid.map(|change| (change.amplitude, change.becomes_quiet));
        let from_zero = RealInterval::new(0.0, range.upper);
        let whole = Self::of_changes(from_zero, quiet_without, valid.chain(end));
        let whole = whole.intervals.into_iter();
        let inside = whole.flat_map(|quiet| [(quiet.lower, true), (quiet.upper, false)]);
        let inside = inside.filter(|(at, quiet)| *quiet || *at < range.upper);
        Self::of_changes(range, false, inside)
    }

    /// The first range of amplitudes that are quiet by averaging, up to the next change or without bound.
    ///
    /// # Errors
    /// Why no amplitude is.
    pub(super) fn first_by_averaging(
        quiet_without: bool,
        changes: &[AveragedChange],
    ) -> Result<RealInterval, NoAnswer> {
        let every =
            Self::by_averaging(RealInterval::new(0.0, f64::INFINITY), quiet_without, changes);
        every.intervals.first().copied().ok_or_else(|| {
            NoAnswer::NeverQuietByAveraging(changes.iter().find_map(|change| change.fails))
        })
    }

    /// The same amplitudes in another unit, of which one is `factor` of the present one.
    #[must_use]
    pub fn times(mut self, factor: f64) -> Self {
        for RealInterval { lower, upper } in &mut self.intervals {
            (*lower, *upper) = (*lower * factor, *upper * factor);
        }
        self
    }

    /// The intervals.
    pub fn intervals(&self) -> &[RealInterval] {
        &self.intervals
    }

    /// Whether an amplitude is quiet.
    pub fn contains(&self, amplitude: f64) -> bool {
        self.intervals.iter().any(|interval| interval.contains(amplitude))
    }

    /// The least quiet amplitude from one on.
    pub fn least_from(&self, amplitude: f64) -> Option<f64> {
        let beyond = self.intervals.iter().find(|interval| interval.upper >= amplitude)?;
        Some(beyond.lower.max(amplitude))
    }
}

/// The least amplitude from `from` on that is quiet in every set, with the set that decides (`None`: `from` itself is quiet in all).
///
/// # Errors
/// The number of a set that has no quiet amplitude beyond those that the others need.
pub(super) fn least_of_all<'a>(
    sets: &(impl Iterator<Item = &'a QuietAmplitudes> + Clone),
    from: f64,
) -> Result<(f64, Option<usize>), usize> {
    let mut least = (from, None);
    loop {
        let before = least.0;
        for (number, set) in sets.clone().enumerate() {
            let next = set.least_from(least.0).ok_or(number)?;
            if next > least.0 {
                least = (next, Some(number));
            }
        }
        if least.0 == before {
            return Ok(least);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gaps_of_several_sets_are_stepped_over() {
        let range = RealInterval::new(0.0, 10.0);
        // Quiet up to 1 and from 3 on; quiet up to 4 and from 5 on; quiet everywhere.
        let one = QuietAmplitudes::of_changes(range, true, [(1.0, false), (3.0, true)]);
        let two = QuietAmplitudes::of_changes(range, true, [(4.0, false), (5.0, true)]);
        let all = QuietAmplitudes::of_changes(range, true, []);
        let sets = [one.clone(), two.clone(), all];
        assert_eq!(least_of_all(&sets.iter(), 0.0), Ok((0.0, None)));
        assert_eq!(least_of_all(&sets.iter(), 2.0), Ok((3.0, Some(0))));
        assert_eq!(least_of_all(&sets.iter(), 4.5), Ok((5.0, Some(1))));
        // The gap of the second set begins where that of the first ends.
        let three = QuietAmplitudes::of_changes(range, true, [(2.5, false), (3.5, true)]);
        assert_eq!(least_of_all(&[&one, &three].into_iter(), 2.0), Ok((3.5, Some(1))));
        let never = QuietAmplitudes::of_changes(range, true, [(4.0, false)]);
        assert_eq!(least_of_all(&[&two, &never].into_iter(), 4.5), Err(1));
        assert!(one.contains(1.0) && !one.contains(2.0) && one.contains(3.0));
        assert_eq!(one.intervals(), [RealInterval::new(0.0, 1.0), RealInterval::new(3.0, 10.0)]);
    }
}
