//! `actuator`: where over frequency the actuator of a study can give the dither that quenches.
//!
//! At each frequency the ratings of the actuator allow a largest amplitude, by its own equations and the exact periodic motion of the
//! driven point, for the waveform of the study. The least amplitude that quenches is that of averaging at a finite frequency ratio, as
//! `design` takes it for its search; what is quiet by averaging is verified there, not here. Sampling is parallel, and every end and
//! change is exact ([`quell_design::actuator::coverage`]).

mod answer;
mod demand;

use std::sync::Arc;

use quell_design::actuator::{Actuator, ActuatorAtFrequency, ActuatorCoverage, coverage};
use quell_design::least_dither::{BeltPlant, DesignStart, OperatingPoint, Plant};
use quell_model::parameter::DITHER_FREQUENCY_RATIO;
use quell_model::{Belt, Waveform};
use quell_numerics::order::{ascending, ascending_by};
use serde_json::Value as Json;

pub(crate) use demand::{
    beyond_actuator, demand_fields, warning_about_samples, warnings_about_actuator,
};

use super::design::StudyWithDesign;
use crate::complaint::{Complaint, Failure, Fault, Origin};
use crate::contact_state::refused_of_belt;
use crate::parallel::Parallel;
use crate::run::stability::FAR;
use crate::study::BeltStudy;

/// Frequencies of the samples, at equal ratios: 1.2 % apart over two decades. Resonances, the frequencies of a measured response and
/// the frequency of the study are added.
const SAMPLES: usize = 401;

/// The default range in multiples of the study's own frequency.
const DEFAULT_RANGE: (f64, f64) = (0.1, 10.0);

/// What the requirement and the reach depend on, for one study.
pub(crate) struct ActuatorQuestion<'a> {
    /// The actuator.
    pub(crate) actuator: &'a Actuator,
    /// The structure, whose other design variable is the frequency of the dither.
    pub(crate) plant: &'a (dyn Plant + Sync),
    /// The waveform of the dither.
    pub(crate) waveform: Waveform,
    /// The table of the dither, such as `dither` or `dither[1]`.
    pub(crate) dither: String,
    /// Frequency and amplitude of the study.
    pub(crate) own: (f64, f64),
    /// The frequency of the vibration that is to be quenched, or of the least damped motion.
    pub(crate) slow: Option<f64>,
    /// Natural frequencies of the structure.
    pub(crate) resonances: Vec<f64>,
    /// Names of the contacts with the speed of their surface.
    pub(crate) contacts: Vec<(String, f64)>,
}

/// An actuator over frequency.
#[derive(Clone, Debug, PartialEq)]
pub struct ActuatorFound {
    /// What was found over the range.
    pub coverage: ActuatorCoverage,
    /// The frequencies of the study and of all ends and changes, with what each is, ascending.
    pub notable: Vec<(String, ActuatorAtFrequency)>,
    /// What holds at the study's frequency.
    pub own: ActuatorAtFrequency,
    /// The study's amplitude.
    pub own_amplitude: f64,
    /// The range of frequencies.
    pub range: (f64, f64),
    /// The waveform of the dither.
    pub waveform: Waveform,
    /// The table of the dither.
    pub dither: String,
    /// The frequency of the vibration that is to be quenched, or of the least damped motion.
    pub slow: Option<f64>,
    /// Names of the contacts with the speed of their surface.
    pub contacts: Vec<(String, f64)>,
}

impl ActuatorFound {
    /// Whether steady sliding is stable without the dither, at the study's frequency.
    pub fn is_quiet_without(&self) -> bool {
        self.own.needed == Ok(0.0)
    }
}

/// The actuator of a study.
///
/// # Errors
/// A complaint about a study without `[actuator]` or without dither.
pub(crate) fn asked(study: &dyn StudyWithDesign, has_dither: bool) -> Result<&Actuator, Failure> {
    let (key, allowed) = match study.actuator() {
        Some(actuator) if has_dither => return Ok(actuator),
        Some(_) => {
            ("dither", "given: its direction and waveform are those that the actuator gives")
        }
        None => (
            "actuator",
            "a table [actuator] with kind and the numbers of a data sheet, such as blocked_force and maximum_voltage of a piezo stack",
        ),
    };
    Err(Complaint::new(Fault::Missing, key, Origin::Whole, Json::Null, allowed).into())
}

