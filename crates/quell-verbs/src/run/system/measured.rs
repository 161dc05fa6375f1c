//! `stability` of a structure that is known by its measured frequency response: a verdict without growth rate.

use num_complex::Complex64;
use quell_linear::averaging::CriticalInput;
use quell_linear::growth::Verdict;
use quell_linear::measured::{MeasuredSliding, MeasuredSystem, NoMeasuredVerdict, Receptance};
use quell_model::units::Quantity;
use serde_json::Value as Json;

use super::validity::{condition, opened, opening};
use super::{failed, oscillating, velocity_in_words};
use crate::complaint::Failure;
use crate::fields::Fields;
use crate::range::outside_of_laws;
use crate::run::stability::{SlidingContact, put_contact, put_critical};
use crate::study::{FrequencyResponse, SystemStudy};
use crate::words::plural;

/// Why a growth rate is null.
const NO_RATE: &str = "a measured frequency response gives a verdict by the generalised Nyquist criterion, but no growth rate";

/// Why the error of a critical amplitude is null.
const UNCHECKED: &str = "the error of interpolation between the measured frequencies is unknown: every second of them does not decide";

/// Stability of a measured structure.
#[derive(Clone, Debug, PartialEq)]
pub struct MeasuredStability {
    /// Sliding under the dither of the study, or without dither.
    pub sliding: MeasuredSliding,
    /// What the dither does; `None` without dither.
    pub dither: Option<MeasuredDither>,
}

/// The dither of a measured structure.
#[derive(Clone, Debug, PartialEq)]
pub struct MeasuredDither {
    /// Sliding without it.
    pub undithered: MeasuredSliding,
    /// Critical amplitudes of the first one.
    pub critical: Result<Vec<CriticalInput>, NoMeasuredVerdict>,
    /// The error of each by interpolation between the measured frequencies; `None` where it is unknown.
    pub interpolation: Vec<Option<f64>>,
}

/// The receptance of a study.
fn receptance(response: &FrequencyResponse) -> Receptance {
    let mut found = Receptance::new(response.frequencies.clone(), response.names.len());
    for (&(output, input), values) in response.pairs.iter().zip(&response.data) {
        let values = values.iter().map(|[re, im]| Complex64::new(*re, *im)).collect();
        found = found.with(output, input, values);
    }
    found
}

/// Stability of a study with a measured frequency response.
///
/// # Errors
/// [`Failure::Failed`] without steady sliding, and where the measured band does not decide.
pub fn run(
    study: &SystemStudy,
    response: &FrequencyResponse,
) -> Result<MeasuredStability, Failure> {
    let receptance = receptance(response);
    let no_verdict = |why| failed("stability", why);
    let prepared = MeasuredSystem::new(study.system(), &receptance).map_err(no_verdict)?;
    let undithered = prepared.sliding().map_err(no_verdict)?;
    if !study.system().is_dithered() {
        return Ok(MeasuredStability { sliding: undithered, dither: None });
    }
    let sliding = prepared.average(None).map_err(no_verdict)?;
    let critical = prepared.critical_amplitudes(0);
    let interpolation = prepared.interpolation_errors(0, critical.as_deref().unwrap_or_default());
    let dither = MeasuredDither { undithered, critical, interpolation };
    Ok(MeasuredStability { sliding, dither: Some(dither) })
}

impl MeasuredStability {
    /// The answer in one or two sentences.
    pub fn sentence(&self, study: &SystemStudy) -> String {
        let turns = self.sliding.turns;
        let closest = oscillating(study.units(), turns.closest);
        let by = if self.dither.is_some() { "By averaging and the" } else { "By the" };
        let (is, condition) = match condition(&opening(study.system(), &self.sliding.dithered)) {
            Some(condition) => ("would be", format!(" {condition}")),
            None => ("is", String::new()),
        };
        let verdict = match turns.unstable {
            0 => format!("steady sliding {is} stable{condition}"),
            count => {
                format!(
                    "steady sliding {is} unstable{condition}: {count} characteristic root{} with positive real part",
                    plural(count)
                )
            }
        };
        format!(
            "{by} generalised Nyquist criterion of the measured response, {verdict}. The motion closest to \
             marginal is one {closest}."
        )
    }

    /// The warnings of the study, about contacts that open and about slip outside the range of a law.
    fn warnings(&self, study: &SystemStudy) -> Vec<String> {
        let (system, dithered) = (study.system(), self.sliding.dithered.as_slice());
        let fast = (!dithered.is_empty()).then_some(dithered);
        let words = |speed| velocity_in_words(study, speed);
        let listed = study.warnings().iter().cloned().chain(outside_of_laws(system, words, fast));
        listed.chain(opened(study.units(), system, dithered)).collect()
    }

    /// As JSON.
    pub fn json(&self, study: &SystemStudy) -> Json {
        let units = study.units();
        let mut fields = Fields::in_units(units);
        fields
            .plain("ok", true)
            .plain("sentence", self.sentence(study))
            .plain("verdict", self.sliding.verdict().name())
            .plain("protocol", if self.dither.is_some() { "averaged" } else { "linearised" })
            .known_rate("growth_rate", Err(NO_RATE))
            .known_rate("growth_rate_error", Err(NO_RATE))
            .number("frequency", Quantity::FrequencyRatio, self.sliding.turns.closest)
            .unknown("eigenvalues", NO_RATE)
            .plain("unstable_roots", self.sliding.turns.unstable)
            .plain("half_turns", self.sliding.turns.half_turns)
            .plain("distance_from_marginal", self.sliding.turns.distance);
        let contacts = study.system().contacts.iter().zip(&self.sliding.contacts).enumerate();
        let contacts = contacts.map(|(index, (contact, steady))| {
            let found = SlidingContact {
                friction: steady.factor * steady.friction,
                normal_load: steady.normal_load,
                dithered: self.sliding.dithered.get(index).copied(),
            };
            put_contact(&contact.name, units, &found)
        });
        fields.list("contacts", contacts.collect::<Vec<_>>());
        match &self.dither {
            None => {
                let why = "the study has no dither";
                fields.unknown("undithered", why).unknown("critical_amplitudes", why);
            }
            Some(MeasuredDither { undithered, critical, interpolation }) => {
                let mut inner = Fields::in_units(units);
                let verdict: Verdict = undithered.verdict();
                inner
                    .plain("verdict", verdict.name())
                    .known_rate("growth_rate", Err(NO_RATE))
                    .number("frequency", Quantity::FrequencyRatio, undithered.turns.closest);
                fields.nested("undithered", inner);
                put_critical(&mut fields, units, critical, |index, found| {
                    let between = interpolation.get(index).copied().flatten();
                    between.map(|error| error + found.error).ok_or(UNCHECKED)
                });
            }
        }
        fields.plain("warnings", self.warnings(study));
        fields.finish()
    }
}
