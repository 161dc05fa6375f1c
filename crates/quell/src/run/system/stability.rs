//! `stability` of a system: every small motion about steady sliding, and under dither about averaged sliding.

use quell_linear::averaging::{Becomes, CriticalInput, DitheredContact, DitheredSystem};
use quell_linear::growth::{Growth, Verdict};
use quell_linear::linearised::Linearised;
use quell_linear::spectrum::{MotionSpectrum, SmallMotion, spectrum};
use quell_model::System;
use quell_model::profile::Wave;
use quell_model::units::Quantity;
use serde_json::Value as Json;

use super::modes::natural;
use super::validity::{condition, opened, opening};
use super::{
    failed, force, has_equations, not_averaged, oscillating, put_motion, rate_of, upper,
    velocity_in_words,
};
use crate::complaint::Failure;
use crate::contact_state;
use crate::fields::Fields;
use crate::noise::few_lines_of_system;
use crate::range::outside_of_laws;
use crate::run::stability::{becomes, kind};
use crate::study::{SystemStudy, UnitSystem};
use crate::words::digits;

/// An eigenfrequency above the dither frequency divided by this is not far below it.
pub(crate) const FAR: f64 = 3.0;

/// A contact in steady or averaged sliding.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SlidingContact {
    /// Friction force.
    pub friction: f64,
    /// Normal load.
    pub normal_load: f64,
    /// What dither does to it; `None` without.
    pub dithered: Option<DitheredContact>,
}

/// What holds under dither.
#[derive(Clone, Debug, PartialEq)]
pub struct UnderDither {
    /// Every small motion without it.
    pub undithered: MotionSpectrum,
    /// Amplitudes of the first dither at which the verdict changes, or why they are unknown.
    pub critical: Result<Vec<CriticalInput>, String>,
}

/// Stability of a system.
#[derive(Clone, Debug, PartialEq)]
pub struct SystemStability {
    /// Every small motion.
    pub spectrum: MotionSpectrum,
    /// The contacts, in the order of the study.
    pub contacts: Vec<SlidingContact>,
    /// What holds under dither; `None` without.
    pub dither: Option<UnderDither>,
    /// Warnings about the answer.
    pub warnings: Vec<String>,
}

/// Stability of a study's system.
///
/// # Errors
/// [`Failure::Failed`] without steady sliding, and where averaging has no answer.
pub fn run(study: &SystemStudy) -> Result<SystemStability, Failure> {
    has_equations(study, "stability")?;
    let system = study.system();
    let linear = Linearised::new(system).map_err(|why| failed("stability", why))?;
    let undithered =
        spectrum(&linear, &linear.friction()).map_err(|why| failed("stability", why))?;
    let mut warnings = study.warnings().to_vec();
    warnings.extend(outside_of_laws(system, |speed| velocity_in_words(study, speed), None));
    if !system.is_dithered() {
        let contacts = linear.contacts().iter().zip(linear.friction());
        let contacts = contacts
            .map(|(contact, friction)| SlidingContact {
                friction: friction.force,
                normal_load: contact.steady.normal_load,
                dithered: None,
            })
            .collect();
        return Ok(SystemStability { spectrum: undithered, contacts, dither: None, warnings });
    }
    let prepared = DitheredSystem::new(system).map_err(not_averaged)?;
    let average = prepared.average().map_err(not_averaged)?;
    let spectrum = average.spectrum().map_err(|why| failed("stability", why))?;
    let critical = prepared.critical_amplitudes(0).map_err(|why| why.to_string());
    let contacts: Vec<SlidingContact> = average
        .contacts
        .iter()
        .map(|contact| SlidingContact {
            friction: contact.friction,
            normal_load: contact.normal_load,
            dithered: Some(*contact),
        })
        .collect();
    warnings.extend(outside_of_laws(
        system,
        |speed| velocity_in_words(study, speed),
        Some(&average.contacts),
    ));
    warnings.extend(opened(study.units(), system, &average.contacts));
    warnings.extend(not_slow(study, &undithered));
    warnings.extend(few_lines_of_system(system));
    warnings.extend(contact_state::averaged_without_states(system, &average.contacts));
    let dither = Some(UnderDither { undithered, critical });
    Ok(SystemStability { spectrum, contacts, dither, warnings })
}

