//! `window`: what a run does between two of its times.

use quell::kind::verbs;
use quell::run::moment::moment;
use quell::{Failure, Study};

use crate::answer::NativeAnswer;

/// Runs the verb between two times.
pub(crate) fn run(study: &Study, (start, end): (&str, &str)) -> Result<NativeAnswer, Failure> {
    let window = (moment(study, start, "--window")?, moment(study, end, "--window")?);
    Ok(NativeAnswer::new(verbs(study).response_within(window)?))
}
