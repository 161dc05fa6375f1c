//! `orbit`: the periodic response and its Floquet multipliers.

use quell::run::orbit::Wanted;
use quell::run::protocol::Protocol;
use quell::verbs::{system_of, verbs};
use quell::{Failure, Study};

use crate::answer::NativeAnswer;
use crate::arguments::GivenState;

/// Runs the verb. `after`: name of a start; `start`: a state. The run from there is followed.
pub(crate) fn run(
    study: &Study,
    near: Option<&GivenState>,
    periods: u32,
    after: Option<&str>,
    start: Option<&GivenState>,
) -> Result<NativeAnswer, Failure> {
    let system = system_of(study, "orbit")?;
    let near = near.map(|given| given.numbers(&system, "--near")).transpose()?;
    let start = start.map(|given| given.numbers(&system, "--start")).transpose()?;
    let named = match after {
        Some("from_rest") => Some(Protocol::Rest),
        Some("from_sliding") => Some(Protocol::Sliding),
        Some(_) => Some(Protocol::Squeal),
        None => None,
    };
    let wanted = match (named.or(start.map(Protocol::From)), near) {
        (Some(protocol), _) => Wanted::After(protocol),
        (None, Some(state)) => Wanted::Near { state, periods },
        (None, None) => Wanted::Base { periods },
    };
    Ok(NativeAnswer::new(verbs(study).orbit(&wanted)?))
}
