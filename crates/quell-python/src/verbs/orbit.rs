//! `orbit`: the periodic response and its Floquet multipliers.

use quell::kind::verbs;
use quell::run::orbit::Wanted;
use quell::run::system::orbit::WantedMotion;
use quell::run::system::protocol::{SystemProtocol, numbers_of};
use quell::{Failure, Study};

use super::thresholds::protocols;
use crate::answer::NativeAnswer;
use crate::arguments::{NamedNumbers, Pair, state};

/// Runs the verb. `after`: names of starts; `start`: a state. The run from the first one is followed.
pub(crate) fn run(
    study: &Study,
    near: Option<&Pair>,
    periods: u32,
    after: &[String],
    start: Option<&Pair>,
) -> Result<NativeAnswer, Failure> {
    let verbs = verbs(study);
    let scales = study.scales();
    let near = near.map(|pair| state(pair, scales, "--near")).transpose()?;
    let start = start.map(|pair| state(pair, scales, "--start")).transpose()?;
    let wanted = match (protocols(after, start).into_iter().next(), near) {
        (Some(protocol), _) => Wanted::After(protocol),
        (None, Some(state)) => Wanted::Near { state, periods },
        (None, None) => Wanted::OfSliding { periods },
    };
    Ok(NativeAnswer::new(verbs.orbit(wanted)?))
}

/// Runs the verb on a system, near a state or from a start, whose numbers have names.
pub(crate) fn run_of_system(
    study: &Study,
    near: Option<&NamedNumbers>,
    periods: u32,
    start: Option<&NamedNumbers>,
) -> Result<NativeAnswer, Failure> {
    let system = study.system()?;
    let near = near.map(|pairs| numbers_of(&system, "--near", pairs)).transpose()?;
    let start = start.map(|pairs| numbers_of(&system, "--start", pairs)).transpose()?;
    let wanted = match (start, near) {
        (Some(start), _) => WantedMotion::After(SystemProtocol::From(start)),
        (None, Some(state)) => WantedMotion::Near { state, periods },
        (None, None) => WantedMotion::Base { periods },
    };
    Ok(NativeAnswer::new(verbs(study).orbit_of_system(&wanted)?))
}
