//! `fit --decay`: natural frequency, damping ratio and friction from a record of a free decay.

use std::f64::consts::TAU;
use std::fmt::Write as _;
use std::path::Path;

use quell_design::decay::{DECAY_NAMES, DECAY_PARAMETERS, DecayFit, DecayLaw, fit_decay};
use quell_design::fit::{akaike_weights, runs};
use quell_input::record::{RecordRequest, TimeSeries};
use quell_model::RecordedQuantity;

use super::named_estimates::{NamedEstimates, ReportedParameter};
use crate::complaint::{Complaint, Failure, Fault, Origin};
use crate::words::plural;

/// The name that stands for every law of a decay.
const ALL: &str = "all";

/// Deviation of the number of runs of equal sign, in standard deviations, that is not by chance: once in 370 records.
const UNLIKELY: f64 = 3.0;

/// Samples per period below which the readings between samples are guessed by the model alone.
const COARSE: f64 = 10.0;

/// Options of `fit --decay`.
#[derive(Clone, Debug, PartialEq)]
pub struct DecayRequest {
    record: RecordRequest,
    laws: Vec<DecayLaw>,
    /// Fixed parameters in reported units.
    fixed: [Option<f64>; DECAY_PARAMETERS],
}

impl DecayRequest {
    /// From names of laws (none or `all`: every law) and `NAME=VALUE` to fix.
    ///
    /// # Errors
    /// Every unknown law, name and value.
    pub fn new(record: RecordRequest, laws: &[String], fixed: &[String]) -> Result<Self, Failure> {
        let mut wrong = Vec::new();
        let mut request = Self { record, laws: Vec::new(), fixed: [None; DECAY_PARAMETERS] };
        for name in laws.iter().filter(|name| *name != ALL) {
            match DecayLaw::ALL.iter().find(|law| law.name() == name) {
                Some(law) if request.laws.contains(law) => {}
                Some(law) => request.laws.push(*law),
                None => {
                    let names = DecayLaw::ALL.map(DecayLaw::name).join(", ");
                    let allowed = format!("of a decay one of {names}, or {ALL}");
                    wrong.push(Complaint::option("--law", name.as_str(), allowed));
                }
            }
        }
        if laws.is_empty() || laws.iter().any(|name| name == ALL) {
            request.laws = DecayLaw::ALL.to_vec();
        }
        for text in fixed {
            let pair = text.split_once('=').and_then(|(name, value)| {
                let place = DECAY_NAMES.iter().position(|known| *known == name.trim())?;
                Some((place, value.trim().parse::<f64>().ok()?))
            });
            if let Some((place, value)) = pair.filter(|(place, value)| is_possible(*place, *value))
            {
                request.fixed[place] = Some(value);
            } else {
                let allowed = format!(
                    "NAME=VALUE with a finite number and one of {}; the frequency is above 0, the damping ratio in [0, 0.95], the \
                     friction not negative",
                    DECAY_NAMES.join(", ")
                );
                wrong.push(Complaint::option("--fix", text.as_str(), allowed));
            }
        }
        if wrong.is_empty() { Ok(request) } else { Err(wrong.into()) }
    }
}

/// Whether a parameter may have a value.
fn is_possible(place: usize, value: f64) -> bool {
    value.is_finite()
        && match place {
            0 => value > 0.0,
            1 => (0.0..=0.95).contains(&value),
            2 => value >= 0.0,
            _ => true,
        }
}

/// Laws fitted to a record of a free decay.
#[derive(Clone, Debug)]
pub struct FreeDecay {
    /// The record.
    pub record: TimeSeries,
    /// The fits by ascending AIC, at least one.
    pub fits: Vec<DecayFit>,
    /// Akaike weights of the fits; `None` if one has no criterion.
    pub weights: Option<Vec<f64>>,
}

/// Fits a decay to a file.
///
/// # Errors
/// Complaints about the file; a record without a visible decay.
pub fn run(path: &Path, request: &DecayRequest) -> Result<FreeDecay, Failure> {
    let record = TimeSeries::read(path, &request.record)?;
    let times: Vec<f64> = record.times.iter().map(|time| time - record.times[0]).collect();
    let mut fixed = request.fixed;
    fixed[0] = fixed[0].map(|hertz| TAU * hertz);
    let mut fits = Vec::new();
    for law in &request.laws {
        let contradicts = !law.has_friction() && fixed[2].is_some_and(|value| value != 0.0)
            || *law == DecayLaw::Coulomb && fixed[1].is_some_and(|value| value != 0.0);
        if contradicts && request.laws.len() > 1 {
            continue;
        }
        let found = fit_decay(*law, (&times, &record.values), record.quantity, &fixed);
        fits.push(found.map_err(|why| {
            let given = record.path().display().to_string();
            let allowed = format!("a record of a free decay: {why}");
            Complaint::new(Fault::Path, "data file", Origin::Whole, given, allowed)
        })?);
    }
    let criterion = |fit: &DecayFit| fit.estimates.aic().unwrap_or(f64::NEG_INFINITY);
    // Of laws through every sample the one with fewer parameters is simpler.
    fits.sort_by(|a, b| {
        let by_criterion = criterion(a).total_cmp(&criterion(b));
        by_criterion.then(a.estimates.free.cmp(&b.estimates.free))
    });
    let criteria: Result<Vec<f64>, _> = fits.iter().map(|fit| fit.estimates.aic()).collect();
    let weights = criteria.ok().map(|criteria| akaike_weights(&criteria));
    Ok(FreeDecay { record, fits, weights })
}

