//! `friction`: the law and the effective friction under the dither.

use quell::kind::verbs;
use quell::{Failure, Study, quantity};
use quell_model::units::Quantity;

use super::refused;
use crate::answer::NativeAnswer;

/// The describing function for amplitudes up to one, as a number or a text with a unit.
pub(crate) fn describing(study: &Study, largest: &str) -> Result<NativeAnswer, Failure> {
    let largest = velocity(study, largest, "--describing")?;
    Ok(NativeAnswer::new(verbs(study).describing(largest)?))
}

fn velocity(study: &Study, text: &str, option: &'static str) -> Result<f64, Failure> {
    let read = match study.system() {
        Ok(system) => quantity::of_system(text, Some(Quantity::Velocity), system.units(), option),
        Err(_) => quantity::parse(text, Quantity::Velocity, study.scales(), option),
    };
    Ok(read?)
}

/// Runs the verb.
pub(crate) fn run(
    study: &Study,
    at: Option<Vec<f64>>,
    texts: &[String],
    measured: bool,
) -> Result<NativeAnswer, Failure> {
    let verbs = verbs(study);
    let scales = study.scales();
    if let Some(wrong) = at.iter().flatten().find(|v| !v.is_finite()) {
        return Err(refused("at", wrong.to_string(), "finite slip velocities"));
    }
    let scaled = |v: f64| scales.map_or(v, |scales| scales.from_units(Quantity::Velocity, v));
    let read = |text: &String| velocity(study, text, "--at");
    let at = match (at, texts) {
        (Some(at), _) => Some(at.into_iter().map(scaled).collect()),
        (None, []) => None,
        (None, texts) => Some(texts.iter().map(read).collect::<Result<Vec<f64>, _>>()?),
    };
    Ok(NativeAnswer::new(verbs.friction(at, measured)?))
}
