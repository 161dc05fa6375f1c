//! Runs: functions from a checked study to a typed result, which can be written as JSON and as a dataset.
//!
//! One file per verb. Numbers are reported in the units of the equations and, for a study in SI, also in
//! SI ([`crate::fields`]).

pub mod actuator;
pub mod basins;
pub(crate) mod belt_system;
pub mod bifurcation;
pub mod check;
pub mod compare;
pub mod criticality;
pub mod decay;
pub mod describing;
pub mod design;
pub mod disc;
mod effect_words;
pub mod exponents;
pub mod fit;
pub mod found_attractor;
pub mod friction;
pub mod law;
pub mod manoeuvre;
pub mod map;
pub mod moment;
pub mod named_estimates;
pub mod noise_response;
pub mod orbit;
pub mod probability;
pub mod protocol;
pub mod ramp;
pub mod record_fit;
pub mod recorded_motion;
pub mod response;
mod sample_times;
pub mod simulate;
pub mod sketch;
pub(crate) mod slip;
pub mod stability;
pub mod system;
pub mod thresholds;
pub mod varied;
pub mod waveforms;
pub mod window;

use quell_dynamics::simulation::{Start, within};
use quell_dynamics::start::NoSquealingStart;

use quell_model::InvalidValues;

use crate::complaint::{Complaint, Failure, Fault, Origin};
use crate::effort::STEPS_OF_A_SEARCH;
use crate::study::{BeltStudy, InitialState};

/// The initial state of a study, in numbers.
///
/// # Errors
/// A complaint if a squealing start is requested but no limit cycle exists.
pub fn start(study: &BeltStudy) -> Result<Start, Failure> {
    resolved(study, study.initial(), |why| {
        let allowed = format!("another state: {why}");
        Complaint::new(Fault::Value, "belt.initial.state", Origin::Whole, "squealing", allowed)
    })
}

/// The numbers of an initial state; `refused` makes the complaint if it is a limit cycle that does not exist.
fn resolved(
    study: &BeltStudy,
    initial: InitialState,
    refused: impl FnOnce(NoSquealingStart) -> Complaint,
) -> Result<Start, Failure> {
    // Steady sliding and squeal at the beginning are those of the drive and load there.
    let name = match initial {
        InitialState::Sliding => Some("sliding"),
        InitialState::Squealing => Some("squealing"),
        InitialState::Rest | InitialState::Explicit { .. } => None,
    };
    let first = match name {
        Some(name) => study.belt().steady_at(0.0).map_err(|why| of_beginning(name, &why))?,
        None => study.belt().clone(),
    };
    let found = within(STEPS_OF_A_SEARCH, || initial.resolve(&first));
    found.map_err(|why| match why {
        NoSquealingStart::Stalled(stalled) => failed(stalled),
        NoSquealingStart::SettlesToSliding | NoSquealingStart::BeltAtRest => refused(why).into(),
    })
}

/// The complaint about a named start for which a belt is not ready at τ = 0.
fn of_beginning(name: &str, invalid: &InvalidValues) -> Complaint {
    let allowed = format!(
        "rest or given numbers: the belt at the start of the run has no steady sliding, because {invalid}"
    );
    Complaint::new(Fault::Value, "belt.initial.state", Origin::Whole, name, allowed)
}

/// The failure of an interrupted verb.
fn stopped(verb: &str) -> Failure {
    Failure::Failed { key: verb.to_owned(), why: "stopped; no results were kept".to_owned() }
}

/// `count` values at equal steps; both ends are included and exact.
fn evenly((from, to): (f64, f64), count: usize) -> Vec<f64> {
    let last = count.saturating_sub(1);
    let value = |k: usize| from + (to - from) * k as f64 / last as f64;
    (0..count).map(|k| if k == last { to } else { value(k) }).collect()
}

fn failed(why: impl std::fmt::Display) -> Failure {
    Failure::Failed { key: "simulation".to_owned(), why: why.to_string() }
}
