//! Names and numbers in captions, titles and statements.

use quell_model::{LawKind, Waveform};

use quell::study::BeltStudy;

/// A number without the rounding of its last digits.
pub(super) fn short(value: f64) -> String {
    let text = format!("{value:.6}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// A small number in words.
pub(super) fn count_of(count: usize) -> String {
    let words = ["no", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine"];
    words.get(count).map_or_else(|| count.to_string(), |word| (*word).to_owned())
}

/// (a), (b), … of a panel.
pub(super) fn letter(index: usize) -> char {
    char::from(b'a' + u8::try_from(index % 26).unwrap_or(0))
}

/// Name of a law in a sentence.
pub(super) fn law_name(kind: LawKind) -> &'static str {
    match kind {
        LawKind::Stribeck => "Stribeck",
        LawKind::Decreasing => "decreasing",
        // No figure has another law.
        kind => kind.name(),
    }
}

/// Name of a waveform in a title.
pub(super) fn waveform_name(waveform: Waveform) -> &'static str {
    match waveform {
        Waveform::Sine => "sinusoidal",
        Waveform::Triangle => "triangular",
        other => other.name(),
    }
}

/// F, v_m, μ_s and μ_m for a caption.
pub(super) fn parameters(study: &BeltStudy) -> String {
    let belt = study.belt();
    let law = belt.friction();
    let values = law.values();
    match (law.kind(), values.as_slice()) {
        (LawKind::Stribeck | LawKind::Decreasing, [static_level, minimum, ..]) => format!(
            "$F$ = {}, $v_m$ = {}, $μ_s$ = {static_level}, $μ_m$ = {minimum}",
            belt.normal_load(),
            law.velocity_scale()
        ),
        // A law of one's own.
        (kind, values) => {
            let numbers = kind.parameters().iter().zip(values);
            let numbers =
                numbers.map(|(parameter, value)| format!("${}$ = {value}", parameter.symbol));
            let numbers: Vec<String> =
                std::iter::once(format!("$F$ = {}", belt.normal_load())).chain(numbers).collect();
            numbers.join(", ")
        }
    }
}
