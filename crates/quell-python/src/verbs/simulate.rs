//! `simulate`: one trajectory with its events.

use quell::kind::verbs;
use quell::run::simulate::Options;
use quell::{Failure, Study, quantity};

use crate::answer::NativeAnswer;

/// Runs the verb.
pub(crate) fn run(
    study: &Study,
    until: &str,
    events: bool,
    samples: bool,
) -> Result<NativeAnswer, Failure> {
    let verbs = verbs(study);
    let until = quantity::duration(until, study.scales(), "--until")?;
    Ok(NativeAnswer::new(verbs.simulate(until, Options { events, samples, undithered: false })?))
}
