//! Captions: law, belt, dither and start of a study in one line.

use quell_model::Direction;
use quell_model::units::Quantity;

use super::ruler::words;
use crate::run::start_in_words;
use crate::study::Study;

/// The study in one line.
pub(super) fn caption(study: &Study) -> String {
    let belt = study.belt();
    let law = belt.friction().kind();
    let mut parts = vec![
        format!("{} law", capitalised(law.name())),
        format!("$ζ$ = {}", words_of_ratio(belt.damping_ratio())),
    ];
    let load = if study.scales().is_some() { "N_0" } else { "F" };
    let velocity = if study.scales().is_some() { "V_0" } else { "v_0" };
    parts.push(format!("${load}$ = {}", words(study, Quantity::Force, belt.normal_load())));
    parts
        .push(format!("${velocity}$ = {}", words(study, Quantity::Velocity, belt.belt_velocity())));
    for (parameter, value) in law.parameters().iter().zip(belt.friction().values()) {
        parts.push(format!("${}$ = {}", parameter.symbol, words(study, parameter.quantity, value)));
    }
    for dither in belt.dithers() {
        let letter = match dither.direction {
            Direction::Tangential => "T",
            Direction::Normal => "N",
        };
        let (force, rate) = match study.scales() {
            Some(_) => (format!("A_{letter}"), format!("f_{letter}")),
            None => (format!("D_{letter}"), format!("R_{letter}")),
        };
        let phase = match dither.phase {
            0.0 => String::new(),
            phase => format!(", $φ$ = {phase}"),
        };
        parts.push(format!(
            "{} {} dither, ${force}$ = {}, ${rate}$ = {}{phase}",
            dither.direction.name(),
            dither.waveform.name(),
            words(study, Quantity::Force, dither.amplitude),
            words(study, Quantity::FrequencyRatio, dither.frequency_ratio),
        ));
    }
    parts.join(", ")
}

/// The study and its start in one line.
pub(super) fn caption_of_run(study: &Study) -> String {
    format!("{}; {}.", caption(study), start_in_words(study))
}

fn words_of_ratio(value: f64) -> String {
    let text = format!("{value:.3e}");
    text.parse::<f64>().map_or(text, |rounded| rounded.to_string())
}

fn capitalised(word: &str) -> String {
    let mut letters = word.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}
