//! `modes`: natural frequencies and shapes of a disc.

use quell::verbs::verbs;
use quell::{Failure, Study};

use crate::answer::NativeAnswer;

/// Runs the verb.
pub(crate) fn run(study: &Study) -> Result<NativeAnswer, Failure> {
    Ok(NativeAnswer::new(verbs(study).modes()?))
}
