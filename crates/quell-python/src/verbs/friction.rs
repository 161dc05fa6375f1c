//! `friction`: the law and the effective friction under the dither.

use quell::verbs::verbs;
use quell::{Failure, Study, quantity};

use super::refused;
use crate::answer::NativeAnswer;

/// The describing function for amplitudes up to one, as a number or a text with a unit.
pub(crate) fn describing(study: &Study, largest: &str) -> Result<NativeAnswer, Failure> {
    let largest = quantity::velocity(largest, Some(study), "--describing")?;
    Ok(NativeAnswer::new(verbs(study).describing(largest)?))
}

/// Runs the verb.
pub(crate) fn run(
    study: &Study,
    at: Option<Vec<f64>>,
    texts: &[String],
    measured: bool,
) -> Result<NativeAnswer, Failure> {
    if let Some(wrong) = at.iter().flatten().find(|v| !v.is_finite()) {
        return Err(refused("at", wrong.to_string(), "finite slip velocities"));
    }
    let read = |text: &String| quantity::velocity(text, Some(study), "--at");
    let at = match (at, texts) {
        (None, []) => None,
        (None, texts) => Some(texts.iter().map(read).collect::<Result<Vec<f64>, _>>()?),
        (at, _) => at,
    };
    Ok(NativeAnswer::new(verbs(study).friction(at.as_deref(), measured)?))
}
