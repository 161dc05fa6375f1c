//! Runs of a study of a system: one file per verb.

pub mod attractor;
pub mod design;
pub mod exact;
pub mod measured;
pub mod modes;
pub mod of_runs;
pub mod periods;
pub mod reach;
pub mod receptance;
pub mod start;
pub mod tracked;
pub mod validity;

use quell_linear::spectrum::{MotionSpectrum, SmallMotion};
use quell_model::System;
use quell_model::units::Quantity;
use quell_numerics::interval::RealInterval;
use serde_json::Value as Json;

use crate::complaint::{Complaint, Failure, Fault, Origin};
use crate::fields::Fields;
use crate::needs::StudyVerb;
use crate::study::{SystemStudy, UnitSystem};
use crate::words::{digits, more_digits, unit_after};

/// The failure of a verb with its reason.
pub(in crate::run) fn failed(verb: &str, why: impl std::fmt::Display) -> Failure {
    Failure::Failed { key: verb.to_owned(), why: why.to_string().into() }
}

/// Rejects a study that does not meet the needs of a verb, and a measured frequency response, which has no equations.
///
/// # Errors
/// The complaint about the study.
pub fn has_equations(study: &SystemStudy, verb: &str) -> Result<(), Failure> {
    if let Some(complaint) = measured_alone(study, verb) {
        return Err(complaint.into());
    }
    let needs = StudyVerb::named(verb).map(|verb| verb.needs);
    let refused = needs.and_then(|needs| needs.refused(&study.into(), verb));
    refused.map_or(Ok(()), |complaint| Err(complaint.into()))
}

/// The complaint of `what` about a measured frequency response; `None` of equations.
pub fn measured_alone(study: &SystemStudy, what: &str) -> Option<Complaint> {
    study.frequency_response()?;
    let key = "system.frequency_response";
    let allowed = format!(
        "{what} needs masses and stiffness or modes; a measured frequency response gives the verdict of `stability` alone"
    );
    Some(Complaint::new(Fault::Conflict, key, Origin::Whole, Json::Null, allowed))
}

/// A frequency after the noun: in hertz where the study has units.
pub fn oscillating(units: UnitSystem, frequency: f64) -> String {
    match units {
        _ if frequency == 0.0 => "without oscillation".to_owned(),
        UnitSystem::None => format!("of angular frequency {}", digits(frequency)),
        _ => format!("of {} Hz", digits(frequency / std::f64::consts::TAU)),
    }
}

/// A range of angular frequencies of `--frequency`, for a question that has an answer at frequency 0 or not.
///
/// # Errors
/// A complaint about a range that does not ascend, or begins below 0 or there.
pub(crate) fn checked_frequencies(
    RealInterval { lower: from, upper: to }: RealInterval,
    holds_at_rest: bool,
) -> Result<RealInterval, Failure> {
    if (from > 0.0 || holds_at_rest && from == 0.0) && to > from && to.is_finite() {
        return Ok(RealInterval::new(from, to));
    }
    let allowed = if holds_at_rest {
        "two numbers, the first at least 0, the second above the first"
    } else {
        "two positive numbers, the second above the first"
    };
    Err(Complaint::option("--frequency", format!("{from}:{to}"), allowed).into())
}

/// A frequency with its unit: in hertz where the study has units.
pub fn frequency_in_words(units: UnitSystem, frequency: f64) -> String {
    match units {
        UnitSystem::None => format!("the angular frequency {}", more_digits(frequency)),
        _ => format!("{} Hz", more_digits(frequency / std::f64::consts::TAU)),
    }
}

/// A quantity with its unit.
pub fn in_units(units: UnitSystem, quantity: Quantity, value: f64) -> String {
    digits(value) + &unit_after(units.unit(quantity))
}

/// A value of the number at a path with its unit.
pub(crate) fn value_at(study: &SystemStudy, path: &str, value: f64) -> String {
    digits(value) + &unit_after(study.unit_of(path))
}

/// [`value_at`] with more digits, for values that are close to each other.
pub(crate) fn value_closely_at(study: &SystemStudy, path: &str, value: f64) -> String {
    more_digits(value) + &unit_after(study.unit_of(path))
}

/// A number of a study with its unit; a time in seconds where plain times of its options are.
pub(crate) fn in_units_of(study: &SystemStudy, quantity: Quantity, value: f64) -> String {
    match study.scaled_time().filter(|time| time.plain_in_seconds) {
        Some(time) if quantity == Quantity::Time => {
            in_units(UnitSystem::Si, quantity, value / time.per_second)
        }
        _ => in_units(study.units(), quantity, value),
    }
}

/// A velocity with its unit.
pub fn velocity_in_words(study: &SystemStudy, speed: f64) -> String {
    in_units(study.units(), Quantity::Velocity, speed)
}

/// A growth rate with its unit.
pub fn rate_of(units: UnitSystem, rate: f64) -> String {
    let unit = if units == UnitSystem::None { "" } else { " 1/s" };
    format!("{}{unit}", digits(rate))
}

/// A force with its unit.
pub(crate) fn force(units: UnitSystem, value: f64) -> String {
    in_units(units, Quantity::Force, value)
}

/// One small motion.
pub(crate) fn put_motion(system: &System, units: UnitSystem, motion: &SmallMotion) -> Fields {
    let mut fields = Fields::in_units(units);
    fields
        .rate("growth_rate", motion.eigenvalue.re)
        .number("frequency", Quantity::FrequencyRatio, motion.frequency())
        .number("damping_ratio", Quantity::Ratio, motion.damping_ratio())
        .rate("error", motion.error)
        .plain(
            "shape",
            motion.shape.iter().map(|z| [z.re, z.im]).map(Vec::from).collect::<Vec<_>>(),
        );
    let contacts = system.contacts.iter().zip(&motion.friction_shares);
    if motion.friction_shares.is_empty() && !system.contacts.is_empty() {
        let why = "the energy of first-order equations is not known, and a motion at rest has none";
        fields.unknown("friction_work", why);
    } else {
        let work = contacts.map(|(contact, share)| {
            let mut inner = Fields::in_units(units);
            inner.plain("contact", contact.name.clone()).rate("growth_rate", *share);
            inner
        });
        fields.list("friction_work", work);
    }
    fields
}

/// Every motion but the conjugates of those listed.
pub(crate) fn upper(spectrum: &MotionSpectrum) -> impl Iterator<Item = &SmallMotion> {
    spectrum.motions.iter().filter(|motion| motion.eigenvalue.im >= 0.0)
}
