//! Symbols with numbers, and their values, as texts and items of a sketch.

use quell_model::digits::digits;
use quell_model::units::Quantity;
use quell_model::{Friction, Waveform};

use crate::noise::lines_in_words;
use crate::plot::{Sketch, SketchKey, WaveGlyph};
use crate::words::counted;

/// Significant digits of a value in a key.
const DIGITS: usize = 4;

/// The symbol of a waveform.
pub(super) fn glyph(waveform: &Waveform) -> WaveGlyph {
    match waveform {
        Waveform::Sine => WaveGlyph::Sine,
        Waveform::Triangle => WaveGlyph::Triangle,
        Waveform::Square => WaveGlyph::Square,
        Waveform::Burst(_) => WaveGlyph::Burst,
        Waveform::Fourier(_) | Waveform::Samples(_) | Waveform::Noise(_) => WaveGlyph::Other,
    }
}

/// A value with four significant digits and a minus sign.
pub(super) fn number(value: f64) -> String {
    digits(value, DIGITS).replace('-', "−")
}

/// A symbol with an index: `$k_3$`, `$k_{12}$`.
pub(super) fn indexed(letter: &str, index: &str) -> String {
    format!("${}$", bare(letter, index))
}

/// [`indexed`] without dollars.
fn bare(letter: &str, index: &str) -> String {
    match index.chars().count() {
        0 => letter.to_owned(),
        1 => format!("{letter}_{index}"),
        _ => format!("{letter}_{{{index}}}"),
    }
}

/// The index of one of several things, counted from 1; empty for the only one.
pub(super) fn index(place: usize, count: usize) -> String {
    if count == 1 { String::new() } else { (place + 1).to_string() }
}

/// The index of a pair, counted from 1: `12`, or `3,10` where a number has two digits.
pub(super) fn pair(one: usize, other: usize) -> String {
    if one < 9 && other < 9 {
        format!("{}{}", one + 1, other + 1)
    } else {
        format!("{},{}", one + 1, other + 1)
    }
}

/// An item of a key: `$k_1$ = 4 N/m`.
pub(super) fn item(symbol: &str, value: f64, unit: Option<&str>) -> String {
    format!("{symbol} = {}", measured(value, unit))
}

/// A value with its unit, with a metric prefix where a force, a frequency or a unit made of them is large.
pub(super) fn measured(value: f64, unit: Option<&str>) -> String {
    const PREFIXES: [(&str, f64); 3] = [("G", 1e9), ("M", 1e6), ("k", 1e3)];
    let Some(unit) = unit.filter(|unit| !unit.is_empty() && *unit != "1") else {
        return number(value);
    };
    let takes_prefix = unit.starts_with('N') || unit == "Hz";
    let found = PREFIXES.iter().find(|(_, size)| takes_prefix && value.abs() >= *size);
    match found {
        Some((prefix, size)) => format!("{} {prefix}{unit}", number(value / size)),
        None => format!("{} {unit}", number(value)),
    }
}

/// Adds how many things of a key have no row, where only `most` of them have one.
pub(super) fn further(sheet: Sketch, count: usize, most: usize, noun: &str) -> Sketch {
    if count <= most {
        return sheet;
    }
    let words = counted(count - most, &format!("further {noun}"));
    sheet.with_key(SketchKey::new(words, Vec::<String>::new()))
}

/// The law of a contact with its numbers, each of which `written` writes with its unit.
pub(super) fn law_items(
    law: &Friction,
    force: &str,
    written: impl Fn(Quantity, f64) -> String,
) -> Vec<String> {
    let numbers = law.kind().parameters().iter().zip(law.values());
    let numbers = numbers
        .map(|(known, value)| format!("${}$ = {}", known.symbol, written(known.quantity, value)));
    let name = format!("{force} by the law “{}”", law.kind().name());
    [name].into_iter().chain(numbers).collect()
}

/// What a wave has in addition to amplitude and frequency: lines of noise, an envelope, a phase.
pub(super) fn wave_items(waveform: &Waveform, has_envelope: bool, phase: f64) -> Vec<String> {
    let noise = waveform.noise().map(lines_in_words);
    let envelope = has_envelope.then(|| "times its envelope".to_owned());
    let phase = (phase != 0.0).then(|| format!("$φ$ = {} rad", number(phase)));
    [noise, envelope, phase].into_iter().flatten().collect()
}

/// The terms of a sum such as `motor − 0.5 carriage` of a row over names, each with its sign; at most this many are written.
pub(super) fn terms(row: &[f64], names: &[String], most: usize) -> Vec<String> {
    let entries: Vec<(f64, &String)> =
        row.iter().copied().zip(names).filter(|(factor, _)| *factor != 0.0).collect();
    let mut terms: Vec<String> = entries
        .iter()
        .take(most)
        .enumerate()
        .map(|(place, (factor, name))| {
            let sign = match (*factor < 0.0, place == 0) {
                (true, true) => "−",
                (true, false) => "− ",
                (false, true) => "",
                (false, false) => "+ ",
            };
            let size = factor.abs();
            let size = if size == 1.0 { String::new() } else { format!("{} ", number(size)) };
            format!("{sign}{size}{name}")
        })
        .collect();
    if entries.len() > most {
        terms.push(format!("+ … ({} more)", entries.len() - most));
    }
    terms
}

/// A sum of at most four [`terms`].
pub(super) fn combination(row: &[f64], names: &[String]) -> String {
    match terms(row, names, 4) {
        none if none.is_empty() => "0".to_owned(),
        terms => terms.join(" "),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_are_written_as_sums() {
        let names: Vec<String> = ["x", "y", "z"].map(str::to_owned).to_vec();
        assert_eq!(combination(&[1.0, -1.0, 0.0], &names), "x − y");
        assert_eq!(combination(&[0.0, -0.25, 2.0], &names), "−0.25 y + 2 z");
        let many: Vec<String> = (0..9).map(|number| format!("b{number}")).collect();
        assert_eq!(combination(&[1.0; 9], &many), "b0 + b1 + b2 + b3 + … (5 more)");
    }

    #[test]
    fn indices_with_several_digits_are_in_braces() {
        assert_eq!(indexed("k", &pair(0, 1)), "$k_{12}$");
        assert_eq!(indexed("k", &pair(2, 9)), "$k_{3,10}$");
        assert_eq!(indexed("m", &index(0, 1)), "$m$");
        assert_eq!(item("$m$", -0.5, Some("kg")), "$m$ = −0.5 kg");
        assert_eq!(item("$k$", 6.19e8, Some("N/m")), "$k$ = 619 MN/m");
        assert_eq!(item("$m$", 2000.0, Some("kg")), "$m$ = 2000 kg");
    }
}
