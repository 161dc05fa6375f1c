//! `thresholds` of a system under dither: values of a parameter at which its base response, or a periodic motion near a state,
//! gains or loses stability, and those at which runs from given starts change.

use quell_dynamics::motion::orbit::{
    BASE_STEPS, MotionThresholds as Local, NoMotionOrbit, RunOutcome, RunSwitches, VariedRun,
    base_motion, motion_thresholds, values_tried,
};
use quell_dynamics::orbit::threshold::BranchEnding;
use quell_dynamics::response::{BAND_END, vibration_frequency};
use quell_model::System;
use quell_model::profile::Wave;
use serde_json::Value as Json;

use super::protocol::SystemProtocol;
use super::start::{StateNumbers, start_with};
use super::tracked::{TrackRequest, understood};
use super::{failed, has_equations};
use crate::complaint::{Complaint, Failure, Fault, Origin};
use crate::effort::STEPS_OF_A_SEARCH;
use crate::parallel::Parallel;
use crate::run::thresholds::{ThresholdsRequest, can_ramp};
use crate::study::SystemStudy;

/// Equal steps between the values at which runs are tried.
pub const STEPS_TRIED: u32 = 20;

/// Minimum number of continuation steps over the range.
const STEPS: u32 = 40;

/// Options of `thresholds` of a system.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MotionThresholdsRequest {
    /// Path of the parameter.
    pub parameter: String,
    /// First and last value, in the unit of that key.
    pub window: (f64, f64),
    /// Numbers of a state near which the motion to follow is searched at the first value, and its number of dither periods; the
    /// base response if `None`.
    pub near: Option<(StateNumbers, u32)>,
    /// Runs to follow in addition.
    pub protocols: Vec<SystemProtocol>,
    /// Time over which the dither of a run is ramped up from zero, in steps of its period; 0 switches it on at once.
    pub ramp: f64,
}

impl MotionThresholdsRequest {
    /// The request about a belt for a system.
    ///
    /// # Errors
    /// A state given by two numbers.
    pub fn of(request: ThresholdsRequest) -> Result<Self, Failure> {
        let ThresholdsRequest { parameter, from, to, protocols, ramp } = request;
        let protocols = protocols.into_iter().map(SystemProtocol::of).collect::<Result<_, _>>()?;
        Ok(Self { parameter, window: (from, to), near: None, protocols, ramp })
    }

    /// The same parameter and window for eigenvalues.
    pub fn tracked(&self) -> TrackRequest {
        TrackRequest { parameter: self.parameter.clone(), window: self.window, along: None }
    }
}

/// The thresholds of the periodic motions of a system.
#[derive(Clone, Debug)]
pub struct MotionThresholdsFound {
    /// The request.
    pub request: MotionThresholdsRequest,
    /// The branch of motions and its changes of stability, or why no such branch exists.
    pub local: Result<Local, NoMotionOrbit>,
    /// Whether a base response exists at the last value although the branch ends before it.
    pub resumes: bool,
    /// The changes of each run.
    pub runs: Vec<(SystemProtocol, RunSwitches)>,
    /// Whether a dither acts in the band of the slowest growing vibration, so that a motion in step with it may vibrate.
    pub in_band: bool,
}

/// Rejects a window at whose ends the study is not valid.
pub(in crate::run) fn ends_are_valid(
    study: &SystemStudy,
    path: &str,
    (from, to): (f64, f64),
) -> Result<(), Failure> {
    let model = study.model();
    let parameter = model.parameter(path)?;
    for (option, value) in [("--from", from), ("--to", to)] {
        model.at(&[(parameter.clone(), value)]).map_err(|why| {
            let allowed = format!("a value that {path} can take: {why}");
            Complaint::option(option, value, allowed)
        })?;
    }
    Ok(())
}

/// Whether some dither acts at an end of the window.
pub fn is_dithered_within(study: &SystemStudy, request: &MotionThresholdsRequest) -> bool {
    let (from, to) = request.window;
    let model = study.model();
    let Ok(parameter) = model.parameter(&request.parameter) else { return false };
    study.system().is_dithered()
        || [from, to].iter().any(|value| {
            model.at(&[(parameter.clone(), *value)]).is_ok_and(|system| system.is_dithered())
        })
}

