//! The window of `thresholds` where an end is not given: the amplitudes of a dither up to the limit of `quench-amplitude`.

use quell_design::quench::amplitude_limit;
use quell_model::System;
use quell_model::profile::Wave;
use quell_numerics::interval::RealInterval;

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
    along: Option<(&str, RealInterval)>,
) -> Result<RealInterval, Failure> {
    if let (Some(from), Some(to)) = ends {
        return Ok(RealInterval::new(from, to));
    }
    if path == AMPLITUDE && !study.system().has_waves() {
        let allowed = "thresholds are those of its amplitude where no --parameter is given; add [dither], or give --parameter, --from and --to";
        let missing = Complaint::new(Fault::Missing, "dither", Origin::Whole, (), allowed);
        return Err(missing.into());
    }
    let limit = |other| VariedAmplitude::of(study, path, other)?.limit(path);
    let to = match (ends.1, along) {
        (Some(to), _) => VariedAmplitude::of(study, path, None).map(|_| to),
        (None, None) => limit(None),
        (None, Some((along, RealInterval { lower: low, upper: high }))) => (0..=PLACES)
            .map(|place| low + (high - low) * f64::from(place) / f64::from(PLACES))
            .map(|value| limit(Some((along, value))))
            .try_fold(0.0, |most: f64, limit| Ok(most.max(limit?))),
    };
    Ok(RealInterval::new(ends.0.unwrap_or(0.0), to?))
}

/// A system whose dither of `input` has an amplitude that a path sets.
struct VariedAmplitude {
    system: System,
    input: usize,
    /// The amplitude of the equations over the number at the path.
    unit: f64,
}

impl VariedAmplitude {
    /// That of a path, at a value of another parameter if one is given.
    ///
    /// # Errors
    /// A complaint about a path that is not the amplitude of a dither.
    fn of(study: &SystemStudy, path: &str, other: Option<(&str, f64)>) -> Result<Self, Failure> {
        let model = study.model();
        let parameter = model.parameter(path)?;
        let other = match other {
            Some((path, value)) => Some((model.parameter(path)?, value)),
            None => None,
        };
        let mut why_not = None;
        let mut at = |value: f64| {
            let values = [(parameter.clone(), value)].into_iter().chain(other.clone());
            let system = model.at(&values.collect::<Vec<_>>());
            system.map_err(|why| why_not = Some(why.to_string())).ok()
        };
        let pair = PROBES.iter().find_map(|probe| Some((*probe, at(*probe)?, at(2.0 * probe)?)));
        let Some((probe, system, twice)) = pair else {
            let allowed = format!("a path that can be varied: {}", why_not.unwrap_or_default());
            return Err(Complaint::option("--parameter", path, allowed).into());
        };
        let changed = (0..system.inputs.len()).find_map(|input| {
            let amplitude = first_amplitude(&system, input)?;
            (first_amplitude(&twice, input) != Some(amplitude)).then_some((input, amplitude))
        });
        let Some((input, amplitude)) = changed else {
            let allowed =
                "give it with --to; only the amplitude of a dither has a range of its own";
            let origin = Origin::Argument("--from");
            return Err(Complaint::new(Fault::Missing, "--from", origin, (), allowed).into());
        };
        Ok(Self { system, input, unit: amplitude / probe })
    }

    /// The limit of the search for the quench amplitude, as a number at the path.
    fn limit(&self, path: &str) -> Result<f64, Failure> {
        match amplitude_limit(&self.system, self.input) {
            Ok(limit) => Ok(limit / self.unit),
            Err(why) => Err(failed(
                "thresholds",
                format!("{path} has no range of its own ({why}); give --from and --to"),
            )),
        }
    }
}

fn first_amplitude(system: &System, input: usize) -> Option<f64> {
    let waves: &[Wave] = system.inputs.get(input)?.profile.waves();
    waves.first().map(|wave| wave.amplitude)
}
