//! `thresholds`: values of a parameter at which the base response, or a periodic motion near a state, gains or loses stability, and
//! those at which runs from given starts begin or cease to end quiet. `answer` has the answer as data, `sentence` in words, and
//! `curves` the thresholds over a second parameter, `window` the range that is searched where none is given. Without dither and without runs, eigenvalues decide
//! ([`tracked`](super::system::tracked)).

mod answer;
pub mod curves;
mod sentence;
mod window;

use std::sync::Mutex;

use quell_dynamics::attractor::{NoStart, RunOutcome, RunSwitches, VariedRun, values_tried};
use quell_dynamics::orbit::{
    BASE_STEPS, BranchEnding, BranchThresholds, NoOrbit, OrbitVerdict, SystemAt, base_response,
    branch_thresholds, sliding_state, sliding_verdict,
};
use quell_dynamics::response::dither_reaches_the_band;
use quell_linear::growth::Verdict;
use quell_model::{RefusedNumbers, System};
use quell_numerics::interval::RealInterval;
use serde_json::Value as Json;

use super::protocol::Protocol;
use super::slip::SlipReached;
use super::system::start::{StateNumbers, start_with};
use super::system::tracked::{TrackRequest, understood};
use super::system::{failed, has_equations};
use crate::complaint::{Complaint, Complaints, Failure, Fault, Origin};
use crate::document::given_number;
use crate::effort::STEPS_OF_A_SEARCH;
use crate::parallel::Parallel;
use crate::quantity::bearable;
use crate::study::SystemStudy;
use crate::words::quantity_is;

pub use answer::events_in_words;
pub use window::{AMPLITUDE, window_of};

/// Equal steps between the values at which runs are tried; two changes between neighbouring values that cancel are missed.
pub const TRIED: u32 = 40;

/// Minimum number of continuation steps over the range.
const STEPS: u32 = 40;

/// Options of `thresholds`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ThresholdsRequest {
    /// Path of the parameter.
    pub parameter: String,
    /// First and last value, in the unit of that key.
    pub window: RealInterval,
    /// Numbers of a state near which the motion to follow is searched at the first value, and its number of dither periods; the
    /// base response if `None`.
    pub near: Option<(StateNumbers, u32)>,
    /// Runs to follow in addition.
    pub protocols: Vec<Protocol>,
    /// Time over which the dither of a run is ramped up from zero, in steps of its period; 0 switches it on at once.
    pub ramp: f64,
}

impl ThresholdsRequest {
    /// The same parameter and window for eigenvalues.
    pub fn tracked(&self) -> TrackRequest {
        TrackRequest { parameter: self.parameter.clone(), window: self.window, along: None }
    }
}

/// The thresholds of a parameter.
#[derive(Clone, Debug)]
pub struct Thresholds {
    /// The request.
    pub request: ThresholdsRequest,
    /// The branch of motions and its changes of stability, or why no such branch exists.
    pub local: Result<BranchThresholds, NoOrbit>,
    /// Whether a base response exists at the last value although the branch ends before it.
    pub resumes: bool,
    /// The changes of each run.
    pub runs: Vec<(Protocol, RunSwitches)>,
    /// Whether each run ends quiet without dither at every value, so that there is nothing to quench: known where the parameter changes
    /// the dither alone.
    pub quiet_without: Vec<bool>,
    /// Whether a dither acts in the band of the fastest growing vibration at an end of the window, so that a motion in step with it
    /// may vibrate.
    pub in_band: bool,
    /// Whether a dither acts somewhere in the window.
    pub dithered: bool,
    /// Largest slip speed that each contact reaches in the responses and runs.
    pub slip: Vec<f64>,
    /// Values at which nothing squeals without dither, so that the run from squeal starts from steady sliding.
    pub silent: Vec<f64>,
}

/// Rejects a window at whose ends the study is not valid.
pub(super) fn ends_are_valid(
    study: &SystemStudy,
    path: &str,
    RealInterval { lower: from, upper: to }: RealInterval,
) -> Result<(), Failure> {
    let model = study.model();
    let parameter = model.parameter(path)?;
    for (option, value) in [("--from", from), ("--to", to)] {
        model.at(&[(parameter.clone(), value)]).map_err(|why| {
            let allowed = format!("a value that {path} can take: {why}");
            Complaint::option(option, given_number(value), allowed)
        })?;
    }
    Ok(())
}

