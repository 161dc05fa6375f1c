//! `cite`: the equations and papers that a study's computations use.

use quell::Study;
use quell::verbs::verbs;

use crate::answer::NativeAnswer;

/// Runs the verb.
pub(crate) fn run(study: &Study) -> NativeAnswer {
    NativeAnswer::new(verbs(study).cite())
}
