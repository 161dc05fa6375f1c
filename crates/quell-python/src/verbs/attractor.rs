//! `attractor`: the motion on which a run ends, and its Lyapunov exponents.

use quell::kind::verbs;
use quell::run::exponents::ExponentTimes;
use quell::run::found_attractor::AttractorRequest;
use quell::run::system::found_attractor::MotionAttractorRequest;
use quell::run::system::protocol::numbers_of;
use quell::{Failure, Study, quantity};

use crate::answer::NativeAnswer;
use crate::arguments::{NamedNumbers, Pair, state};

/// Texts of the time before the record of the exponents and of its length.
pub(crate) type TimeTexts = (Option<String>, Option<String>);

/// Runs the verb, on a system from its own start; `times`: those of the exponents, if they are requested.
pub(crate) fn run(
    study: &Study,
    start: Option<&Pair>,
    times: Option<&TimeTexts>,
) -> Result<NativeAnswer, Failure> {
    if start.is_none() && study.system().is_ok() {
        return run_of_system(study, &NamedNumbers::new(), times);
    }
    let scales = study.scales();
    let start = start.map(|pair| state(pair, scales, "--start")).transpose()?;
    let read = |text: &str, option| Ok(quantity::duration(text, scales, option)?);
    let lyapunov = times.map(|times| exponent_times(times, read)).transpose()?;
    Ok(NativeAnswer::new(verbs(study).attractor(&AttractorRequest { start, lyapunov })?))
}

/// Runs the verb on a system, from a start whose numbers have names.
pub(crate) fn run_of_system(
    study: &Study,
    start: &NamedNumbers,
    times: Option<&TimeTexts>,
) -> Result<NativeAnswer, Failure> {
    let system = study.system()?;
    let start = numbers_of(&system, "--start", start)?;
    let units = system.units();
    let read = |text: &str, option| Ok(quantity::duration_of_system(text, units, option)?);
    let lyapunov = times.map(|times| exponent_times(times, read)).transpose()?;
    let request = MotionAttractorRequest { start, lyapunov };
    Ok(NativeAnswer::new(verbs(study).attractor_of_system(&request)?))
}

fn exponent_times(
    (settle, record): &TimeTexts,
    read: impl Fn(&str, &'static str) -> Result<f64, Failure>,
) -> Result<ExponentTimes, Failure> {
    let time =
        |text: &Option<String>, option| text.as_deref().map(|text| read(text, option)).transpose();
    Ok(ExponentTimes { settle: time(settle, "--settle")?, record: time(record, "--record")? })
}