/// Whether some dither acts at an end of the window.
pub fn is_dithered_within(study: &SystemStudy, request: &ThresholdsRequest) -> bool {
    let RealInterval { lower: from, upper: to } = request.window;
    let model = study.model();
    let Ok(parameter) = model.parameter(&request.parameter) else { return false };
    study.system().is_dithered()
        || [from, to].iter().any(|value| {
            model.at(&[(parameter.clone(), *value)]).is_ok_and(|system| system.is_dithered())
        })
}

/// Whether eigenvalues of steady sliding decide: no dither acts in the window, and no run is requested.
///
/// # Errors
/// A complaint about each option that is about dithered motions where no dither acts.
pub fn by_eigenvalues(study: &SystemStudy, request: &ThresholdsRequest) -> Result<bool, Failure> {
    if is_dithered_within(study, request) {
        return Ok(false);
    }
    without_dither(request)?;
    Ok(request.protocols.is_empty())
}

/// Thresholds of a study.
///
/// # Errors
/// Complaints about the request; [`Failure::Failed`] if there is no periodic motion at the first value and no run is requested.
pub fn run(study: &SystemStudy, request: &ThresholdsRequest) -> Result<Thresholds, Failure> {
    has_equations(study, "thresholds")?;
    understood(study, &request.tracked())?;
    can_ramp(request.ramp, request.protocols.is_empty())?;
    let path = request.parameter.as_str();
    let model = study.model();
    let parameter = model.parameter(path)?;
    let dithered = is_dithered_within(study, request);
    let at = |values: &[f64]| -> Result<System, RefusedNumbers> {
        let numbers = [(parameter.clone(), values[0])];
        let system = model.at(&numbers).map_err(RefusedNumbers::by_study)?;
        // A dither of amplitude 0 has no period of its own.
        Ok(if dithered { system } else { system.undithered() })
    };
    let RealInterval { lower: from, upper: to } = request.window;
    ends_are_valid(study, path, request.window)?;
    let local = match &request.near {
        Some((numbers, periods)) => {
            let guess = start_with(study, numbers)?.state;
            branch_thresholds(&at, from, to, STEPS, Some((&guess, *periods)))
        }
        None => branch_thresholds(&at, from, to, STEPS, None),
    };
    if let Err(why) = &local
        && (request.protocols.is_empty() || request.near.is_some())
    {
        return Err(failed(
            "thresholds",
            format!(
                "{why}, at the {}: begin where a base response exists, give a state near another motion (--near), or \
                 request runs (--from-rest, --from-squeal, …)",
                quantity_is(path, &from.to_string())
            ),
        ));
    }
    let ends = local.as_ref().is_ok_and(|local| local.ending != BranchEnding::Covered);
    let resumes = (local.is_err() || ends)
        && request.near.is_none()
        && at(&[to]).is_ok_and(|system| base_response(&system, BASE_STEPS).is_ok());
    let silent = Mutex::new(Vec::new());
    let runs = request.protocols.iter().map(|protocol| {
        let start = |value: f64, system: &System| {
            let (state, is_silent) = begin(study, system, protocol)?;
            if is_silent && let Ok(mut silent) = silent.lock() {
                silent.push(value);
            }
            Ok(state)
        };
        let run =
            VariedRun { start: &start, ramp: request.ramp, at: &at, most_steps: STEPS_OF_A_SEARCH };
        let still = |values: &[f64]| at(values).map(|system| system.undithered());
        let changes_the_dither = dithered && still(&[from]) == still(&[to]);
        let without = VariedRun { at: &still, ramp: 0.0, ..run };
        let quiet_without = changes_the_dither && without.outcome(from).is_quiet() == Some(true);
        ((protocol.clone(), side_by_side(&run, request.window)), quiet_without)
    });
    let (runs, quiet_without): (Vec<(Protocol, RunSwitches)>, Vec<bool>) = runs.unzip();
    let in_band = [from, to]
        .iter()
        .any(|value| at(&[*value]).is_ok_and(|system| dither_reaches_the_band(&system)));
    let silent = silent.into_inner().unwrap_or_default();
    let (request, slip) = (request.clone(), Vec::new());
    let found = Thresholds {
        request,
        local,
        resumes,
        runs,
        quiet_without,
        in_band,
        dithered,
        slip,
        silent,
    };
    let slip = found.slip(study, &at);
    Ok(Thresholds { slip, ..found })
}

