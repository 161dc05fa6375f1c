//! `actuator`: where over frequency the actuator of a study can give the dither that quenches.
//!
//! At each frequency the ratings of the actuator allow a largest amplitude, by its own equations and the exact periodic motion of the
//! driven point, for the waveform of the study. The least amplitude that quenches is that of averaging at a finite frequency ratio, as
//! `design` takes it for its search; what is quiet by averaging is verified there, not here. Sampling is parallel, and every end and
//! change is exact ([`quell_design::actuator::coverage`]).

mod answer;
mod demand;
mod rating;

use quell_design::NoAnswer;
use quell_design::actuator::{Actuator, ActuatorAtFrequency, ActuatorCoverage, coverage};
use quell_design::least_dither::{DesignStart, OperatingPoint, Plant, SystemPlant};
use quell_linear::averaging::{Becomes, CriticalInput, DitheredSystem};
use quell_linear::growth::Verdict;
use quell_linear::linearised::Linearised;
use quell_linear::spectrum::{MotionSpectrum, SmallMotion, spectrum};
use quell_model::parameter::BELT_VELOCITY;
use quell_model::profile::Wave;
use quell_model::{Contact, RefusedNumbers, System, Waveform};
use quell_numerics::interval::RealInterval;
use quell_numerics::order::{ascending, ascending_by};
use serde_json::Value as Json;

pub(crate) use demand::{demand_fields, warning_about_samples, warnings_about_actuator};
pub(in crate::run) use rating::designed;
pub(crate) use rating::{beyond_actuator, beyond_actuators_at_loads};

use super::design::with_wave;
use super::system::{self, checked_frequencies, has_equations};
use crate::complaint::{Complaint, Failure, Fault, Origin};
use crate::contact_state::refused_where_averaged;
use crate::parallel::Parallel;
use crate::run::stability::FAR;
use crate::study::SystemStudy;

/// Frequencies of the samples, at equal ratios: 1.2 % apart over two decades. Resonances, the frequencies of a measured response and
/// the frequency of the study are added.
const SAMPLES: usize = 401;

/// The default range in multiples of the study's own frequency.
const DEFAULT_RANGE: RealInterval = RealInterval::new(0.1, 10.0);

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
    pub range: RealInterval,
    /// The waveform of the dither.
    pub waveform: Waveform,
    /// The table of the dither.
    pub dither: String,
    /// The frequency of the vibration that is to be quenched, or of the least damped motion.
    pub slow: Option<f64>,
    /// Names of the contacts with the speed of their surface.
    pub contacts: Vec<(String, f64)>,
    /// Where a larger amplitude than the least that quenches, but one that the actuator can give, quenches no longer: at the largest margin and
    /// at the study's frequency.
    pub closing: Vec<ClosingWindow>,
}

/// Amplitudes that quench only up to one that the actuator can give.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClosingWindow {
    /// Frequency of the dither.
    pub frequency: f64,
    /// From the least amplitude that quenches to that from which sliding is unstable again.
    pub amplitudes: RealInterval,
    /// The largest amplitude that the actuator can give.
    pub largest: f64,
}

impl ActuatorFound {
    /// Whether steady sliding is stable without the dither, at the study's frequency.
    pub fn is_quiet_without(&self) -> bool {
        self.own.needed == Ok(0.0)
    }
}

/// The actuator of a study over a range of angular frequencies.
///
/// # Errors
/// A complaint about a study without `[actuator]`, dither or equations, about surfaces at rest, about the range, and about a contact with
/// a state; a dither whose demand is unknown at every frequency.
pub fn run(study: &SystemStudy, range: Option<RealInterval>) -> Result<ActuatorFound, Failure> {
    has_equations(study, "actuator")?;
    let system = study.system();
    refused_where_averaged(study, "actuator")?;
    let actuator = asked(study)?;
    moves(study)?;
    let input = designed(study);
    let wave = system.inputs.get(input).and_then(|input| input.profile.waves().first());
    let Some(wave) = wave else {
        return Err(failed("the dither that the actuator gives does not act"));
    };
    let linear = Linearised::new(system).map_err(failed)?;
    let found = spectrum(&linear, &linear.friction()).map_err(failed)?;
    let with = |place: OperatingPoint<'_>, amplitude: f64| -> Result<System, RefusedNumbers> {
        Ok(with_wave(system.clone(), input, |wave| {
            let frequency = place.others.first().copied().unwrap_or(wave.frequency);
            Wave { amplitude, frequency, ..wave.clone() }
        }))
    };
    let plant = SystemPlant { at: &with, input, observe: &[], start: DesignStart::Local };
    // Without any dither steady sliding does not depend on the frequency of one.
    let is_only = system.waves().count() == 1;
    let is_stable = is_only && found.growth.verdict() == Verdict::Stable;
    let at = |frequency: f64| {
        let place = OperatingPoint { point: &[], others: &[frequency] };
        ActuatorAtFrequency {
            frequency,
            demand: plant.demand(place, actuator),
            slips: plant.slip_amplitudes(place),
            needed: if is_stable { Ok(0.0) } else { plant.least_averaged(place) },
        }
    };
    let slow = slowest_to_decay(&found);
    let range = range.unwrap_or_else(|| default_range(actuator, wave, slow));
    let range = checked_frequencies(range, false)?;
    let resonances: Vec<f64> = oscillating(&found).map(SmallMotion::frequency).collect();
    let special = resonances.iter().chain(actuator.measured_frequencies()).chain([&wave.frequency]);
    let frequencies = sampled(range, special.copied());
    let samples: Vec<ActuatorAtFrequency> =
        frequencies.in_parallel(|frequency| at(*frequency)).collect();
    if let Some(why) = unknown_everywhere(&samples) {
        return Err(failed(why));
    }
    let coverage = coverage(without_poles(samples, &resonances), &at);
    let own = at(wave.frequency);
    let closing = coverage.best.iter().chain([&own]).filter_map(|found| {
        let system =
            with(OperatingPoint { point: &[], others: &[found.frequency] }, wave.amplitude).ok()?;
        closing_window(&system, input, found)
    });
    let mut closing: Vec<ClosingWindow> = closing.collect();
    closing.dedup();
    let speed = |contact: &Contact| contact.surface_velocity.mean().abs();
    let contacts = system.contacts.iter();
    Ok(ActuatorFound {
        notable: notable(&coverage, &own, range, &at),
        closing,
        coverage,
        own,
        own_amplitude: wave.amplitude,
        range,
        waveform: wave.waveform.clone(),
        dither: table_of(input, system.inputs.len()),
        slow,
        contacts: contacts.map(|contact| (contact.name.clone(), speed(contact))).collect(),
    })
}

