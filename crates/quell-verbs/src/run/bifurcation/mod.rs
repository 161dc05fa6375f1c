//! `bifurcation`: the motion along a parameter, swept up and down with the state carried over. With dither it is a
//! periodic motion, locked or not; without dither a limit cycle, steady sliding or rest.

mod answer;
mod shared;

use std::sync::atomic::Ordering;

use quell_dynamics::attractor::{EndOfRun, MotionKind, NoEnd, SystemAttractor, end_of_run};
use quell_dynamics::simulation::within;
use quell_numerics::interval::RealInterval;

use super::protocol::Protocol;
use super::system::attractor::{NoLocalVerdict, local_verdict};
use super::system::tracked::{TrackRequest, understood};
use super::system::{failed, has_equations};
use super::thresholds::ends_are_valid;
use super::varied::{MOST_VALUES, Range};
use super::{evenly, stopped};
use crate::complaint::{Complaint, Failure};
use crate::effort::STEPS_OF_A_SEARCH;
use crate::running::Running;
use crate::study::{ParameterId, SystemStudy};

pub use answer::words;
pub use shared::{SweepDirection, SweepRequest};
use shared::{directions, ranges};

/// Relative difference of size beyond which the two directions show different motions.
const APART: f64 = 0.02;

/// The same where a motion is not periodic: a record shows only a part of it, whose size varies from record to record.
const APART_IN_RECORDS: f64 = 0.5;

/// The motion at one value.
#[derive(Clone, Debug, PartialEq)]
pub struct SweepPoint {
    /// The parameter.
    pub value: f64,
    /// Verdict on the base response, without dither on steady sliding; or why it is unknown.
    pub local: Result<&'static str, NoLocalVerdict>,
    /// Whether some dither acts here.
    pub is_dithered: bool,
    /// The motion that the sweep is on, or why it cannot be computed.
    pub end: Result<EndOfRun, NoEnd>,
}

impl SweepPoint {
    /// The motion, if it is known.
    pub fn attractor(&self) -> Option<&SystemAttractor> {
        self.end.as_ref().ok().map(|end| &end.attractor)
    }
}

/// A sweep in one direction, in the order of the sweep.
#[derive(Clone, Debug, PartialEq)]
pub struct Branch {
    /// Direction.
    pub direction: SweepDirection,
    /// Its points.
    pub points: Vec<SweepPoint>,
}

/// Sweeps of one parameter of a system.
#[derive(Clone, Debug, PartialEq)]
pub struct Bifurcation {
    /// The parameter and its values.
    pub range: Range,
    /// The start of the first sweep in words.
    pub start: String,
    /// The sweeps, up before down.
    pub branches: Vec<Branch>,
    /// First and last value of each range in which the two directions show different motions.
    pub hysteresis: Vec<RealInterval>,
}

/// Checks the request.
fn checked(study: &SystemStudy, range: &Range) -> Result<(), Failure> {
    has_equations(study, "bifurcation")?;
    let window = RealInterval::new(range.from, range.to);
    let parameter = range.parameter.clone();
    let mut wrong: Vec<Complaint> = Vec::new();
    match understood(study, &TrackRequest { parameter, window, along: None }) {
        Err(Failure::Wrong(complaints)) => wrong.extend(complaints.iter().cloned()),
        other => other?,
    }
    if !(2..=MOST_VALUES).contains(&range.points) {
        let allowed = format!("a whole number from 2 to {MOST_VALUES}");
        wrong.push(Complaint::option("--points", range.points, allowed));
    }
    if !wrong.is_empty() {
        return Err(wrong.into());
    }
    ends_are_valid(study, &range.parameter, window)
}

/// Sweeps a study.
///
/// # Errors
/// Complaints about the request or the start; [`Failure::Failed`] if the work is interrupted.
pub fn run(
    study: &SystemStudy,
    request: &SweepRequest,
    running: Running<'_>,
) -> Result<Bifurcation, Failure> {
    let range = &request.range;
    checked(study, range)?;
    let directions = directions(request);
    let values = evenly(RealInterval::new(range.from, range.to), range.points);
    running.progress.begin(values.len() * directions.len(), 0);
    let parameter = study.model().parameter(&range.parameter)?;
    let mut state: Option<Vec<f64>> = None;
    let mut branches: Vec<Branch> = Vec::new();
    let swept = directions.into_iter().try_for_each(|direction| {
        let mut values = values.clone();
        if direction == SweepDirection::Down {
            values.reverse();
        }
        let mut points = Vec::with_capacity(values.len());
        for value in values {
            if running.stop.load(Ordering::Relaxed) {
                return Err(stopped("bifurcation"));
            }
            let begun = state.take();
            let (point, end) =
                within(STEPS_OF_A_SEARCH, || point(study, &parameter, value, begun))?;
            points.push(point);
            state = Some(end);
            running.progress.advance(1);
        }
        branches.push(Branch { direction, points });
        Ok(())
    });
    running.progress.end();
    swept?;
    let hysteresis = hysteresis(&branches);
    let start = Protocol::Study.words(study);
    Ok(Bifurcation { range: range.clone(), start, branches, hysteresis })
}

/// The motion at one value, and the state from which the next one starts.
fn point(
    study: &SystemStudy,
    parameter: &ParameterId,
    value: f64,
    begun: Option<Vec<f64>>,
) -> Result<(SweepPoint, Vec<f64>), Failure> {
    let study =
        study.varied(&[(parameter.clone(), value)]).map_err(|why| failed("bifurcation", why))?;
    let system = study.system();
    let begun = match begun {
        Some(state) => state,
        None => Protocol::Study.state(&study, system)?,
    };
    let end = end_of_run(system, &study.observe(), &begun);
    let state = end.as_ref().map_or(begun, |end| end.attractor.state.clone());
    let local = local_verdict(system);
    let is_dithered = system.is_dithered();
    Ok((SweepPoint { value, local, is_dithered, end }, state))
}

/// Ranges in which both directions were swept and show different motions.
fn hysteresis(branches: &[Branch]) -> Vec<RealInterval> {
    let [up, down] = branches else { return Vec::new() };
    let pairs = up.points.iter().zip(down.points.iter().rev());
    ranges(pairs.map(|(one, other)| {
        let apart = one.attractor().zip(other.attractor()).is_some_and(|(one, other)| {
            if one.kind == MotionKind::Rest && other.kind == MotionKind::Rest {
                // At rest both sizes are rounding.
                return false;
            }
            let most = one.size().max(other.size());
            let repeats = |attractor: &SystemAttractor| {
                !matches!(
                    attractor.kind,
                    MotionKind::QuasiPeriodic { .. } | MotionKind::NotPeriodic { .. }
                )
            };
            let apart = if repeats(one) && repeats(other) { APART } else { APART_IN_RECORDS };
            one.quiet != other.quiet || (one.size() - other.size()).abs() > apart * most
        });
        (one.value, apart)
    }))
}

impl SweepPoint {
    /// Whether the motion is quiet; `None` if it is unknown.
    pub fn quiet(&self) -> Option<bool> {
        self.attractor().map(|attractor| attractor.quiet)
    }
}
