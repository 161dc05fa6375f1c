//! `response`: the steady response, the effect of the dither on it, and the cost of the dither.

use quell::kind::verbs;
use quell::{Failure, Study};

use crate::answer::NativeAnswer;

/// Runs the verb.
pub(crate) fn run(study: &Study) -> Result<NativeAnswer, Failure> {
    Ok(NativeAnswer::new(verbs(study).response()?))
}
