//! Quantities on the command line and in Python: `0.5`, `0.5s`, `20 mm/s`.
//!
//! A plain number is in the units of the study: SI or dimensionless. A number with a unit requires a study in SI; angles and
//! ratios may have units (`30deg`, `2%`) in any study.

use std::f64::consts::TAU;

use quell_input::complaint::Complaint;
use quell_model::units::measure::{self, Unread};
use quell_model::units::{Quantity, Scales};
use serde_json::Value as Json;

use crate::study::vocabulary::DocumentKind;
use crate::study::{DiscStudy, Study, UnitSystem, key_at};

/// Unit of a quantity in the numbers of the equations; lengths are those of the study.
pub fn unit_of(quantity: Quantity, scales: Option<Scales>) -> String {
    let unit = quantity.scaled_unit();
    match scales.and_then(|scales| scales.unit(Quantity::Displacement)) {
        Some(length) => unit.replacen("length", length, 1),
        None => unit.to_owned(),
    }
}

/// Reads an angular frequency of a system, or a frequency with its unit where the study has units.
///
/// # Errors
/// A complaint about `option` where the text is neither.
pub fn system_frequency(
    text: &str,
    units: UnitSystem,
    option: &'static str,
) -> Result<f64, Box<Complaint>> {
    if let Ok(number) = text.trim().parse::<f64>()
        && number.is_finite()
    {
        return Ok(number);
    }
    if units != UnitSystem::None
        && let Ok(hertz) = measure::read(text.trim(), Some("Hz"))
    {
        return Ok(TAU * hertz);
    }
    let allowed = match units {
        UnitSystem::None => "an angular frequency in the units of the study",
        _ => "an angular frequency in rad/s, or a frequency with its unit such as 2kHz",
    };
    Err(Box::new(Complaint::option(option, text, allowed)))
}

/// Reads a number of a study of a system in the units of its file: plain, or with a unit where the quantity has one.
///
/// # Errors
/// A complaint about `option`.
pub fn number(
    text: &str,
    quantity: Option<Quantity>,
    units: UnitSystem,
    option: &'static str,
) -> Result<f64, Box<Complaint>> {
    let unit = quantity.and_then(|quantity| units.unit(quantity));
    let why = match measure::read(text.trim(), unit) {
        Ok(number) if number.is_finite() => return Ok(number),
        Err(why) if measure::has_unit(text.trim()) && unit.is_some() => format!(": {why}"),
        _ => String::new(),
    };
    let allowed = match unit {
        None if measure::has_unit(text.trim()) => {
            "a finite number: units require a study with units".to_owned()
        }
        None => "a finite number".to_owned(),
        Some(unit) => {
            format!("a finite number in {unit}, optionally with a unit, such as 0.5{unit}{why}")
        }
    };
    Err(Box::new(Complaint::option(option, text, allowed)))
}

/// Reads how long a run of a system lasts, in the unit of time of its study.
///
/// # Errors
/// As [`number`], and for a negative time.
pub fn duration(
    text: &str,
    units: UnitSystem,
    option: &'static str,
) -> Result<f64, Box<Complaint>> {
    let time = number(text, Some(Quantity::Time), units, option)?;
    if time >= 0.0 {
        return Ok(time);
    }
    Err(Box::new(Complaint::option(option, text, "a time from 0, the start of the run, on")))
}

/// Reads a speed or a frequency of a disc into ω_ref: a plain number is in hertz where the study has numbers in SI, else in
/// ω_ref; one with a unit (`20kHz`, `900rpm`) needs a study that says what ω_ref is.
///
/// # Errors
/// A complaint about `option`.
pub fn frequency(
    text: &str,
    study: Option<&DiscStudy>,
    option: &'static str,
) -> Result<f64, Box<Complaint>> {
    // ω_ref of a study that could not be read is unknown: units are accepted then.
    let hertz = study.map_or(Some(1.0), DiscStudy::reference_hz);
    let in_hertz = study.is_some_and(DiscStudy::is_si) || measure::has_unit(text);
    match hertz.filter(|_| in_hertz) {
        Some(hertz) => measured(text, Some("Hz"), "", option).map(|found| found / hertz),
        None => measured(text, None, "ω_ref", option),
    }
}

/// Reads a slip velocity of a study, which is unknown where it could not be read: units are accepted then.
///
/// # Errors
/// As [`number`].
pub fn velocity(
    text: &str,
    study: Option<&Study>,
    option: &'static str,
) -> Result<f64, Box<Complaint>> {
    number(text, Some(Quantity::Velocity), units_of(study), option)
}

/// Reads an angular frequency of the dither of a study, which is unknown where it could not be read: units are accepted then.
///
/// # Errors
/// As [`system_frequency`].
pub fn dither_frequency(
    text: &str,
    study: Option<&Study>,
    option: &'static str,
) -> Result<f64, Box<Complaint>> {
    system_frequency(text, units_of(study), option)
}

fn units_of(study: Option<&Study>) -> UnitSystem {
    study.map_or(UnitSystem::Si, Study::units)
}

