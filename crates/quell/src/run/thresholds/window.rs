//! The window of `thresholds` where none is given: the amplitudes of a dither up to the limit of `quench-amplitude`.

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

/// From no dither to the limit of the search for the quench amplitude, in the unit of the key of an amplitude.
///
/// # Errors
/// A complaint about a path that is not the amplitude of a dither; [`Failure::Failed`] where the limit has no value.
pub fn window_of_amplitude(study: &SystemStudy, path: &str) -> Result<(f64, f64), Failure> {
    if path == AMPLITUDE && !study.system().has_waves() {
        let allowed = "required, with --from and --to: the study has no dither whose amplitude could be varied";
        return Err(missing("--parameter", allowed));
    }
    let model = study.model();
    let parameter = model.parameter(path)?;
    let at = |value: f64| model.at(&[(parameter.clone(), value)]).ok();
    let pairs = PROBES.iter().filter_map(|probe| Some((*probe, at(*probe)?, at(2.0 * probe)?)));
    let varied = pairs.into_iter().next().and_then(|(probe, one, two)| {
        let of = |system: &System, input: usize| first_amplitude(system, input);
        let input = (0..one.inputs.len()).find(|k| of(&one, *k) != of(&two, *k))?;
        let unit = of(&one, input)? / probe;
        Some((one, input, unit))
    });
    let Some((system, input, unit)) = varied else {
        return Err(missing(
            "--from",
            "required, with --to: only the amplitude of a dither has a range of its own",
        ));
    };
    match amplitude_limit(&system, input) {
        Ok(limit) => Ok((0.0, limit / unit)),
        Err(why) => Err(failed(
            "thresholds",
            format!("{path} has no range of its own ({why}); give --from and --to"),
        )),
    }
}

fn missing(option: &'static str, allowed: &str) -> Failure {
    Complaint::new(Fault::Missing, option, Origin::Argument(option), (), allowed).into()
}

fn first_amplitude(system: &System, input: usize) -> Option<f64> {
    let waves: &[Wave] = system.inputs.get(input)?.profile.waves();
    waves.first().map(|wave| wave.amplitude)
}