/// The warning about motions that are not much slower than the dither.
fn not_slow(study: &SystemStudy, undithered: &MotionSpectrum) -> Option<String> {
    let lowest = |wave: &Wave| match wave.waveform.noise() {
        Some(_) => wave.frequency * wave.waveform.lowest_multiple(),
        None => wave.repetition(),
    };
    let slowest = study.system().waves().map(lowest).fold(f64::INFINITY, f64::min);
    let near = upper(undithered).filter(|motion| natural(motion) * FAR > slowest);
    let distance = |motion: &SmallMotion| (natural(motion) - slowest).abs();
    let nearest = near.min_by(|a, b| distance(a).total_cmp(&distance(b)))?;
    let own = natural(nearest);
    let because = "averaging assumes that the dither is much faster than every motion";
    if nearest.frequency() == 0.0 {
        let units = study.units();
        return Some(format!(
            "a motion without oscillation has the rate |λ| = {}, which is not far below the angular frequency of the dither, {}: \
             {because}",
            rate_of(units, own),
            rate_of(units, slowest)
        ));
    }
    let (factor, unit) = match study.units() {
        UnitSystem::None => (1.0, ""),
        _ => (1.0 / std::f64::consts::TAU, " Hz"),
    };
    Some(format!(
        "the eigenfrequency {}{unit} is not far below the dither frequency {}{unit}: {because}",
        digits(factor * own),
        digits(factor * slowest)
    ))
}

impl SystemStability {
    /// The protocol of the verdict.
    pub fn protocol(&self) -> &'static str {
        if self.dither.is_some() { "averaged" } else { "linearised" }
    }

    /// The answer in one or two sentences.
    pub fn sentence(&self, study: &SystemStudy) -> String {
        let Growth { rate, error, frequency } = self.spectrum.growth;
        let by = match self.dither {
            Some(_) => "By averaging over the dither",
            None => "By linearisation",
        };
        let units = study.units();
        let (is, condition) = self.condition(study.system());
        let verdict = match self.spectrum.growth.verdict() {
            Verdict::Stable => format!(
                "steady sliding {is} stable{condition}: every motion decays, the slowest at the rate {}",
                rate_of(units, -rate)
            ),
            Verdict::Unstable => format!(
                "steady sliding {is} unstable{condition}: a motion {} grows at the rate {}",
                oscillating(units, frequency),
                rate_of(units, rate)
            ),
            Verdict::Undecided if !error.is_finite() => {
                "the stability of steady sliding is undecided: the numbers are too large or too small to bound the error of the \
                 growth rate"
                    .to_owned()
            }
            Verdict::Undecided => format!(
                "the stability of steady sliding is undecided: the largest growth rate is zero within its error, {error:.1e}"
            ),
        };
        format!("{by}, {verdict}.{}", self.next(study))
    }

    /// The verb of the verdict, and the condition under which it would hold: "is" alone where every contact stays closed.
    fn condition(&self, system: &System) -> (&'static str, String) {
        let dithered: Option<Vec<DitheredContact>> =
            self.contacts.iter().map(|contact| contact.dithered).collect();
        let dithered = dithered.unwrap_or_default();
        match condition(&opening(system, &dithered)) {
            Some(condition) => ("would be", format!(" {condition}")),
            None => ("is", String::new()),
        }
    }

    /// The next amplitude at which the verdict changes.
    fn next(&self, study: &SystemStudy) -> String {
        let Some(UnderDither { critical: Ok(critical), undithered }) = &self.dither else {
            return String::new();
        };
        let without = undithered.growth.verdict().name();
        let waves = study.system().inputs.first().map(|input| input.profile.waves());
        let now = waves.and_then(|waves| waves.first()).map_or(0.0, |wave| wave.amplitude);
        let wanted = match self.spectrum.growth.verdict() {
            Verdict::Stable => Becomes::Unstable,
            _ => Becomes::Stable,
        };
        let next = critical.iter().find(|found| found.amplitude > now && found.becomes == wanted);
        let more = next.map_or(String::new(), |found| {
            format!(
                " {} makes it {} from the amplitude {} on{}.",
                if study.system().inputs.len() > 1 {
                    "A larger first dither"
                } else {
                    "More dither"
                },
                becomes(found.becomes),
                force(study.units(), found.amplitude),
                if found.contacts_stay_closed { "" } else { ", if every contact stayed closed" }
            )
        });
        format!(" Without dither it is {without}.{more}")
    }

    /// As JSON.
    pub fn json(&self, study: &SystemStudy) -> Json {
        let units = study.units();
        let mut fields = Fields::of_system(units);
        let Growth { rate, error, frequency } = self.spectrum.growth;
        fields
            .plain("ok", true)
            .plain("sentence", self.sentence(study))
            .plain("verdict", self.spectrum.growth.verdict().name())
            .plain("protocol", self.protocol())
            .rate("growth_rate", Ok(rate))
            .rate("growth_rate_error", Ok(error))
            .number("frequency", Quantity::FrequencyRatio, frequency);
        let values = self.spectrum.motions.iter().map(|motion| motion.eigenvalue);
        let eigenvalues: Vec<Vec<f64>> = values.map(|value| vec![value.re, value.im]).collect();
        fields.plain("eigenvalues", eigenvalues);
        let motions = upper(&self.spectrum).map(|motion| put_motion(study.system(), units, motion));
        fields.list("motions", motions.collect::<Vec<_>>());
        let contacts = study.system().contacts.iter().zip(&self.contacts);
        let contacts = contacts.map(|(contact, found)| put_contact(&contact.name, units, found));
        fields.list("contacts", contacts.collect::<Vec<_>>());
        self.put_dither(&mut fields, units);
        fields.plain("warnings", self.warnings.clone());
        fields.finish()
    }

    fn put_dither(&self, fields: &mut Fields, units: UnitSystem) {
        let Some(UnderDither { undithered, critical }) = &self.dither else {
            let why = "the study has no dither";
            fields.unknown("undithered", why).unknown("critical_amplitudes", why);
            return;
        };
        let mut inner = Fields::of_system(units);
        inner
            .plain("verdict", undithered.growth.verdict().name())
            .rate("growth_rate", Ok(undithered.growth.rate))
            .rate("growth_rate_error", Ok(undithered.growth.error))
            .number("frequency", Quantity::FrequencyRatio, undithered.growth.frequency);
        fields.nested("undithered", inner);
        put_critical(fields, units, critical, |_, found| Ok(found.error));
    }
}

