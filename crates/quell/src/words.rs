//! Numbers and starts in sentences.

use quell_model::units::{Quantity, Scales};

use crate::study::{BeltStudy, InitialState};

/// The start in words.
pub fn start_in_words(study: &BeltStudy) -> String {
    match study.initial() {
        InitialState::Rest => "from rest".to_owned(),
        InitialState::Sliding => "from steady sliding".to_owned(),
        InitialState::Squealing => "from the undithered limit cycle".to_owned(),
        InitialState::Explicit { displacement, velocity } => {
            let displacement = in_words(study, Quantity::Displacement, displacement);
            let velocity = in_words(study, Quantity::Velocity, velocity);
            format!("from x = {displacement}, x′ = {velocity}")
        }
    }
}

/// A quantity in a sentence: six digits, in SI where the study is.
pub(crate) fn in_words(study: &BeltStudy, quantity: Quantity, value: f64) -> String {
    in_scales(study.scales(), quantity, value)
}

/// The same of a study with these scales.
pub(crate) fn in_scales(scales: Option<Scales>, quantity: Quantity, value: f64) -> String {
    match scales.zip(quantity.si_unit()) {
        Some((scales, (unit, _))) => format!("{} {unit}", digits(scales.to_si(quantity, value))),
        None => digits(value),
    }
}

/// Six significant digits, without zeros that say nothing.
pub(crate) fn digits(value: f64) -> String {
    let text = format!("{value:.5e}");
    text.parse::<f64>()
        .map_or(text, |rounded| format!("{rounded:?}").trim_end_matches(".0").to_owned())
}

/// The ending of a noun after a count.
pub fn plural(count: usize) -> &'static str {
    if count == 1 { "" } else { "s" }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_numbers_are_told_as_they_are() {
        for (value, told) in
            [(1e-8, "1e-8"), (4.3224, "4.3224"), (20.0, "20"), (0.0, "0"), (1234567.0, "1234570")]
        {
            assert_eq!(digits(value), told);
        }
    }
}
