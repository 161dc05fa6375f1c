//! `orbit`: the periodic response and its Floquet multipliers.

use quell::kind::verbs;
use quell::run::orbit::Wanted;
use quell::{Failure, Study};

use super::thresholds::protocols;
use crate::answer::NativeAnswer;
use crate::arguments::{Pair, state};

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