/// Adds critical amplitudes with the error of each, or why they are unknown.
pub(super) fn put_critical(
    fields: &mut Fields,
    units: UnitSystem,
    critical: &Result<Vec<CriticalInput>, String>,
    error: impl Fn(usize, &CriticalInput) -> Result<f64, String>,
) {
    let critical = match critical {
        Ok(critical) => critical,
        Err(why) => {
            fields.unknown("critical_amplitudes", why.clone());
            return;
        }
    };
    let items = critical.iter().enumerate().map(|(index, found)| {
        let mut inner = Fields::of_system(units);
        inner
            .number("amplitude", Quantity::Force, found.amplitude)
            .known("amplitude_error", Quantity::Force, error(index, found))
            .plain("kind", kind(found.crossing))
            .plain("becomes", becomes(found.becomes))
            .plain("contacts_stay_closed", found.contacts_stay_closed)
            .plain("within_law_ranges", found.within_laws);
        inner
    });
    fields.list("critical_amplitudes", items.collect::<Vec<_>>());
}

/// One contact.
pub(super) fn put_contact(name: &str, units: UnitSystem, found: &SlidingContact) -> Fields {
    let mut fields = Fields::of_system(units);
    fields.plain("name", name).number("friction", Quantity::Force, found.friction).number(
        "normal",
        Quantity::Force,
        found.normal_load,
    );
    let no_dither = || "the study has no dither".to_owned();
    let dithered = found.dithered.ok_or_else(no_dither);
    let of = |pick: fn(&DitheredContact) -> f64| dithered.as_ref().map(pick).map_err(Clone::clone);
    fields
        .known("slip_amplitude", Quantity::Velocity, of(|found| found.slip_amplitude))
        .known("load_amplitude", Quantity::Force, of(|found| found.load_amplitude))
        .known("effective_coefficient", Quantity::Ratio, of(|found| found.effective_coefficient))
        .known("ratchet_force", Quantity::Force, of(|found| found.ratchet_force))
        .known("slope_by_velocity", Quantity::LoadDamping, of(|found| found.slope_by_velocity));
    fields
}
