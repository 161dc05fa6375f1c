//! Values of a parameter at which a run of a system begins or ceases to end quiet.
//!
//! The run is judged at equal steps of the parameter. Between two values with different outcomes the orbit of the quiet run is
//! continued; where it loses its stability, and runs on both sides confirm it, is the value. Elsewhere, at the border of a basin
//! of attraction, the interval is halved.

use quell_model::{RefusedNumbers, System};
use quell_numerics::interval::RealInterval;

use super::outcome::{NoOutcome, NoStart, RunOutcome, outcome_of_run};
use crate::orbit::{NoOrbit, OrbitVerdict, ThresholdKind, branch_thresholds, ramped_motion};
use crate::simulation::within;

/// Relative width of the interval at which halving ends, in thresholds and designs alike: answers show six digits. A larger one would show
/// in them; a smaller one only takes longer.
pub const SWITCH_CLOSENESS: f64 = 1e-5;

/// Distance from a threshold, over the step, at which runs confirm it.
const CONFIRMED: f64 = 1e-3;

/// Steps in which an orbit is continued between two values.
const STEPS: u32 = 8;

/// A change of the outcome.
#[derive(Clone, Debug, PartialEq)]
pub struct RunSwitch {
    /// The parameter.
    pub value: f64,
    /// Bound on its error.
    pub error: f64,
    /// The outcome for larger values.
    pub becomes: RunOutcome,
    /// The kind of threshold of the orbit of the run; `None` where the run changes to another motion that exists on both sides.
    pub kind: Option<ThresholdKind>,
}

/// The outcomes of a run over a parameter.
#[derive(Clone, Debug, PartialEq)]
pub struct RunSwitches {
    /// The outcome at the first value.
    pub first: RunOutcome,
    /// Its changes, ascending.
    pub changes: Vec<RunSwitch>,
    /// Values at which the outcome is unknown, and why.
    pub unknown: Vec<(f64, NoOutcome)>,
}

/// The state at t = 0 from which a run of a system at a value of the parameter starts, or why it is unknown.
pub type StartOfRun<'a> = dyn Fn(f64, &System) -> Result<Vec<f64>, NoStart> + Sync + 'a;

/// A run over a parameter.
#[derive(Clone, Copy)]
pub struct VariedRun<'a> {
    /// Its start.
    pub start: &'a StartOfRun<'a>,
    /// Time over which its dither is ramped up; 0 switches it on at once.
    pub ramp: f64,
    /// The system at a value of the parameter.
    pub at: &'a (dyn Fn(&[f64]) -> Result<System, RefusedNumbers> + Sync),
    /// Most integration steps at one value.
    pub most_steps: u64,
}

impl VariedRun<'_> {
    /// The outcome at one value.
    pub fn outcome(&self, value: f64) -> RunOutcome {
        let settle = || -> Result<RunOutcome, NoOutcome> {
            let system = (self.at)(&[value]).map_err(NoOutcome::Refused)?;
            let start = (self.start)(value, &system).map_err(NoOutcome::NoStart)?;
            // Without dither there is nothing to ramp up.
            let start = match ramped_motion(&system, &start, self.ramp) {
                Err(NoOrbit::NoDither) => start,
                ramped => ramped.map_err(NoOutcome::NoRamp)?,
            };
            outcome_of_run(&system, &start).map_err(NoOutcome::NoEnd)
        };
        within(self.most_steps, settle).unwrap_or_else(RunOutcome::Unknown)
    }

    /// The change between two values, in ascending order, with different outcomes.
    pub fn change(
        &self,
        (low, below): (f64, &RunOutcome),
        (high, above): (f64, &RunOutcome),
    ) -> RunSwitch {
        self.exact((low, below), (high, above))
            .unwrap_or_else(|| self.halved((low, below), (high, above)))
    }

    /// The threshold of the orbit of the quiet run, confirmed by runs on both sides.
    fn exact(
        &self,
        (low, below): (f64, &RunOutcome),
        (high, above): (f64, &RunOutcome),
    ) -> Option<RunSwitch> {
        let (from, to, state, periods) = match (below, above) {
            (RunOutcome::Quiet(state, periods), _) => (low, high, state, *periods),
            (_, RunOutcome::Quiet(state, periods)) => (high, low, state, *periods),
            _ => return None,
        };
        let found = branch_thresholds(&self.at, from, to, STEPS, Some((state, periods))).ok()?;
        let upwards = to > from;
        let threshold = found.thresholds.iter().find(|threshold| {
            let (near, far) = if upwards {
                (threshold.was, threshold.becomes)
            } else {
                (threshold.becomes, threshold.was)
            };
            near == Some(OrbitVerdict::Stable) && far != Some(OrbitVerdict::Stable)
        })?;
        let offset = CONFIRMED * (high - low) + 10.0 * threshold.error;
        let sides = [threshold.value - offset, threshold.value + offset];
        let [first, last] = sides.map(|value| self.outcome(value.clamp(low, high)).is_quiet());
        let is_confirmed = first == below.is_quiet() && last == above.is_quiet();
        is_confirmed.then(|| RunSwitch {
            value: threshold.value,
            error: threshold.error,
            becomes: above.clone(),
            kind: Some(threshold.kind),
        })
    }

    /// The change by halving the interval.
    fn halved(
        &self,
        (low, below): (f64, &RunOutcome),
        (high, above): (f64, &RunOutcome),
    ) -> RunSwitch {
        let (mut from, mut to) = (low, high);
        let mut becomes = above.clone();
        while to - from > SWITCH_CLOSENESS * from.abs().max(to.abs()) {
            let middle = 0.5 * (from + to);
            let found = self.outcome(middle);
            match found.is_quiet() {
                None => break,
                same if same == below.is_quiet() => from = middle,
                _ => (to, becomes) = (middle, found),
            }
        }
        RunSwitch { value: 0.5 * (from + to), error: 0.5 * (to - from), becomes, kind: None }
    }
}

/// The values at equal steps of a window, both ends included.
pub fn values_tried(
    RealInterval { lower: from, upper: to }: RealInterval,
    steps: u32,
) -> impl Iterator<Item = f64> {
    (0..=steps).map(move |k| {
        if k == steps { to } else { from + (to - from) * f64::from(k) / f64::from(steps) }
    })
}

/// A value with its outcome.
pub type TriedValue<'a> = (f64, &'a RunOutcome);

impl RunSwitches {
    /// From the outcomes at ascending values; `change` finds the changes between the pairs of neighbouring values that differ.
    pub fn of(
        outcomes: &[(f64, RunOutcome)],
        change: impl FnOnce(&[[TriedValue<'_>; 2]]) -> Vec<RunSwitch>,
    ) -> Self {
        let unknown = outcomes.iter().filter_map(|(value, outcome)| match outcome {
            RunOutcome::Unknown(why) => Some((*value, why.clone())),
            _ => None,
        });
        let unknown = unknown.collect();
        let first = outcomes.first().map(|(_, outcome)| outcome.clone());
        let known: Vec<TriedValue<'_>> = outcomes
            .iter()
            .filter(|(_, outcome)| outcome.is_quiet().is_some())
            .map(|(value, outcome)| (*value, outcome))
            .collect();
        let differ = known.windows(2).filter(|pair| pair[0].1.is_quiet() != pair[1].1.is_quiet());
        let pairs: Vec<[TriedValue<'_>; 2]> = differ.map(|pair| [pair[0], pair[1]]).collect();
        let changes = change(&pairs);
        let first = first.unwrap_or(RunOutcome::Unknown(NoOutcome::NothingTried));
        Self { first, changes, unknown }
    }
}