impl FreeDecay {
    /// The fit with the least AIC.
    pub fn best(&self) -> &DecayFit {
        &self.fits[0]
    }

    /// The estimates of a fit with their names.
    pub fn named(&self, fit: &DecayFit) -> NamedEstimates {
        let parameters = DECAY_NAMES.iter().zip(self.units()).enumerate();
        let parameters = parameters.map(|(place, (name, unit))| ReportedParameter {
            name: (*name).to_owned(),
            unit,
            factor: if place == 0 { 1.0 / TAU } else { 1.0 },
        });
        NamedEstimates { parameters: parameters.collect(), estimates: fit.estimates.clone() }
    }

    /// Whether a parameter belongs to a law.
    pub fn has(fit: &DecayFit, place: usize) -> bool {
        match place {
            1 => fit.law != DecayLaw::Coulomb,
            2 => fit.law.has_friction(),
            _ => true,
        }
    }

    /// Units of the parameters.
    fn units(&self) -> [String; DECAY_PARAMETERS] {
        let reading = self.record.unit.unwrap_or("reading");
        let time = self.record.time_unit.unwrap_or("time");
        let in_si = self.record.unit.is_some() && self.record.time_unit.is_some();
        let [displacement, velocity] = match self.record.quantity {
            _ if in_si => ["m".to_owned(), "m/s".to_owned()],
            RecordedQuantity::Displacement => [reading.to_owned(), format!("{reading}/{time}")],
            RecordedQuantity::Velocity => [format!("{reading}·{time}"), reading.to_owned()],
            RecordedQuantity::Acceleration => {
                [format!("{reading}·{time}²"), format!("{reading}·{time}")]
            }
        };
        let frequency = if self.record.time_unit.is_some() { "Hz" } else { "1/time" };
        [
            frequency.to_owned(),
            "1".to_owned(),
            displacement.clone(),
            displacement,
            velocity,
            reading.to_owned(),
        ]
    }

    /// Residuals of the best fit.
    pub fn residuals(&self) -> Vec<f64> {
        self.record.values.iter().zip(&self.best().values).map(|(y, f)| y - f).collect()
    }

    /// Tables of a study with the estimates, and with their covariance.
    pub fn fragments(&self) -> (String, String) {
        let named = self.named(self.best());
        let in_seconds = self.record.time_unit.is_some();
        let mut belt = String::from("[belt]\n");
        if Self::has(self.best(), 1) {
            let _ = writeln!(belt, "damping_ratio = {:?}", named.value(1));
        }
        if in_seconds {
            let _ = writeln!(belt, "natural_frequency_hz = {:?}", named.value(0));
        }
        if Self::has(self.best(), 2) {
            let unit = &named.parameters[2].unit;
            let value = named.value(2);
            let _ = writeln!(belt, "# friction force over stiffness, {unit}: {value:?}");
        }
        let uncertainty = named.uncertainty(|name| match name {
            "damping_ratio" => Some("belt.damping_ratio".to_owned()),
            "natural_frequency" if in_seconds => Some("belt.natural_frequency_hz".to_owned()),
            _ => None,
        });
        (belt, uncertainty)
    }

    /// What no free decay determines.
    pub fn not_determinable(&self) -> Vec<&'static str> {
        vec![
            "the static level: the motion slides until it rests",
            "a slope of friction over the slip speed: it acts as viscous damping and is part of the damping ratio",
        ]
    }

    /// Warnings about the record and the estimates.
    pub fn warnings(&self) -> Vec<String> {
        let best = self.best();
        let mut warnings = record_warnings(&self.record);
        if !best.converged {
            warnings.push("the search has not converged: the record may not be a free decay from its first sample on".to_owned());
        }
        if best.estimates.values[1] >= 0.95 && Self::has(best, 1) {
            warnings.push("damping is close to critical, beyond what a decay shows".to_owned());
        }
        let named = self.named(best);
        let of_law = |warning: &String| {
            (0..DECAY_PARAMETERS)
                .filter(|place| !Self::has(best, *place))
                .all(|place| !warning.starts_with(DECAY_NAMES[place]))
        };
        warnings.extend(named.warnings().into_iter().filter(of_law).filter(|warning| {
            // An offset and a state that are small are no defect.
            !["offset", "displacement ", "velocity "].iter().any(|name| warning.starts_with(name))
        }));
        let per_period = TAU / best.estimates.values[0] / self.record.step();
        if per_period < COARSE {
            warnings.push(format!("the record has {per_period:.1} samples per period: the envelope is seen by few of them"));
        }
        warnings.extend(pattern(&self.residuals()));
        warnings
    }
}

/// Warnings about gaps.
pub(crate) fn record_warnings(record: &TimeSeries) -> Vec<String> {
    let gaps = record.gaps();
    let Some(first) = gaps.first() else { return Vec::new() };
    let count = gaps.len();
    vec![format!(
        "the record has {count} gap{} between samples, the first after line {first}: the fit passes over them",
        plural(count)
    )]
}

/// A warning about residuals that are not independent.
pub(crate) fn pattern(residuals: &[f64]) -> Option<String> {
    let (found, expected, score) = runs(residuals)?;
    (score < -UNLIKELY).then(|| {
        format!(
            "the residuals have {found} run{} of equal sign where {expected:.0} are expected of independent errors: the noise is \
             filtered, or the model does not have the shape of the record; standard errors, where they are given, are too small",
            plural(found)
        )
    })
}
