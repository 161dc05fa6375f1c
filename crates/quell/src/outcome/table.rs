//! Short tables for people: label, value, unit, and the value in SI.

use crate::quantity::unit_of;
use crate::study::DiscStudy;
use quell_model::units::{Quantity, Scales};

/// Digits of a number in a table.
const DIGITS: usize = 7;

/// A table under construction.
#[derive(Debug)]
pub(super) struct TextTable {
    scales: Option<Scales>,
    rows: Vec<[String; 4]>,
}

impl TextTable {
    /// An empty table of a study with these scales.
    pub(super) fn new(scales: Option<Scales>) -> Self {
        Self { scales, rows: Vec::new() }
    }

    /// A row of a quantity.
    pub(super) fn number(&mut self, label: &str, quantity: Quantity, value: f64) {
        if !value.is_finite() {
            return self.word(label, "undefined: beyond the range of floating-point numbers");
        }
        let unit = unit_of(quantity, self.scales);
        let unit = if unit == "1" { String::new() } else { unit };
        let scales = self.scales.filter(|_| quantity != Quantity::Displacement);
        let si = match scales.and_then(|scales| scales.one(quantity)) {
            Some((one, unit)) => format!("{} {unit}", figure(value * one)),
            None => String::new(),
        };
        self.rows.push([label.to_owned(), figure(value), unit, si]);
    }

    /// A row of a quantity, or why it is undefined.
    pub(super) fn known(&mut self, label: &str, quantity: Quantity, value: Result<f64, String>) {
        match value {
            Ok(value) => self.number(label, quantity, value),
            Err(why) => self.word(label, &format!("undefined: {why}")),
        }
    }

    /// A row of text.
    pub(super) fn word(&mut self, label: &str, value: &str) {
        self.rows.push([label.to_owned(), value.to_owned(), String::new(), String::new()]);
    }

    /// The table as text.
    pub(super) fn text(&self) -> String {
        // Rows of words may be long and do not widen the columns.
        let width = |column: usize| {
            let measured = self.rows.iter().filter(|row| column == 0 || !is_word(row));
            measured.map(|row| row[column].chars().count()).max().unwrap_or(0)
        };
        let widths = [width(0), width(1), width(2)];
        let mut text = String::new();
        for row in &self.rows {
            let mut line = String::from(" ");
            for (cell, width) in row.iter().zip(widths.iter().chain([&0])) {
                let pad = width.saturating_sub(cell.chars().count());
                line.push(' ');
                line.push_str(cell);
                line.extend(std::iter::repeat_n(' ', pad + 1));
            }
            text.push_str(line.trim_end());
            text.push('\n');
        }
        text
    }
}

fn is_word(row: &[String; 4]) -> bool {
    row[2].is_empty() && row[3].is_empty() && row[1].parse::<f64>().is_err()
}

/// Frequencies of a disc in hertz, in brackets; empty if the study does not define ω_ref.
pub(super) fn in_hertz(study: &DiscStudy, ratios: &[f64]) -> String {
    let in_brackets = |hertz: f64| {
        let values: Vec<String> = ratios.iter().map(|ratio| figure(ratio * hertz)).collect();
        format!(" ({} Hz)", values.join(" to "))
    };
    study.reference_hz().map_or_else(String::new, in_brackets)
}

/// A speed of a disc in revolutions per minute, in brackets; empty if the study does not define ω_ref.
pub(super) fn in_rpm(study: &DiscStudy, speed: f64) -> String {
    let in_brackets = |hertz: f64| format!(" ({} rpm)", figure(60.0 * hertz * speed));
    study.reference_hz().map_or_else(String::new, in_brackets)
}

/// A number with [`DIGITS`] significant digits.
pub(super) fn figure(value: f64) -> String {
    let size = value.abs();
    if value == 0.0 {
        return "0".to_owned();
    }
    if !(1e-4..1e7).contains(&size) {
        let text = format!("{value:.*e}", DIGITS - 1);
        return match text.split_once('e') {
            Some((digits, exponent)) => format!("{}e{exponent}", trimmed(digits)),
            None => text,
        };
    }
    let mut places = DIGITS;
    let mut scale = 1.0;
    while places > 0 && size >= scale {
        scale *= 10.0;
        places -= 1;
    }
    // Below 0.1, leading zeros after the decimal point are not significant.
    let mut scale = 0.1;
    while size < scale {
        scale /= 10.0;
        places += 1;
    }
    trimmed(&format!("{value:.places$}")).to_owned()
}

fn trimmed(digits: &str) -> &str {
    if digits.contains('.') { digits.trim_end_matches('0').trim_end_matches('.') } else { digits }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn figures_have_seven_significant_digits() {
        for (value, text) in [
            (0.0, "0"),
            (1.0, "1"),
            (-0.05, "-0.05"),
            (std::f64::consts::PI, "3.141593"),
            (123456.789, "123456.8"),
            (0.000123456789, "0.0001234568"),
            (1e-9, "1e-9"),
            (-6.02214076e23, "-6.022141e23"),
        ] {
            assert_eq!(figure(value), text);
        }
    }

    #[test]
    fn a_study_in_si_shows_both() {
        let mut table = TextTable::new(Scales::new(2.0, 200.0).ok());
        table.number("time", Quantity::Time, 30.0);
        table.number("stick fraction", Quantity::Ratio, 0.25);
        assert_eq!(table.text(), "  time            30    1/ω₀  3 s\n  stick fraction  0.25\n");
    }
}
