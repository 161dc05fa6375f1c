//! `response`: the steady response, the effect of the dither on it, and the cost of the dither.

use quell::run::response::{ResponseRequest, ResponseTexts};
use quell::verbs::verbs;
use quell::{Failure, Study};

use crate::answer::NativeAnswer;

/// Runs the verb; `seeds`: number of runs under noise.
pub(crate) fn run(
    study: &Study,
    texts: ResponseTexts<'_>,
    seeds: Option<usize>,
) -> Result<NativeAnswer, Failure> {
    let request = texts.read(&study.system())?;
    Ok(NativeAnswer::new(verbs(study).response(&ResponseRequest { seeds, ..request })?))
}
