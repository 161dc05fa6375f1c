//! Numbers and starts as text.

use quell_model::units::{Quantity, Scales};

use crate::study::{BeltStudy, InitialState};

/// The start as text, such as "from rest".
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

/// A quantity with six significant digits, in SI with its unit if the study is in SI.
pub(crate) fn in_words(study: &BeltStudy, quantity: Quantity, value: f64) -> String {
    in_scales(study.scales(), quantity, value)
}

/// [`in_words`] for a study with these scales.
pub(crate) fn in_scales(scales: Option<Scales>, quantity: Quantity, value: f64) -> String {
    match scales.and_then(|scales| scales.one(quantity)) {
        Some((one, unit)) => format!("{} {unit}", digits(value * one)),
        None => digits(value),
    }
}

/// Six significant digits, without trailing zeros.
pub(crate) fn digits(value: f64) -> String {
    quell_model::digits::digits(value, 6)
}

/// The ending of a noun after a count.
pub fn plural<N: Copy + PartialEq + From<u8>>(count: N) -> &'static str {
    if count == N::from(1) { "" } else { "s" }
}

/// A count with its noun: "1 mode", "3 modes".
pub(crate) fn counted(count: usize, noun: &str) -> String {
    format!("{count} {noun}{}", plural(count))
}

/// A text with its first letter in upper case.
pub(crate) fn capital(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

/// A list in words: "a, b and c".
pub(crate) fn listed(parts: &[String]) -> String {
    match parts {
        [] => String::new(),
        [only] => only.clone(),
        [most @ .., last] => format!("{} and {last}", most.join(", ")),
    }
}
