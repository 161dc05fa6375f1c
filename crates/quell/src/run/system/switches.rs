//! Values of a parameter at which a run of a dithered system changes from a motion in step with the dither to another one, or
//! back.
//!
//! The run is settled at equal steps of the parameter. Between two values with different outcomes the orbit of the run in step is
//! continued; where it loses its stability, and runs on both sides confirm it, is the value. Elsewhere, at the border of a basin
//! of attraction, the interval is halved.

use quell_dynamics::motion::orbit::{NoMotionOrbit, motion_thresholds, ramped_motion, settled};
use quell_dynamics::orbit::OrbitVerdict;
use quell_dynamics::orbit::threshold::ThresholdKind;
use quell_model::System;
use rayon::prelude::*;

use super::protocol::SystemProtocol;
use crate::complaint::Failure;
use crate::study::SystemStudy;

/// Equal steps between the values tried; two changes between neighbouring values that cancel are missed.
pub const STEPS_TRIED: u32 = 20;

/// Relative width of the interval at which halving ends.
const CLOSENESS: f64 = 1e-5;

/// Distance from a threshold, over the step, at which runs confirm it.
const CONFIRMED: f64 = 1e-3;

/// Steps in which an orbit is continued between two values.
const STEPS: u32 = 8;

/// The motion on which a run ends.
#[derive(Clone, Debug, PartialEq)]
pub enum RunOutcome {
    /// A periodic motion with the period of the dither; its state.
    InStep(Vec<f64>),
    /// A periodic motion with several periods of the dither.
    Locked(u32),
    /// A motion that does not repeat itself.
    NotPeriodic,
    /// The run cannot be computed.
    Unknown(String),
}

impl RunOutcome {
    /// Whether the motion has the period of the dither; `None` if it is unknown.
    pub fn is_in_step(&self) -> Option<bool> {
        match self {
            Self::InStep(_) => Some(true),
            Self::Locked(_) | Self::NotPeriodic => Some(false),
            Self::Unknown(_) => None,
        }
    }
}

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
    pub unknown: Vec<(f64, String)>,
}

/// A run over a parameter.
pub struct VariedRun<'a> {
    /// The study.
    pub study: &'a SystemStudy,
    /// Its start.
    pub protocol: &'a SystemProtocol,
    /// Time over which its dither is ramped up; 0 switches it on at once.
    pub ramp: f64,
    /// The system at a value of the parameter.
    pub at: &'a (dyn Fn(&[f64]) -> Result<System, String> + Sync),
}

impl VariedRun<'_> {
    /// The outcome at one value.
    fn outcome(&self, value: f64) -> RunOutcome {
        let settle = || -> Result<RunOutcome, String> {
            let system = (self.at)(&[value])?;
            let start = self.protocol.state(self.study, &system).map_err(|why| why_of(&why))?;
            // Without dither there is nothing to ramp up.
            let start = match ramped_motion(&system, &start, self.ramp) {
                Err(NoMotionOrbit::NoDither) => start,
                ramped => ramped.map_err(|why| why.to_string())?,
            };
            match settled(&system, &start) {
                Ok(found) if found.multiple == 1 => Ok(RunOutcome::InStep(found.orbit.state)),
                Ok(found) => Ok(RunOutcome::Locked(found.multiple)),
                Err(NoMotionOrbit::Unsettled { is_steady: true, .. }) => {
                    Ok(RunOutcome::NotPeriodic)
                }
                Err(why) => Err(why.to_string()),
            }
        };
        settle().unwrap_or_else(RunOutcome::Unknown)
    }

    /// The change between two values, in ascending order, with different outcomes.
    fn change(
        &self,
        (low, below): (f64, &RunOutcome),
        (high, above): (f64, &RunOutcome),
    ) -> RunSwitch {
        self.exact((low, below), (high, above))
            .unwrap_or_else(|| self.halved((low, below), (high, above)))
    }

    /// The threshold of the orbit of the run in step, confirmed by runs on both sides.
    fn exact(
        &self,
        (low, below): (f64, &RunOutcome),
        (high, above): (f64, &RunOutcome),
    ) -> Option<RunSwitch> {
        let (from, to, state) = match (below, above) {
            (RunOutcome::InStep(state), _) => (low, high, state),
            (_, RunOutcome::InStep(state)) => (high, low, state),
            _ => return None,
        };
        let found = motion_thresholds(&self.at, (from, to), STEPS, Some((state, 1))).ok()?;
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
        let [first, last] = sides.map(|value| self.outcome(value.clamp(low, high)).is_in_step());
        let is_confirmed = first == below.is_in_step() && last == above.is_in_step();
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
        while to - from > CLOSENESS * from.abs().max(to.abs()) {
            let middle = 0.5 * (from + to);
            let found = self.outcome(middle);
            match found.is_in_step() {
                None => break,
                same if same == below.is_in_step() => from = middle,
                _ => (to, becomes) = (middle, found),
            }
        }
        RunSwitch { value: 0.5 * (from + to), error: 0.5 * (to - from), becomes, kind: None }
    }
}

/// The reason of a failure.
fn why_of(why: &Failure) -> String {
    match why {
        Failure::Failed { why, .. } => why.clone(),
        Failure::Wrong(complaints) => complaints
            .iter()
            .map(|complaint| complaint.allowed.clone())
            .collect::<Vec<_>>()
            .join("; "),
    }
}

/// The changes of a run over a window of a parameter.
pub fn run_switches(run: &VariedRun<'_>, (from, to): (f64, f64)) -> RunSwitches {
    let value = |k: u32| match k {
        STEPS_TRIED => to,
        k => from + (to - from) * f64::from(k) / f64::from(STEPS_TRIED),
    };
    let outcomes: Vec<(f64, RunOutcome)> =
        (0..=STEPS_TRIED).into_par_iter().map(|k| (value(k), run.outcome(value(k)))).collect();
    let unknown = outcomes.iter().filter_map(|(value, outcome)| match outcome {
        RunOutcome::Unknown(why) => Some((*value, why.clone())),
        _ => None,
    });
    let unknown = unknown.collect();
    let first = outcomes[0].1.clone();
    let known: Vec<&(f64, RunOutcome)> =
        outcomes.iter().filter(|(_, outcome)| outcome.is_in_step().is_some()).collect();
    let pairs = known.par_windows(2);
    let changes = pairs
        .filter(|pair| pair[0].1.is_in_step() != pair[1].1.is_in_step())
        .map(|pair| run.change((pair[0].0, &pair[0].1), (pair[1].0, &pair[1].1)))
        .collect();
    RunSwitches { first, changes, unknown }
}
