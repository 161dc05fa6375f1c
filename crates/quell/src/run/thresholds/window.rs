//! The window of `thresholds` where an end is not given: the amplitudes of a dither up to the limit of `quench-amplitude`.

use quell_design::quench::amplitude_limit;
use quell_model::System;
use quell_model::profile::Wave;

use crate::complaint::{Complaint, Failure, Fault, Origin};
use crate::run::system::failed;
use crate::study::SystemStudy;

/// The parameter of `thresholds` where none is given.
pub const AMPLITUDE: &str = "dither.amplitude";

/// Amplitudes with which the input of a path is sought, in the unit of its key: one of them is possible in most studies.
const PROBES: [f64; 3] = [1.0, 1e-3, 1e-6];

/// Values of the second parameter, both ends included, at which the limit of the amplitude is taken: it varies little between them.
const PLACES: u32 = 8;

/// The window of a parameter, in the unit of its key; an end that is not given is that of an amplitude: no dither, and the limit of the search
/// for the quench amplitude, the largest over the values of a second parameter along which thresholds are followed.
///
/// # Errors
/// A complaint about a path that is not the amplitude of a dither; [`Failure::Failed`] where the limit has no value.
pub fn window_of(
    study: &SystemStudy,
    path: &str,
    ends: (Option<f64>, Option<f64>),
    along: Option<(&str, (f64, f64))>,
) -> Result<(f64, f64), Failure> {
    if let (Some(from), Some(to)) = ends {
        return Ok((from, to));
    }
    if path == AMPLITUDE && !study.system().has_waves() {
        let allowed = "thresholds are those of its amplitude where no --parameter is given; add [dither], or give --parameter, --from and --to";
        let missing = Complaint::new(Fault::Missing, "dither", Origin::Whole, (), allowed);
        return Err(missing.into());
    }
    let limit = match along {
        None => limit_of(study, path, None),
        Some((along, (low, high))) => (0..=PLACES)
            .map(|place| low + (high - low) * f64::from(place) / f64::from(PLACES))
            .map(|value| limit_of(study, path, Some((along, value))))
            .reduce(|one, other| Ok(one?.max(other?)))
            .unwrap_or(Ok(0.0)),
    };
    Ok((ends.0.unwrap_or(0.0), ends.1.map_or(limit, Ok)?))
}

/// The limit of an amplitude, at a value of another parameter if one is given.
fn limit_of(study: &SystemStudy, path: &str, other: Option<(&str, f64)>) -> Result<f64, Failure> {
    let model = study.model();
    let parameter = model.parameter(path)?;
    let other = other.map(|(path, value)| Ok::<_, Failure>((model.parameter(path)?, value)));
    let other = other.transpose()?;
    let mut why_not = None;
    let mut at = |value: f64| {
        let values = [(parameter.clone(), value)].into_iter().chain(other.clone());
        model.at(&values.collect::<Vec<_>>()).map_err(|why| why_not = Some(why.to_string())).ok()
    };
    let pair = PROBES.iter().find_map(|probe| Some((*probe, at(*probe)?, at(2.0 * probe)?)));
    let Some((probe, one, two)) = pair else {
        let allowed = format!("a path that can be varied: {}", why_not.unwrap_or_default());
        return Err(Complaint::option("--parameter", path, allowed).into());
    };
    let of = |system: &System, input: usize| first_amplitude(system, input);
    let input = (0..one.inputs.len()).find(|input| of(&one, *input) != of(&two, *input));
    let Some((input, amplitude)) = input.and_then(|input| Some((input, of(&one, input)?))) else {
        let allowed = "give it with --to; only the amplitude of a dither has a range of its own";
        let origin = Origin::Argument("--from");
        return Err(Complaint::new(Fault::Missing, "--from", origin, (), allowed).into());
    };
    match amplitude_limit(&one, input) {
        Ok(limit) => Ok(limit * probe / amplitude),
        Err(why) => Err(failed(
            "thresholds",
            format!("{path} has no range of its own ({why}); give --from and --to"),
        )),
    }
}

fn first_amplitude(system: &System, input: usize) -> Option<f64> {
    let waves: &[Wave] = system.inputs.get(input)?.profile.waves();
    waves.first().map(|wave| wave.amplitude)
}
