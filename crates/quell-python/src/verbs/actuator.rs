//! `actuator`: where over frequency the actuator can give the dither that quenches.

use quell::verbs::verbs;
use quell::{Failure, RealInterval, Study, quantity};

use crate::answer::NativeAnswer;
use crate::arguments::Pair;

/// Runs the verb.
pub(crate) fn run(study: &Study, frequency: Option<&Pair>) -> Result<NativeAnswer, Failure> {
    let read = |text: &str| quantity::dither_frequency(text, Some(study), "--frequency");
    let frequency = match frequency {
        Some((from, to)) => Some(RealInterval::new(read(from)?, read(to)?)),
        None => None,
    };
    Ok(NativeAnswer::new(verbs(study).actuator(frequency)?))
}