/// The actuator of a belt over a range of frequency ratios.
///
/// # Errors
/// A complaint about a study without `[actuator]` or dither, about the range, and about a contact with a state; a dither whose demand
/// is unknown at every frequency.
pub fn run(study: &BeltStudy, range: Option<(f64, f64)>) -> Result<ActuatorFound, Failure> {
    refused_of_belt(study, "actuator")?;
    let belt = study.belt();
    let actuator = asked(study, !belt.dithers().is_empty())?;
    super::moves(study, "sliding on it is to be stable")?;
    let path = belt.dither_path(0, DITHER_FREQUENCY_RATIO.key());
    let first = &belt.dithers()[0];
    let at = |at: OperatingPoint<'_>| {
        let quiet = belt.with_amplitude(0, 0.0);
        let ratio = |belt: Belt| match at.others {
            [ratio] => belt.with_frequency_ratio(0, *ratio),
            _ => Ok(belt),
        };
        quiet.and_then(ratio).map_err(|why| why.to_string())
    };
    let plant = BeltPlant { at: Arc::new(at), start: DesignStart::Local };
    let question = ActuatorQuestion {
        actuator,
        plant: &plant,
        waveform: first.waveform.clone(),
        dither: path.rsplit_once('.').map_or_else(String::new, |(table, _)| table.to_owned()),
        own: (first.frequency_ratio, first.amplitude),
        slow: Some(1.0),
        resonances: vec![1.0],
        contacts: vec![("belt".to_owned(), belt.belt_velocity())],
    };
    let most = DITHER_FREQUENCY_RATIO.bounds.upper;
    if let Some((from, to)) = range.filter(|(_, to)| *to > most) {
        return Err(wrong_range((from, to), &format!("frequency ratios up to {most}")));
    }
    question.answer(range, most)
}

/// The complaint about a range of frequencies.
fn wrong_range((from, to): (f64, f64), allowed: &str) -> Failure {
    Complaint::option("--frequency", format!("{from}:{to}"), allowed.to_owned()).into()
}

impl ActuatorQuestion<'_> {
    /// The answer over a range of frequencies up to a largest one.
    ///
    /// # Errors
    /// A complaint about the range; a dither whose demand is unknown at every frequency.
    pub(crate) fn answer(
        self,
        range: Option<(f64, f64)>,
        most: f64,
    ) -> Result<ActuatorFound, Failure> {
        let (from, to) = range.unwrap_or_else(|| self.default_range(most));
        if !(from > 0.0 && to > from && to.is_finite()) {
            return Err(wrong_range(
                (from, to),
                "two positive numbers, the second above the first",
            ));
        }
        let at = |frequency: f64| self.at(frequency);
        let frequencies = self.frequencies((from, to));
        let samples: Vec<ActuatorAtFrequency> =
            frequencies.in_parallel(|frequency| at(*frequency)).collect();
        if let Some(why) = unknown_everywhere(&samples) {
            return Err(Failure::Failed { key: "actuator".to_owned(), why });
        }
        let samples = without_poles(samples, &self.resonances);
        let found = coverage(samples, &at);
        let own = self.at(self.own.0);
        let notable = notable(&found, &own, (from, to), &at);
        Ok(ActuatorFound {
            coverage: found,
            notable,
            own,
            own_amplitude: self.own.1,
            range: (from, to),
            waveform: self.waveform,
            dither: self.dither,
            slow: self.slow,
            contacts: self.contacts,
        })
    }

    /// What is known at one frequency.
    fn at(&self, frequency: f64) -> ActuatorAtFrequency {
        let others = [frequency];
        let place = OperatingPoint { point: &[], others: &others };
        ActuatorAtFrequency {
            frequency,
            demand: self.plant.demand(place, self.actuator),
            slips: self.plant.slip_amplitudes(place),
            needed: self.plant.least_averaged(place),
        }
    }

    /// The measured range of a frequency response; else around the study's own frequency, above the vibration itself.
    fn default_range(&self, most: f64) -> (f64, f64) {
        let measured = self.actuator.measured_frequencies();
        if let [first, .., last] = measured {
            return (*first, *last);
        }
        let own = self.own.0;
        let slow = self.slow.map_or(0.0, |slow| slow * f64::from(self.waveform.cycles()));
        let from = if own > FAR * slow {
            f64::max(DEFAULT_RANGE.0 * own, FAR * slow)
        } else if own > slow {
            // Halfway from the vibration to a dither that is hardly faster.
            libm::sqrt(slow * own)
        } else {
            DEFAULT_RANGE.0 * own
        };
        (from, f64::min(DEFAULT_RANGE.1 * own, most))
    }

    /// The frequencies of the samples.
    fn frequencies(&self, (from, to): (f64, f64)) -> Vec<f64> {
        let ratio = libm::log(to / from);
        let last = SAMPLES - 1;
        let even = (0..SAMPLES).map(|k| match k {
            0 => from,
            k if k == last => to,
            k => from * libm::exp(ratio * k as f64 / last as f64),
        });
        let measured = self.actuator.measured_frequencies().iter();
        let special = self.resonances.iter().chain(measured).chain([&self.own.0]).copied();
        let special = special.filter(|frequency| from < *frequency && *frequency < to);
        let mut frequencies: Vec<f64> = even.chain(special).collect();
        ascending(&mut frequencies);
        frequencies.dedup();
        frequencies
    }
}

