//! `thresholds`: exact parameter values at which the response changes, and threshold curves in two parameters.

use quell::kind::verbs;
use quell::run::curves::CurvesRequest;
use quell::run::protocol::Protocol;
use quell::run::system::protocol::{SystemProtocol, numbers_of};
use quell::run::system::start;
use quell::run::system::thresholds::MotionThresholdsRequest;
use quell::run::thresholds::ThresholdsRequest;
use quell::{Failure, Study, quantity};

use crate::answer::NativeAnswer;
use crate::arguments::{NamedNumbers, Pair, ends, state};

/// Initial-condition protocols by the names of their fields, and one from a state.
pub(crate) fn protocols(names: &[String], start: Option<(f64, f64)>) -> Vec<Protocol> {
    let known = [Protocol::Rest, Protocol::Sliding, Protocol::Squeal];
    let asked = known.into_iter().filter(|known| names.iter().any(|name| name == known.name()));
    asked.chain(start.map(|(x, v)| Protocol::From(x, v))).collect()
}

/// Runs the verb. `range`: the values of the parameter that are searched.
pub(crate) fn run(
    study: &Study,
    parameter: String,
    range: &Pair,
    (names, start): (&[String], Option<&Pair>),
    ramp: &str,
) -> Result<NativeAnswer, Failure> {
    let verbs = verbs(study);
    let scales = study.scales();
    let (from, to) = ends(study, &parameter, range)?;
    let begin = start.map(|pair| state(pair, scales, "--start")).transpose()?;
    let ramp = match study.system() {
        Ok(system) => start::duration(&system, ramp, "--ramp")?,
        Err(_) => quantity::duration(ramp, scales, "--ramp")?,
    };
    let protocols = protocols(names, begin);
    let request = ThresholdsRequest { parameter, from, to, protocols, ramp };
    Ok(NativeAnswer::new(verbs.thresholds(request)?))
}

/// Runs the verb. `between`: the range of the second parameter.
pub(crate) fn run_along(
    study: &Study,
    parameter: String,
    range: &Pair,
    along: String,
    between: &Pair,
) -> Result<NativeAnswer, Failure> {
    let verbs = verbs(study);
    let window = ends(study, &parameter, range)?;
    let value = |text: &str| quantity::value_of(Some(study), text, &along, "--between");
    let between = (value(&between.0)?, value(&between.1)?);
    let request = CurvesRequest { parameter, window, along, between };
    Ok(NativeAnswer::new(verbs.threshold_curves(&request)?))
}

/// Runs the verb on a system, along the motion near a state, or with runs from a start, whose numbers have names.
pub(crate) fn run_of_system(
    study: &Study,
    parameter: String,
    range: &Pair,
    (names, begin): (&[String], Option<&NamedNumbers>),
    (near, ramp): (Option<(&NamedNumbers, u32)>, &str),
) -> Result<NativeAnswer, Failure> {
    let system = study.system()?;
    let window = ends(study, &parameter, range)?;
    let protocols = protocols(names, None).into_iter().map(SystemProtocol::of);
    let mut protocols = protocols.collect::<Result<Vec<_>, _>>()?;
    if let Some(pairs) = begin {
        protocols.push(SystemProtocol::From(numbers_of(&system, "--start", pairs)?));
    }
    let ramp = start::duration(&system, ramp, "--ramp")?;
    let near = match near {
        Some((pairs, periods)) => Some((numbers_of(&system, "--near", pairs)?, periods)),
        None => None,
    };
    let request = MotionThresholdsRequest { parameter, window, near, protocols, ramp };
    Ok(NativeAnswer::new(verbs(study).thresholds_of_system(&request)?))
}
