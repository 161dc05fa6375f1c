//! Short tables for people.

use quell_model::units::Quantity;

use crate::fields::rate_unit;
use crate::study::{DiscStudy, UnitSystem};
use crate::words::{named_unit, unit_after};

/// Digits of a number in a table.
const DIGITS: usize = 7;

/// A table under construction: rows of a label and a text.
#[derive(Debug, Default)]
pub(super) struct TextTable(Vec<(String, String)>);

impl TextTable {
    /// A row.
    pub(super) fn word(&mut self, label: &str, value: &str) {
        self.0.push((label.to_owned(), value.to_owned()));
    }

    /// The table as text.
    pub(super) fn text(&self) -> String {
        let width = self.0.iter().map(|(label, _)| label.chars().count()).max().unwrap_or(0);
        let rows = self.0.iter().map(|(label, value)| format!("  {label:<width$}  {value}\n"));
        rows.collect()
    }
}

/// Right-aligned columns of numbers, each under a quantity with its unit.
#[derive(Debug)]
pub(super) struct NumberColumns(Vec<usize>);

impl NumberColumns {
    /// The least width of a column.
    const LEAST: usize = 14;

    /// The columns under these headings, and the line of the headings without its end.
    pub(super) fn under(headings: &[impl AsRef<str>]) -> (Self, String) {
        let widths = headings.iter().map(|name| name.as_ref().chars().count().max(Self::LEAST));
        let columns = Self(widths.collect());
        let line = columns.line(headings);
        (columns, line)
    }

    /// A row of cells without its end.
    pub(super) fn line(&self, cells: &[impl AsRef<str>]) -> String {
        let cells = self.0.iter().zip(cells);
        let cells = cells.map(|(width, cell)| format!("{:>width$}", cell.as_ref()));
        let cells: Vec<String> = cells.collect();
        format!("  {}", cells.join("  "))
    }
}

/// A heading: a quantity with its unit.
pub(super) fn heading(name: &str, unit: Option<&str>) -> String {
    match named_unit(unit) {
        Some(unit) => format!("{name} in {unit}"),
        None => name.to_owned(),
    }
}

/// The heading of a growth rate.
pub(super) fn rate_heading(units: UnitSystem) -> String {
    heading("growth rate", (units != UnitSystem::None).then(|| rate_unit(units)))
}

/// The heading of a frequency, and what an angular frequency is in its unit.
pub(super) fn frequency_heading(units: UnitSystem) -> (&'static str, f64) {
    match units {
        UnitSystem::None => ("angular frequency", 1.0),
        _ => ("frequency in Hz", 1.0 / std::f64::consts::TAU),
    }
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

/// A number with [`DIGITS`] significant digits and its unit.
pub(super) fn figure_in_units(units: UnitSystem, quantity: Quantity, value: f64) -> String {
    figure(value) + &unit_after(units.unit(quantity))
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
}