/// Reads a value of the number that a path of this study names, in the unit of its key. If the path names no number, which its own reader
/// rejects, it must still be a number.
///
/// # Errors
/// A complaint about `option` where the text is not a finite number in that unit.
pub fn value_of(
    study: Option<&Study>,
    text: &str,
    path: &str,
    option: &'static str,
) -> Result<f64, Box<Complaint>> {
    // Whether a study that could not be read has units is unknown: they are accepted then.
    let of_no_study = || {
        let find = |kind| Some((kind, key_at(path, kind).ok()?.key));
        let (kind, key) = DocumentKind::ALL.into_iter().find_map(find)?;
        Some((key.measured_in(UnitSystem::Si), key.unit_in_words(kind, UnitSystem::Si)))
    };
    let known = match study {
        Some(study) => study.address(path).ok().map(|found| (found.measured_in, found.unit)),
        None => of_no_study(),
    };
    match known {
        Some((wanted, unit)) => measured(text, wanted, unit, option),
        // The path is what is wrong, not the unit.
        None => match measure::number(text) {
            Some(number) => Ok(number),
            None => measured(text, Some("1"), "", option),
        },
    }
}

/// A finite number in `unit`; `otherwise` describes numbers without a unit.
fn measured(
    text: &str,
    unit: Option<&'static str>,
    otherwise: &'static str,
    option: &'static str,
) -> Result<f64, Box<Complaint>> {
    let text = text.trim();
    let read = match measure::read(text, unit) {
        // A frequency counts cycles.
        Err(Unread::OtherDimension(_)) if unit == Some("rad/s") => {
            measure::read(text, Some("Hz")).map(|hertz| TAU * hertz)
        }
        read => read,
    };
    let why = match read {
        Ok(number) if number.is_finite() => return Ok(number),
        Err(why) if measure::has_unit(text) => Some(why),
        _ => None,
    };
    let wanted = match (unit, otherwise) {
        (None | Some("1"), "" | "1") => "a finite number".to_owned(),
        (None, unit) => format!("a finite number in {unit}"),
        (Some("1"), _) => "a finite number, optionally in %".to_owned(),
        (Some(unit), _) => {
            format!("a finite number in {unit}, optionally with a unit, such as 0.5{unit}")
        }
    };
    let allowed = match why {
        None => wanted,
        Some(why @ Unread::NoUnitHere(_)) => {
            format!(
                "{wanted}: {why}; units require a study with units, such as that of a belt with its mass"
            )
        }
        Some(why) => format!("{wanted}: {why}"),
    };
    Err(Box::new(Complaint::option(option, text, allowed)))
}

/// Longest time τ of a run, 1.6·10⁸ slow periods: longer runs are not practical.
pub const MOST_TIME: f64 = 1e9;

/// Rejects a time τ beyond [`MOST_TIME`], reported as given.
///
/// # Errors
/// A complaint about `option`.
pub fn bearable(
    time: f64,
    given: impl Into<Json>,
    option: &'static str,
) -> Result<f64, Box<Complaint>> {
    if (0.0..=MOST_TIME).contains(&time) {
        return Ok(time);
    }
    let allowed = format!("a time between 0, the start of the run, and τ = {MOST_TIME:e}");
    Err(Box::new(Complaint::option(option, given, allowed)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_are_understood_in_a_study_in_si() {
        let time = |text| {
            let read = duration(text, UnitSystem::Si, "--until");
            read.map_err(|complaint| complaint.allowed)
        };
        assert_eq!(time("3"), Ok(3.0));
        assert_eq!(time("3s"), Ok(3.0));
        assert_eq!(time("3000 ms"), Ok(3.0));
        let wrong =
            ["", "s", "fast", "3m", "nan", "inf", "infs", "1e999", "1e308h", "-1s", "--json"];
        for wrong in wrong {
            assert!(time(wrong).is_err(), "{wrong}");
        }
        assert!(time("3m").is_err_and(|allowed| allowed.contains("in s")));
        assert_eq!(velocity("50mm/s", None, "--at").ok(), Some(0.05));
    }

    #[test]
    fn a_value_is_in_the_unit_of_its_key() {
        let study = Study::parse(
            "[belt]
mass = 2
stiffness = 200
damping_ratio = 0
normal_load = 1
belt_velocity = 1
[friction]
law = \"coulomb\"
\
             coefficient = 0.3
[dither]
direction = \"tangential\"
waveform = \"sine\"
amplitude = 1
frequency_hz = 50
",
            &[],
        )
        .expect("valid");
        let of = |text, path| {
            value_of(Some(&study), text, path, "--from").map_err(|complaint| complaint.allowed)
        };
        assert_eq!(of("5kN", "dither.amplitude"), Ok(5000.0));
        assert_eq!(of("5kN", "dither.amplitude_n"), Ok(5000.0));
        assert_eq!(of("5000", "dither.amplitude_n"), Ok(5000.0));
        assert_eq!(of("90deg", "dither.phase"), Ok(std::f64::consts::FRAC_PI_2));
        assert_eq!(of("2%", "belt.damping_ratio"), Ok(0.02));
        assert!(of("5m", "dither.amplitude_n").expect_err("a length").contains("in N"));
        // A path that names no number is what is wrong; its reader says so.
        assert_eq!(of("5kN", "dither.waveform"), Ok(5.0));
        assert!(of("loud", "dither.waveform").is_err());
    }

    #[test]
    fn units_need_a_study_in_si() {
        let complaint = duration("3s", UnitSystem::None, "--until").expect_err("no units");
        assert!(complaint.allowed.contains("study with units") && complaint.key == "--until");
    }
}
