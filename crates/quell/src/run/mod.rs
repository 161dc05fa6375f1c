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
pub mod range;
pub mod response;
pub mod simulate;
pub mod stability;
pub mod thresholds;
pub mod varied;

use quell_dynamics::simulation::{Stalled, Start, within};
use quell_dynamics::start::NoSquealingStart;

use quell_model::parameter::BELT_VELOCITY;
use quell_model::units::{Quantity, Scales};

use crate::complaint::{Complaint, Failure, Fault, Origin};
use crate::study::vocabulary::in_system;
use crate::study::{InitialState, Study};

/// Most steps of all runs that one search takes: for an orbit, for where one start ends, or for one value of a parameter.
/// Ordinary ones take a hundredth of it.
pub(crate) const STEPS_OF_A_SEARCH: u64 = 100_000_000;

/// Most steps of all runs that a verb of many searches takes.
const STEPS_OF_MANY_SEARCHES: u64 = 10 * STEPS_OF_A_SEARCH;

/// The state a study starts from, in numbers.
///
/// # Errors
/// A complaint where a squealing start is asked for and there is none.
pub fn start(study: &Study) -> Result<Start, Failure> {
    resolved(study, study.initial(), |why| {
        let allowed = format!("another state: {why}");
        Complaint::new(Fault::Value, "belt.initial.state", Origin::Whole, "squealing", allowed)
    })
}

/// The numbers of a state; `refused` complains where it is the limit cycle and there is none.
fn resolved(
    study: &Study,
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
fn moves(study: &Study, why: &str) -> Result<(), Failure> {
    let velocity = study.belt().belt_velocity();
    if velocity > 0.0 {
        return Ok(());
    }
    let key = in_system(BELT_VELOCITY.path, study.scales().is_some());
    let allowed = format!("above 0: {why}");
    Err(Complaint::new(Fault::Value, key, Origin::Whole, velocity, allowed).into())
}

/// The start in words.
pub fn start_in_words(study: &Study) -> String {
    match study.initial() {
        InitialState::Rest => "from rest".to_owned(),
        InitialState::Sliding => "from steady sliding".to_owned(),
        InitialState::Squealing => "from the undithered limit cycle".to_owned(),
        InitialState::Explicit { displacement, velocity } => {
            let displacement = in_words(study, Quantity::Displacement, displacement);
            let velocity = in_words(study, Quantity::Velocity, velocity);
            format!("from x = {displacement}, x′ = {velocity}")
        }
    }
}

/// A quantity in a sentence: six digits, in SI where the study is.
pub(crate) fn in_words(study: &Study, quantity: Quantity, value: f64) -> String {
    in_scales(study.scales(), quantity, value)
}

/// The same of a study with these scales.
fn in_scales(scales: Option<Scales>, quantity: Quantity, value: f64) -> String {
    match scales.zip(quantity.si_unit()) {
        Some((scales, (unit, _))) => format!("{} {unit}", digits(scales.to_si(quantity, value))),
        None => digits(value),
    }
}

/// Six significant digits, without zeros that say nothing.
fn digits(value: f64) -> String {
    let text = format!("{value:.5e}");
    text.parse::<f64>()
        .map_or(text, |rounded| format!("{rounded:?}").trim_end_matches(".0").to_owned())
}

/// The ending of a noun after a count.
pub fn plural(count: usize) -> &'static str {
    if count == 1 { "" } else { "s" }
}

/// What a stopped verb says.
fn stopped(verb: &str) -> Failure {
    Failure::Failed { key: verb.to_owned(), why: "stopped; nothing is kept".to_owned() }
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_numbers_are_told_as_they_are() {
        for (value, told) in
            [(1e-8, "1e-8"), (4.3224, "4.3224"), (20.0, "20"), (0.0, "0"), (1234567.0, "1234570")]
        {
            assert_eq!(digits(value), told);
        }
    }
}
