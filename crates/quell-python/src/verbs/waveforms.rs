//! `waveforms`: the least dither of each waveform that quenches, and its cost.

use quell::verbs::verbs;
use quell::{Failure, Study};

use crate::answer::NativeAnswer;

/// Runs the verb.
pub(crate) fn run(study: &Study) -> Result<NativeAnswer, Failure> {
    Ok(NativeAnswer::new(verbs(study).waveforms()?))
}
