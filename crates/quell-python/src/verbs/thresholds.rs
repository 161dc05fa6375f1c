//! `thresholds`: exact parameter values at which the response changes, and threshold curves in two parameters.

use quell::run::protocol::Protocol;
use quell::run::system::start;
use quell::run::thresholds::curves::CurvesRequest;
use quell::run::thresholds::{ThresholdsRequest, window_of};
use quell::verbs::{system_of, verbs};
use quell::{Failure, RealInterval, Study, quantity};

use crate::answer::NativeAnswer;
use crate::arguments::{GivenState, Pair};

/// An end of a range, or a text that is not given.
pub(crate) type Ends = (Option<String>, Option<String>);

/// The window of a parameter: as given, or that of an amplitude.
fn window(
    study: &Study,
    parameter: &str,
    (from, to): &Ends,
    along: Option<(&str, RealInterval)>,
) -> Result<RealInterval, Failure> {
    let end = |option, text: &Option<String>| {
        let read = |text: &str| quantity::value_of(Some(study), text, parameter, option);
        text.as_deref().map(read).transpose()
    };
    let ends = (end("--from", from)?, end("--to", to)?);
    window_of(&system_of(study, "thresholds")?, parameter, ends, along)
}

/// Runs the verb. `range`: the values of the parameter that are searched [default: those of an amplitude]; `runs`: names of the fields of starts, a further start, and the
/// time of the ramp; `near`: a state of the motion to follow, and its number of periods.
pub(crate) fn run(
    study: &Study,
    parameter: String,
    range: &Ends,
    (names, start, ramp): (&[String], Option<&GivenState>, &str),
    near: Option<(&GivenState, u32)>,
) -> Result<NativeAnswer, Failure> {
    let system = system_of(study, "thresholds")?;
    let window = window(study, &parameter, range, None)?;
    let known = [Protocol::Rest, Protocol::Sliding, Protocol::Squeal];
    let asked = known.into_iter().filter(|known| names.iter().any(|name| name == known.name()));
    let mut protocols: Vec<Protocol> = asked.collect();
    if let Some(given) = start {
        protocols.push(Protocol::From(given.numbers(&system, "--start")?));
    }
    let near = match near {
        Some((given, periods)) => Some((given.numbers(&system, "--near")?, periods)),
        None => None,
    };
    let ramp = start::duration(&system, ramp, "--ramp")?;
    let request = ThresholdsRequest { parameter, window, near, protocols, ramp };
    Ok(NativeAnswer::new(verbs(study).thresholds(&request)?))
}

/// Runs the verb. `between`: the range of the second parameter.
pub(crate) fn run_along(
    study: &Study,
    parameter: String,
    range: &Ends,
    along: String,
    between: &Pair,
) -> Result<NativeAnswer, Failure> {
    let verbs = verbs(study);
    let value = |text: &str| quantity::value_of(Some(study), text, &along, "--between");
    let between = RealInterval::new(value(&between.0)?, value(&between.1)?);
    let window = window(study, &parameter, range, Some((&along, between)))?;
    let request = CurvesRequest { parameter, window, along, between };
    Ok(NativeAnswer::new(verbs.threshold_curves(&request)?))
}