/// Why the reach is unknown, if it is at every frequency.
fn unknown_everywhere(samples: &[ActuatorAtFrequency]) -> Option<String> {
    let mut why = None;
    for sample in samples {
        match sample.reach() {
            Ok(_) => return None,
            Err(reason) => why = why.or(Some(reason)),
        }
    }
    why
}

/// The samples without natural frequencies at which an undamped structure has no periodic response.
fn without_poles(
    samples: Vec<ActuatorAtFrequency>,
    resonances: &[f64],
) -> Vec<ActuatorAtFrequency> {
    let last = samples.len().saturating_sub(1);
    let keeps = |(place, sample): &(usize, ActuatorAtFrequency)| {
        let inside = *place > 0 && *place < last;
        !(inside && resonances.contains(&sample.frequency) && sample.margin().is_err())
    };
    samples.into_iter().enumerate().filter(keeps).map(|(_, sample)| sample).collect()
}

/// Ends, changes, the largest margin, resonances and the study's own frequency, ascending.
fn notable(
    found: &ActuatorCoverage,
    own: &ActuatorAtFrequency,
    (from, to): (f64, f64),
    at: &dyn Fn(f64) -> ActuatorAtFrequency,
) -> Vec<(String, ActuatorAtFrequency)> {
    let mut places: Vec<(String, ActuatorAtFrequency)> =
        vec![("start of the range".to_owned(), at(from)), ("end of the range".to_owned(), at(to))];
    let is_inside = (from..=to).contains(&own.frequency);
    let of_study = if is_inside { "of the study" } else { "of the study, outside of the range" };
    places.push((of_study.to_owned(), own.clone()));
    places.extend(found.changes().map(|(frequency, limits)| {
        let name = |limit: Option<quell_design::actuator::ActuatorLimit>| {
            limit.map_or("unknown", quell_design::actuator::ActuatorLimit::name)
        };
        (format!("{} → {}", name(limits[0]), name(limits[1])), at(frequency))
    }));
    for band in &found.sufficient {
        for (end, word) in [(band.ends.0, "from here"), (band.ends.1, "up to here")] {
            if end > from && end < to {
                places.push((format!("sufficient {word}"), at(end)));
            }
        }
    }
    places.extend(found.resonances.iter().map(|resonance| {
        let helps = if resonance.helps { "helps" } else { "does not help" };
        (format!("resonance, {helps}"), resonance.at.clone())
    }));
    places.extend(found.best.iter().map(|best| ("largest margin".to_owned(), best.clone())));
    ascending_by(&mut places, |a| a.1.frequency);
    places
}
