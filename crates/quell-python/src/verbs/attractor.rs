//! `attractor`: the motion on which a run ends, and its Lyapunov exponents.

use quell::run::exponents::ExponentTimes;
use quell::run::found_attractor::AttractorRequest;
use quell::verbs::{system_of, verbs};
use quell::{Failure, Study, quantity};

use crate::answer::NativeAnswer;
use crate::arguments::GivenState;

/// Texts of the time before the record of the exponents and of its length.
pub(crate) type TimeTexts = (Option<String>, Option<String>);

/// Runs the verb; `times`: those of the exponents, if they are requested.
pub(crate) fn run(
    study: &Study,
    start: Option<&GivenState>,
    times: Option<&TimeTexts>,
) -> Result<NativeAnswer, Failure> {
    let system = system_of(study, "attractor")?;
    let start = start.map(|given| given.numbers(&system, "--start")).transpose()?;
    let units = system.units();
    let read = |text: &str, option| Ok(quantity::duration(text, units, option)?);
    let lyapunov = times.map(|times| exponent_times(times, read)).transpose()?;
    let request = AttractorRequest { start: start.unwrap_or_default(), lyapunov };
    Ok(NativeAnswer::new(verbs(study).attractor(&request)?))
}

fn exponent_times(
    (settle, record): &TimeTexts,
    read: impl Fn(&str, &'static str) -> Result<f64, Failure>,
) -> Result<ExponentTimes, Failure> {
    let time =
        |text: &Option<String>, option| text.as_deref().map(|text| read(text, option)).transpose();
    Ok(ExponentTimes { settle: time(settle, "--settle")?, record: time(record, "--record")? })
}