/// Thresholds of a study whose dither acts somewhere in the window.
///
/// # Errors
/// Complaints about the request; [`Failure::Failed`] if there is no periodic motion at the first value and no run is requested.
pub fn run(
    study: &SystemStudy,
    request: &MotionThresholdsRequest,
) -> Result<MotionThresholdsFound, Failure> {
    has_equations(study, "thresholds")?;
    understood(study, &request.tracked())?;
    can_ramp(request.ramp, request.protocols.is_empty())?;
    let path = request.parameter.as_str();
    let model = study.model();
    let parameter = model.parameter(path)?;
    let at = |values: &[f64]| -> Result<System, String> {
        model.at(&[(parameter.clone(), values[0])]).map_err(|why| why.to_string())
    };
    let (from, to) = request.window;
    ends_are_valid(study, path, (from, to))?;
    let local = match &request.near {
        Some((numbers, periods)) => {
            let guess = start_with(study, numbers)?.state;
            motion_thresholds(&at, (from, to), STEPS, Some((&guess, *periods)))
        }
        None => motion_thresholds(&at, (from, to), STEPS, None),
    };
    if let Err(why) = &local
        && (request.protocols.is_empty() || request.near.is_some())
    {
        return Err(failed(
            "thresholds",
            format!(
                "{why}, at {path} = {from}: begin where a base response exists, give a state near another motion (--near), or \
                 request runs (--from-rest, --from-squeal, …)"
            ),
        ));
    }
    let ends = local.as_ref().is_ok_and(|local| local.ending != BranchEnding::Covered);
    let resumes = (local.is_err() || ends)
        && request.near.is_none()
        && at(&[to]).is_ok_and(|system| base_motion(&system, BASE_STEPS).is_ok());
    let runs = request.protocols.iter().map(|protocol| {
        let start = |system: &System| protocol.state(study, system).map_err(|why| why_of(&why));
        let run =
            VariedRun { start: &start, ramp: request.ramp, at: &at, most_steps: STEPS_OF_A_SEARCH };
        (protocol.clone(), side_by_side(&run, request.window))
    });
    let runs = runs.collect();
    Ok(MotionThresholdsFound {
        request: request.clone(),
        local,
        resumes,
        runs,
        in_band: reaches_the_band(study.system()),
    })
}

/// The changes of a run over a window, with the runs at its values side by side.
fn side_by_side(run: &VariedRun<'_>, window: (f64, f64)) -> RunSwitches {
    let values: Vec<f64> = values_tried(window, STEPS_TRIED).collect();
    let outcomes: Vec<(f64, RunOutcome)> =
        values.in_parallel(|value| (*value, run.outcome(*value))).collect();
    RunSwitches::of(&outcomes, |pairs| pairs.in_parallel(|[a, b]| run.change(*a, *b)).collect())
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

/// Whether a dither is not fast in comparison with the vibration.
pub(crate) fn reaches_the_band(system: &System) -> bool {
    let lowest = system.waves().map(Wave::repetition).fold(f64::INFINITY, f64::min);
    vibration_frequency(system).is_some_and(|vibration| lowest <= BAND_END * vibration)
}

/// Rejects `--near`, `--ramp` and runs where no dither acts.
///
/// # Errors
/// A complaint about each option that is about motions.
pub fn without_motions(request: &MotionThresholdsRequest) -> Result<(), Failure> {
    let options = request.protocols.iter().map(|protocol| match protocol {
        SystemProtocol::Rest => "--from-rest",
        SystemProtocol::Sliding => "--from-sliding",
        SystemProtocol::Squeal => "--from-squeal",
        SystemProtocol::Study | SystemProtocol::From(_) => "--start",
    });
    let near = request.near.as_ref().map(|_| "--near");
    let ramp = (request.ramp != 0.0).then_some("--ramp");
    let wrong: Vec<Complaint> = options
        .chain(near)
        .chain(ramp)
        .map(|option| {
            let allowed = "left out: without dither the thresholds are those of steady sliding; `bifurcation` follows its limit \
                           cycles over a parameter";
            Complaint::new(Fault::Conflict, option, Origin::Argument(option), Json::Null, allowed)
        })
        .collect();
    if wrong.is_empty() { Ok(()) } else { Err(wrong.into()) }
}
