//! Quantities on the command line: `0.5`, `0.5s`, `20 mm/s`.
//!
//! A plain number is one of the equations; a number with a unit needs a study in SI.

use quell_model::units::{Quantity, Scales};
use serde_json::Value as Json;

use crate::complaint::Complaint;

/// Units of a quantity with their size in SI.
fn units(quantity: Quantity) -> &'static [(&'static str, f64)] {
    match quantity {
        Quantity::Time => &[
            ("s", 1.0),
            ("ms", 1e-3),
            ("us", 1e-6),
            ("µs", 1e-6),
            ("μs", 1e-6),
            ("min", 60.0),
            ("h", 3600.0),
        ],
        Quantity::Velocity => &[
            ("m/s", 1.0),
            ("cm/s", 1e-2),
            ("mm/s", 1e-3),
            ("um/s", 1e-6),
            ("µm/s", 1e-6),
            ("μm/s", 1e-6),
            ("km/h", 1.0 / 3.6),
        ],
        Quantity::Displacement => &[
            ("m", 1.0),
            ("cm", 1e-2),
            ("mm", 1e-3),
            ("um", 1e-6),
            ("µm", 1e-6),
            ("μm", 1e-6),
            ("nm", 1e-9),
        ],
        Quantity::Force => &[("N", 1.0), ("mN", 1e-3), ("kN", 1e3)],
        Quantity::FrequencyRatio => &[("Hz", 1.0), ("kHz", 1e3), ("MHz", 1e6)],
        Quantity::Power => &[("W", 1.0), ("mW", 1e-3), ("kW", 1e3)],
        Quantity::PerVelocity => &[("s/m", 1.0), ("s/mm", 1e3)],
        Quantity::DampingRatio => &[("N·s/m", 1.0), ("Ns/m", 1.0)],
        Quantity::Ratio | Quantity::Count | Quantity::Angle => &[],
    }
}

/// Unit of a quantity in the numbers of the equations. The lengths of a study in SI are metres.
pub fn unit_of(quantity: Quantity, si: bool) -> String {
    let unit = quantity.scaled_unit();
    if si { unit.replacen("length", "m", 1) } else { unit.to_owned() }
}

/// Reads a quantity into the number of the equations.
///
/// # Errors
/// A complaint about `option` where the text is not a finite number, the unit is not one of
/// the quantity, or a unit is given to a study without SI.
pub fn parse(
    text: &str,
    quantity: Quantity,
    scales: Option<Scales>,
    option: &'static str,
) -> Result<f64, Box<Complaint>> {
    let text = text.trim();
    let known = units(quantity);
    let complaint = |allowed: String| Box::new(Complaint::option(option, text, allowed));
    let wanted = || match (known.first(), scales) {
        (Some((unit, _)), Some(_)) => {
            format!(
                "a finite number in {}, or one with a unit such as 0.5{unit}",
                quantity.scaled_unit()
            )
        }
        _ => format!("a finite number in {}", quantity.scaled_unit()),
    };
    if let Ok(number) = text.parse::<f64>() {
        return if number.is_finite() { Ok(number) } else { Err(complaint(wanted())) };
    }
    // The longest unit that fits: "ms" before "s".
    let fitting = known
        .iter()
        .filter_map(|(unit, size)| text.strip_suffix(unit).map(|rest| (rest.trim(), *unit, *size)))
        .min_by_key(|(rest, ..)| rest.len());
    let Some((rest, unit, size)) = fitting else {
        return Err(complaint(wanted()));
    };
    let number = rest.parse::<f64>().ok().filter(|number| number.is_finite());
    let Some(number) = number else {
        return Err(complaint(wanted()));
    };
    let Some(scales) = scales else {
        return Err(complaint(format!(
            "a plain number, in {}: {unit} needs a study in SI, with belt.mass_kg and \
             belt.stiffness_n_per_m",
            quantity.scaled_unit()
        )));
    };
    let found = scales.from_si(quantity, number * size);
    if found.is_finite() { Ok(found) } else { Err(complaint(wanted())) }
}

/// Longest time τ of a run, 1.6·10⁸ slow periods: nobody waits for longer ones.
pub const MOST_TIME: f64 = 1e9;

/// Reads how long a run lasts.
///
/// # Errors
/// As [`parse`], and where nobody could wait for it.
pub fn duration(
    text: &str,
    scales: Option<Scales>,
    option: &'static str,
) -> Result<f64, Box<Complaint>> {
    let time = parse(text, Quantity::Time, scales, option)?;
    bearable(time, text, option)
}

/// Refuses a time τ, told as it was given, that nobody could wait for.
pub(crate) fn bearable(
    time: f64,
    given: impl Into<Json>,
    option: &'static str,
) -> Result<f64, Box<Complaint>> {
    if (0.0..=MOST_TIME).contains(&time) {
        return Ok(time);
    }
    let allowed = format!("a time from 0, where a run starts, to τ = {MOST_TIME:e}");
    Err(Box::new(Complaint::option(option, given, allowed)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_are_understood_in_a_study_in_si() {
        let scales = Scales::new(2.0, 200.0).ok();
        let time = |text| {
            parse(text, Quantity::Time, scales, "--until").map_err(|complaint| complaint.allowed)
        };
        assert_eq!(time("30"), Ok(30.0));
        assert_eq!(time("3s"), Ok(30.0));
        assert_eq!(time("3000 ms"), Ok(30.0));
        assert_eq!(time("-1e0s"), Ok(-10.0));
        for wrong in ["", "s", "fast", "3m", "nan", "inf", "infs", "1e999", "1e308h", "--json"] {
            assert!(time(wrong).is_err(), "{wrong}");
        }
        assert_eq!(parse("50mm/s", Quantity::Velocity, scales, "--at").ok(), Some(0.005));
    }

    #[test]
    fn units_need_a_study_in_si() {
        let told = parse("3s", Quantity::Time, None, "--until").expect_err("no scales");
        assert!(told.allowed.contains("mass_kg") && told.key == "--until");
    }
}
