//! The base response over the amplitude of a dither: where its verdict changes, and where it ends.

use quell_dynamics::orbit::{
    BranchEnding, BranchThresholds, OrbitVerdict, ResponseGap, ThresholdKind,
};
use quell_numerics::interval::RealInterval;

use super::quiet::QuietAmplitudes;

/// An amplitude at which the base response becomes quiet, or ceases to be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct QuietChange {
    /// The amplitude.
    pub amplitude: f64,
    /// Bound on its error.
    pub error: f64,
    /// The kind of bifurcation.
    pub kind: ThresholdKind,
    /// Whether slightly larger amplitudes are quiet.
    pub becomes_quiet: bool,
}

/// A threshold of a branch: value, error, kind, and the verdicts below and above it.
pub(super) type BranchThreshold = (f64, f64, ThresholdKind, [Option<OrbitVerdict>; 2]);

/// The verdict on the base response over a range of amplitudes.
#[derive(Clone, Debug, PartialEq)]
pub struct AmplitudeBranch {
    /// The range that was followed.
    pub range: RealInterval,
    /// Whether the least amplitude is quiet.
    pub quiet_at_first: bool,
    /// The changes, in ascending order.
    pub changes: Vec<QuietChange>,
    /// The amplitude beyond which no base response exists, or beyond which it could not be followed.
    pub end: Option<f64>,
}

impl AmplitudeBranch {
    pub(super) fn new(range: RealInterval, found: &BranchThresholds) -> Self {
        let thresholds = found.thresholds.iter().map(|threshold| {
            let sides = [threshold.was, threshold.becomes];
            (threshold.value, threshold.error, threshold.kind, sides)
        });
        let radius = found.branch.first().map(|response| response.radius);
        Self::of(range, radius, thresholds, found.ending).without(&found.gaps)
    }

    /// From the thresholds in the order of a branch, the largest multiplier of its first response, and its ending. A branch that turns
    /// back ends the base response, wherever it continues to.
    pub(super) fn of(
        range: RealInterval,
        first_radius: Option<f64>,
        thresholds: impl Iterator<Item = BranchThreshold> + Clone,
        ending: BranchEnding,
    ) -> Self {
        let stable = Some(OrbitVerdict::Stable);
        let quiet_at_first = match (thresholds.clone().next(), first_radius) {
            (Some((_, _, _, [was, _])), _) => was == stable,
            (None, Some(radius)) => radius < 1.0,
            (None, None) => false,
        };
        let mut changes = Vec::new();
        let mut quiet = quiet_at_first;
        let mut turn = None;
        for (amplitude, error, kind, [_, becomes]) in thresholds {
            let becomes_quiet = becomes == stable;
            if becomes_quiet != quiet {
                changes.push(QuietChange { amplitude, error, kind, becomes_quiet });
                quiet = becomes_quiet;
            }
            if becomes.is_none() {
                turn = Some(amplitude);
                break;
            }
        }
        let end = turn.or(match ending {
            BranchEnding::Covered => None,
            BranchEnding::TurnedBack { at }
            | BranchEnding::Touch { at }
            | BranchEnding::Lost { at } => Some(at),
            BranchEnding::LostTurning { furthest, .. } => Some(furthest),
        });
        Self { range, quiet_at_first, changes, end }
    }

    /// The same with nothing quiet within gaps, in which no response is known.
    fn without(mut self, gaps: &[ResponseGap]) -> Self {
        for gap in gaps {
            if let Some(change) = self.changes.iter_mut().find(|at| at.amplitude == gap.grazing) {
                if change.becomes_quiet == (gap.end > gap.grazing) {
                    change.amplitude = gap.end;
                }
                continue;
            }
            let place = self.changes.partition_point(|change| change.amplitude < gap.grazing);
            let before = place.checked_sub(1).map(|last| self.changes[last].becomes_quiet);
            if before.unwrap_or(self.quiet_at_first) {
                let [from, to] = gap.ends();
                let changes = [(from, false), (to, true)].map(|(amplitude, becomes_quiet)| {
                    let (error, kind) = (0.0, ThresholdKind::Grazing);
                    QuietChange { amplitude, error, kind, becomes_quiet }
                });
                self.changes.splice(place..place, changes);
            }
        }
        self
    }

    /// The amplitudes that are quiet: beyond the end there is no base response that could be.
    pub fn quiet(&self) -> QuietAmplitudes {
        self.quiet_within(self.range)
    }

    /// Those in a part of the range that begins with it.
    pub(super) fn quiet_within(&self, range: RealInterval) -> QuietAmplitudes {
        let changes = self.changes.iter().map(|change| (change.amplitude, change.becomes_quiet));
        let end = self.end.map(|at| (at, false));
        QuietAmplitudes::of_changes(range, self.quiet_at_first, changes.chain(end))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const STABLE: Option<OrbitVerdict> = Some(OrbitVerdict::Stable);
    const UNSTABLE: Option<OrbitVerdict> = Some(OrbitVerdict::Unstable);

    fn branch(thresholds: &[BranchThreshold], ending: BranchEnding) -> AmplitudeBranch {
        AmplitudeBranch::of(
            RealInterval::new(0.0, 10.0),
            Some(0.9),
            thresholds.iter().copied(),
            ending,
        )
    }

    #[test]
    fn a_branch_that_turns_back_ends_the_base_response() {
        let graze = ThresholdKind::Grazing;
        let up = (1.0, 0.0, graze, [UNSTABLE, STABLE]);
        let fold = (4.0, 0.0, ThresholdKind::Fold, [STABLE, None]);
        // On the way back the other response gains stability: it is not the base response.
        let back = (2.0, 0.0, ThresholdKind::Flip, [UNSTABLE, STABLE]);
        let found = branch(&[up, fold, back], BranchEnding::TurnedBack { at: 4.0 });
        assert_eq!(found.end, Some(4.0));
        assert_eq!(found.quiet().intervals(), [RealInterval::new(1.0, 4.0)]);
        let amplitudes: Vec<f64> = found.changes.iter().map(|change| change.amplitude).collect();
        assert_eq!(amplitudes, [1.0, 4.0]);
    }

    #[test]
    fn nothing_within_a_gap_is_quiet() {
        let up = (1.0, 1e-12, ThresholdKind::Grazing, [UNSTABLE, STABLE]);
        let down = (4.0, 1e-12, ThresholdKind::Grazing, [STABLE, UNSTABLE]);
        let gap = |grazing, end| ResponseGap { grazing, end };
        let found = branch(&[up, down], BranchEnding::Covered);
        let gaps = [gap(1.0, 1.01), gap(2.0, 2.5), gap(4.0, 3.98)];
        assert_eq!(
            found.without(&gaps).quiet().intervals(),
            [RealInterval::new(1.01, 2.0), RealInterval::new(2.5, 3.98)]
        );
        // From another side nothing more is unknown.
        let found = branch(&[up, down], BranchEnding::Covered);
        let gaps = [gap(1.0, 0.9), gap(4.0, 4.2), gap(6.0, 7.0)];
        assert_eq!(found.without(&gaps).quiet().intervals(), [RealInterval::new(1.0, 4.0)]);
    }

    #[test]
    fn without_thresholds_the_first_response_decides() {
        let found = branch(&[], BranchEnding::Covered);
        assert!(found.quiet_at_first && found.changes.is_empty());
        assert_eq!(found.quiet().intervals(), [RealInterval::new(0.0, 10.0)]);
        let lost = branch(&[], BranchEnding::Lost { at: 3.0 });
        assert_eq!(lost.quiet().intervals(), [RealInterval::new(0.0, 3.0)]);
    }
}