/// The state from which a run starts, and whether nothing squeals, so that a run from squeal starts from steady sliding.
fn begin(
    study: &SystemStudy,
    system: &System,
    protocol: &Protocol,
) -> Result<(Vec<f64>, bool), NoStart> {
    match protocol.state(study, system) {
        Err(_) if *protocol == Protocol::Squeal && slides_steadily(system) => {
            Ok((sliding_state(system).map_err(NoStart::NoSliding)?, true))
        }
        state => Ok((state.map_err(|why| NoStart::OfStudy(why_of(&why)))?, false)),
    }
}

impl Thresholds {
    /// The slip that the responses at the thresholds and at both ends of the branch reach, and the runs from their starts at the ends of the
    /// window and at their changes.
    fn slip(&self, study: &SystemStudy, at: &SystemAt<'_>) -> Vec<f64> {
        let mut slip = SlipReached::new(study.system());
        if let Ok(local) = &self.local {
            let ends = [local.branch.first(), local.branch.last()].into_iter().flatten();
            let ends = ends.map(|point| (point.value, &point.state));
            let thresholds = local.thresholds.iter().map(|found| (found.value, &found.state));
            for (value, state) in ends.chain(thresholds) {
                if let Ok(system) = at(&[value]) {
                    slip.add(&system, state);
                }
            }
        }
        let RealInterval { lower: from, upper: to } = self.request.window;
        for (protocol, switches) in &self.runs {
            let changes = switches.changes.iter().map(|change| change.value);
            for system in
                [from, to].into_iter().chain(changes).filter_map(|value| at(&[value]).ok())
            {
                if let Ok((state, _)) = begin(study, &system, protocol) {
                    slip.add(&system, &state);
                }
            }
        }
        slip.largest()
    }
}

/// The changes of a run over a window, with the runs at its values side by side.
fn side_by_side(run: &VariedRun<'_>, window: RealInterval) -> RunSwitches {
    let values: Vec<f64> = values_tried(window, TRIED).collect();
    let outcomes: Vec<(f64, RunOutcome)> =
        values.in_parallel(|value| (*value, run.outcome(*value))).collect();
    RunSwitches::of(&outcomes, |pairs| pairs.in_parallel(|[a, b]| run.change(*a, *b)).collect())
}

/// Whether steady sliding without dither is stable.
fn slides_steadily(system: &System) -> bool {
    sliding_verdict(&system.undithered()) == Ok(Verdict::Stable)
}

/// The reason of a failure.
fn why_of(why: &Failure) -> String {
    match why {
        Failure::Failed { why, .. } => why.to_string(),
        Failure::Wrong(complaints) => {
            complaints.iter().map(|complaint| &*complaint.allowed).collect::<Vec<_>>().join("; ")
        }
    }
}

/// Rejects a time over which a dither cannot be ramped up, or that belongs to no run.
fn can_ramp(ramp: f64, without_runs: bool) -> Result<(), Complaints> {
    let mut wrong: Vec<Complaint> = Vec::new();
    wrong.extend(bearable(ramp, given_number(ramp), "--ramp").err().map(|complaint| *complaint));
    if ramp > 0.0 && without_runs {
        let allowed = "requires --from-rest, --from-sliding, --from-squeal or --start: it ramps up the dither of those runs";
        let origin = Origin::Argument("--ramp");
        wrong.push(Complaint::new(Fault::Conflict, "--ramp", origin, ramp, allowed));
    }
    if wrong.is_empty() { Ok(()) } else { Err(wrong.into()) }
}

/// The verdict on one side of a threshold; "none" if this response does not exist there.
pub fn side(verdict: Option<OrbitVerdict>) -> &'static str {
    verdict.map_or("none", OrbitVerdict::name)
}

/// Rejects `--near` and `--ramp` where no dither acts.
///
/// # Errors
/// A complaint about each option that is about dithered motions.
fn without_dither(request: &ThresholdsRequest) -> Result<(), Failure> {
    let near = request.near.as_ref().map(|_| "--near");
    let ramp = (request.ramp != 0.0).then_some("--ramp");
    let wrong: Vec<Complaint> = near
        .into_iter()
        .chain(ramp)
        .map(|option| {
            let allowed = "left out: without dither the thresholds are those of steady sliding and of runs that are not ramped up; \
                           `bifurcation` follows limit cycles over a parameter";
            Complaint::new(Fault::Conflict, option, Origin::Argument(option), Json::Null, allowed)
        })
        .collect();
    if wrong.is_empty() { Ok(()) } else { Err(wrong.into()) }
}
