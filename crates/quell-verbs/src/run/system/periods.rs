//! How long the motions of a system take: what a run lasts by default, and the windows in which its vibration is sought.

use std::f64::consts::TAU;

use quell_model::system::Mechanical;
use quell_numerics::interval::RealInterval;
use serde_json::Value as Json;

use super::{has_equations, modes};
use crate::complaint::{Complaint, Failure, Fault, Origin};
use crate::study::SystemStudy;

/// Windows of a manoeuvre in which no motion of the structure oscillates. Only the run itself sets a scale of time there: moments are
/// found to within 1 % of it, half of a window.
const WINDOWS_WITHOUT_OSCILLATION: f64 = 50.0;

/// Period of the slowest oscillation of the structure, contacts closed and without friction, or of the dither.
///
/// # Errors
/// A complaint about `option`, the missing duration, if nothing oscillates.
pub(crate) fn slowest_period(study: &SystemStudy, option: &'static str) -> Result<f64, Failure> {
    let own = natural_frequencies(study, 0.0)?;
    let slowest = own.into_iter().chain(study.system().acting_frequencies());
    let slowest = slowest.fold(f64::INFINITY, f64::min);
    if slowest.is_finite() {
        return Ok(TAU / slowest);
    }
    let why = "no motion of this structure oscillates, so that there is no usual length: give one";
    Err(Complaint::new(Fault::Missing, option, Origin::Argument(option), Json::Null, why).into())
}

/// Period of the slowest oscillation of the structure that the run contains, at the beginning of the run where its speed varies; of a
/// structure without one a fiftieth of the run.
pub fn natural_period(
    study: &SystemStudy,
    RealInterval { lower: from, upper: until }: RealInterval,
) -> f64 {
    let length = until - from;
    let periods = natural_frequencies(study, from).ok().map(|found| {
        let periods = found.into_iter().map(|natural| TAU / natural);
        periods.filter(|period| *period < length).reduce(f64::max)
    });
    periods.flatten().unwrap_or(length / WINDOWS_WITHOUT_OSCILLATION)
}

/// Natural frequencies of the oscillating modes at a moment, contacts closed and without friction.
fn natural_frequencies(study: &SystemStudy, time: f64) -> Result<Vec<f64>, Failure> {
    let found = modes_at(study, time)?;
    let oscillating = found.modes.iter().filter(|mode| mode.eigenvalue.im > mode.error);
    Ok(oscillating.map(modes::natural).collect())
}

/// The modes of a study; where its speed varies, those of a moment.
fn modes_at(study: &SystemStudy, time: f64) -> Result<modes::SystemModes, Failure> {
    has_equations(study, "simulate")?;
    let structure = &study.system().structure;
    match structure.mechanical().and_then(Mechanical::by_speed) {
        Some(_) => modes::of(&study.system().steady_at(time)),
        None => modes::of(study.system()),
    }
}

/// The lowest of the natural frequencies at a moment, if anything oscillates.
pub(in crate::run) fn lowest_natural(study: &SystemStudy, time: f64) -> Option<f64> {
    natural_frequencies(study, time).ok()?.into_iter().reduce(f64::min)
}