/// Where averaged sliding becomes unstable again between the least amplitude that quenches and the largest of the actuator.
fn closing_window(
    system: &System,
    input: usize,
    found: &ActuatorAtFrequency,
) -> Option<ClosingWindow> {
    let (least, largest) = (*found.needed.as_ref().ok()?, found.reach().ok()?.amplitude);
    let changes = DitheredSystem::new(system).and_then(|there| there.critical_amplitudes(input));
    let opens = |change: &CriticalInput| {
        change.becomes == Becomes::Unstable
            && change.amplitude > least
            && change.amplitude < largest
    };
    let until = changes.ok()?.into_iter().find(opens)?.amplitude;
    let amplitudes = RealInterval::new(least, until);
    Some(ClosingWindow { frequency: found.frequency, amplitudes, largest })
}

/// The actuator of a study that has one, and a dither.
fn asked(study: &SystemStudy) -> Result<&Actuator, Failure> {
    let (key, allowed) = match study.actuator() {
        Some(actuator) if study.system().waves().next().is_some() => return Ok(actuator),
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

/// Rejects surfaces at rest, on which any position in the stick band is an equilibrium.
fn moves(study: &SystemStudy) -> Result<(), Failure> {
    let contacts = &study.system().contacts;
    let Some(first) = contacts.first() else { return Ok(()) };
    if contacts.iter().any(|contact| contact.surface_velocity.mean() != 0.0) {
        return Ok(());
    }
    // A belt has no table of contacts.
    let key = match study.document().get("belt") {
        Some(_) => BELT_VELOCITY.path.to_owned(),
        None => format!("contact.{}.belt_velocity", first.name),
    };
    let allowed = "above 0: sliding on it is to be stable";
    Err(Complaint::new(Fault::Value, key, Origin::Whole, 0.0, allowed).into())
}

/// The table of a dither.
fn table_of(input: usize, count: usize) -> String {
    if count > 1 { format!("dither[{input}]") } else { "dither".to_owned() }
}

/// The small motions that oscillate.
fn oscillating(found: &MotionSpectrum) -> impl Iterator<Item = &SmallMotion> {
    found.motions.iter().filter(|motion| motion.eigenvalue.im > 0.0)
}

/// The frequency of the motion that grows fastest, or decays most slowly.
fn slowest_to_decay(found: &MotionSpectrum) -> Option<f64> {
    let motions = oscillating(found);
    let worst = motions.max_by(|a, b| a.eigenvalue.re.total_cmp(&b.eigenvalue.re))?;
    Some(worst.frequency())
}

fn failed(why: impl std::fmt::Display) -> Failure {
    system::failed("actuator", why)
}

/// The measured range of a frequency response; else around the study's own frequency, above the vibration itself.
fn default_range(actuator: &Actuator, wave: &Wave, slow: Option<f64>) -> RealInterval {
    let measured = actuator.measured_frequencies();
    if let [first, .., last] = measured {
        return RealInterval::new(*first, *last);
    }
    let own = wave.frequency;
    let slow = slow.map_or(0.0, |slow| slow * f64::from(wave.waveform.cycles()));
    let from = if own > FAR * slow {
        f64::max(DEFAULT_RANGE.lower * own, FAR * slow)
    } else if own > slow {
        // Halfway from the vibration to a dither that is hardly faster.
        libm::sqrt(slow * own)
    } else {
        DEFAULT_RANGE.lower * own
    };
    RealInterval::new(from, DEFAULT_RANGE.upper * own)
}

/// The frequencies of the samples: even ones, and special ones between them.
fn sampled(
    RealInterval { lower: from, upper: to }: RealInterval,
    special: impl Iterator<Item = f64>,
) -> Vec<f64> {
    let ratio = libm::log(to / from);
    let last = SAMPLES - 1;
    let even = (0..SAMPLES).map(|k| match k {
        0 => from,
        k if k == last => to,
        k => from * libm::exp(ratio * k as f64 / last as f64),
    });
    let special = special.filter(|frequency| from < *frequency && *frequency < to);
    let mut frequencies: Vec<f64> = even.chain(special).collect();
    ascending(&mut frequencies);
    frequencies.dedup();
    frequencies
}

/// Why the reach is unknown, if it is at every frequency.
fn unknown_everywhere(samples: &[ActuatorAtFrequency]) -> Option<NoAnswer> {
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
    RealInterval { lower: from, upper: to }: RealInterval,
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
        for (end, word) in [(band.ends.lower, "from here"), (band.ends.upper, "up to here")] {
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
