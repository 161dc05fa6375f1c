//! `check`: the values of a study.

use quell::Study;
use quell::kind::verbs;

use crate::answer::NativeAnswer;

/// Runs the verb.
pub(crate) fn run(study: &Study) -> NativeAnswer {
    NativeAnswer::new(verbs(study).check())
}
