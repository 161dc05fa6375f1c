//! `stability`: averaged stability of steady sliding; eigenvalues or Floquet exponents of a disc.

use quell::kind::verbs;
use quell::{Failure, Study};

use crate::answer::NativeAnswer;

/// Answers.
pub(crate) fn run(study: &Study) -> Result<NativeAnswer, Failure> {
    Ok(NativeAnswer::new(verbs(study)?.stability()?))
}
