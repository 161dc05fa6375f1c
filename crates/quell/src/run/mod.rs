//! Runs: a checked study in, a typed outcome out; each outcome as JSON and as a dataset.
//!
//! One file per verb. Numbers leave in the units of the equations and, for a study in SI, in
//! SI beside them ([`crate::fields`]).

pub mod attractor;
pub mod basins;
pub mod bifurcation;
pub mod check;
pub mod curves;
pub mod disc;
pub mod friction;
pub mod law;
pub mod map;
pub mod orbit;
pub mod protocol;
pub mod response;
pub mod simulate;
pub mod stability;
pub mod thresholds;
pub mod varied;

use quell_dynamics::simulation::{Stalled, Start, within};
use quell_dynamics::start::NoSquealingStart;

use quell_model::parameter::BELT_VELOCITY;

use crate::complaint::{Complaint, Failure, Fault, Origin};
use crate::effort::STEPS_OF_A_SEARCH;
use crate::study::vocabulary::in_system;
use crate::study::{BeltStudy, InitialState};

/// The state a study starts from, in numbers.
///
/// # Errors
/// A complaint where a squealing start is asked for and there is none.
pub fn start(study: &BeltStudy) -> Result<Start, Failure> {
    resolved(study, study.initial(), |why| {
        let allowed = format!("another state: {why}");
        Complaint::new(Fault::Value, "belt.initial.state", Origin::Whole, "squealing", allowed)
    })
}

/// The numbers of a state; `refused` complains where it is the limit cycle and there is none.
fn resolved(
    study: &BeltStudy,
    initial: InitialState,
    refused: impl FnOnce(NoSquealingStart) -> Complaint,
) -> Result<Start, Failure> {
    let found = within(STEPS_OF_A_SEARCH, || initial.resolve(study.belt()));
    found.map_err(|why| match why {
        NoSquealingStart::Stalled(stalled) => failed(stalled),
        NoSquealingStart::SettlesToSliding | NoSquealingStart::BeltAtRest => refused(why).into(),
    })
}

/// Refuses a belt at rest, which holds the mass wherever friction can; `why` that is no answer.
fn moves(study: &BeltStudy, why: &str) -> Result<(), Failure> {
    let velocity = study.belt().belt_velocity();
    if velocity > 0.0 {
        return Ok(());
    }
    let key = in_system(BELT_VELOCITY.path, study.scales().is_some());
    let allowed = format!("above 0: {why}");
    Err(Complaint::new(Fault::Value, key, Origin::Whole, velocity, allowed).into())
}

/// What a stopped verb says.
fn stopped(verb: &str) -> Failure {
    Failure::Failed { key: verb.to_owned(), why: "stopped; no results were kept".to_owned() }
}

/// So many values at equal steps, both ends included and exact.
fn evenly((from, to): (f64, f64), count: usize) -> Vec<f64> {
    let last = count.saturating_sub(1);
    let value = |k: usize| from + (to - from) * k as f64 / last as f64;
    (0..count).map(|k| if k == last { to } else { value(k) }).collect()
}

fn failed(stalled: Stalled) -> Failure {
    Failure::Failed { key: "simulation".to_owned(), why: stalled.to_string() }
}
