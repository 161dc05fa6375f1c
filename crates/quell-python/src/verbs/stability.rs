//! `stability`: stability of steady sliding by averaging, or of a disc by eigenvalues or Floquet exponents.

use quell::kind::verbs;
use quell::{Failure, Study};

use crate::answer::NativeAnswer;

/// Runs the verb.
pub(crate) fn run(study: &Study) -> Result<NativeAnswer, Failure> {
    Ok(NativeAnswer::new(verbs(study).stability()?))
}
