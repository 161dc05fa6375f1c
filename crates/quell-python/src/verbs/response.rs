//! `response`: the steady response, what the dither does to it, and what it costs.

use quell::kind::verbs;
use quell::{Failure, Study};

use crate::answer::NativeAnswer;

/// Answers.
pub(crate) fn run(study: &Study) -> Result<NativeAnswer, Failure> {
    Ok(NativeAnswer::new(verbs(study)?.response()?))
}
