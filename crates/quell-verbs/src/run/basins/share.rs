//! The share of the window that a basin covers, with bounds.
//!
//! For a random sample of n starts of which k are inside: k/n with the interval of Wilson (1927) at 95 %. A grid is not a
//! sample: each start represents the cell around it, and the basin boundary runs somewhere between a start inside and its
//! neighbour outside. A cell next to the boundary may lose or gain up to half of itself, and the bounds are the sums of
//! these halves. A part of the basin that is smaller than a cell is missed, and not covered by the bounds.

use quell_model::units::Quantity;
use quell_numerics::interval::RealInterval;

use super::starts::StartLayout;
use crate::fields::Fields;

/// z of a two-sided 95 %.
const Z: f64 = 1.959_963_984_540_054;

/// A share of the window with its bounds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Share {
    /// Number of starts inside.
    pub starts: usize,
    /// The share of all starts.
    pub fraction: f64,
    /// Lower bound.
    pub low: f64,
    /// Upper bound.
    pub high: f64,
}

impl Share {
    /// The share of the starts for which `inside` holds.
    pub(crate) fn of(layout: StartLayout, inside: &[bool]) -> Self {
        let starts = inside.iter().filter(|holds| **holds).count();
        let count = inside.len().max(1) as f64;
        let fraction = starts as f64 / count;
        let RealInterval { lower: low, upper: high } = match layout {
            StartLayout::Sample { .. } => wilson(fraction, count),
            StartLayout::Grid { columns, .. } => {
                let (inner, outer) = border(inside, columns);
                RealInterval::new(
                    fraction - 0.5 * inner as f64 / count,
                    fraction + 0.5 * outer as f64 / count,
                )
            }
        };
        Self { starts, fraction, low, high }
    }

    /// The share of the starts that are `surely` inside; the upper bound also counts those that are `perhaps` inside.
    pub(crate) fn between(layout: StartLayout, surely: &[bool], perhaps: &[bool]) -> Self {
        let all: Vec<bool> = surely.iter().zip(perhaps).map(|(a, b)| *a || *b).collect();
        Self { high: Self::of(layout, &all).high, ..Self::of(layout, surely) }
    }

    /// As a percentage with its bounds.
    pub fn percent(self) -> String {
        let digits = |value: f64| {
            let text = format!("{:.1}", 100.0 * value);
            text.trim_end_matches(".0").to_owned()
        };
        format!("{} % ({} to {} %)", digits(self.fraction), digits(self.low), digits(self.high))
    }

    /// Adds its fields to an object.
    pub(in crate::run) fn put(self, fields: &mut Fields) {
        fields
            .plain("starts", self.starts)
            .number("fraction", Quantity::Ratio, self.fraction)
            .number("fraction_low", Quantity::Ratio, self.low)
            .number("fraction_high", Quantity::Ratio, self.high)
            .number("fraction_error", Quantity::Ratio, self.error());
    }

    /// Adds the share of quiet starts to an object; `None` if the outcome of every start is unknown.
    pub(in crate::run) fn put_quiet(fields: &mut Fields, quiet: Option<Self>) {
        let parts = quiet.map(|share| [share.fraction, share.low, share.high]);
        let names = ["quiet_fraction", "quiet_fraction_low", "quiet_fraction_high"];
        for (place, name) in names.into_iter().enumerate() {
            let unknown = || "the outcome of every start is unknown".to_owned();
            fields.known(
                name,
                Quantity::Ratio,
                parts.map(|parts| parts[place]).ok_or_else(unknown),
            );
        }
    }

    /// Half the distance between the bounds.
    pub fn error(self) -> f64 {
        0.5 * (self.high - self.low)
    }
}

/// Wilson's score interval.
fn wilson(fraction: f64, count: f64) -> RealInterval {
    let square = Z * Z / count;
    let centre = (fraction + 0.5 * square) / (1.0 + square);
    let reach =
        Z * (fraction * (1.0 - fraction) / count + 0.25 * square / count).sqrt() / (1.0 + square);
    // Both ends are exact where rounding of the root would miss them.
    let low = if fraction == 0.0 { 0.0 } else { (centre - reach).max(0.0) };
    let high = if fraction == 1.0 { 1.0 } else { (centre + reach).min(1.0) };
    RealInterval::new(low, high)
}

/// Number of starts inside with a neighbour outside, and of those outside with a neighbour inside.
fn border(inside: &[bool], columns: usize) -> (usize, usize) {
    let rows = inside.len() / columns.max(1);
    let mut counts = (0, 0);
    for (place, holds) in inside.iter().enumerate() {
        let (column, row) = (place % columns, place / columns);
        let mut neighbours = Vec::with_capacity(4);
        neighbours.extend((column > 0).then(|| place - 1));
        neighbours.extend((column + 1 < columns).then_some(place + 1));
        neighbours.extend((row > 0).then(|| place - columns));
        neighbours.extend((row + 1 < rows).then_some(place + columns));
        if neighbours.iter().any(|other| inside[*other] != *holds) {
            if *holds { counts.0 += 1 } else { counts.1 += 1 }
        }
    }
    counts
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wilson_has_its_known_values() {
        // 81 of 263 (Newcombe, 1998, table I): 0.2553 to 0.3662.
        let RealInterval { lower: low, upper: high } = wilson(81.0 / 263.0, 263.0);
        assert!((low - 0.2553).abs() < 5e-5 && (high - 0.3662).abs() < 5e-5, "{low} {high}");
        // None of 20: 0 to 0.1611.
        let RealInterval { lower: low, upper: high } = wilson(0.0, 20.0);
        assert!(low == 0.0 && (high - 0.1611).abs() < 5e-5, "{low} {high}");
    }

    #[test]
    fn a_grid_bounds_the_area_of_a_disc() {
        let (columns, radius) = (41_usize, 0.7);
        let place = |k: usize| -1.0 + k as f64 / 20.0;
        let inside: Vec<bool> = (0..columns * columns)
            .map(|k| place(k % columns).hypot(place(k / columns)) < radius)
            .collect();
        let share = Share::of(StartLayout::Grid { columns, rows: columns }, &inside);
        // Cells reach half a step beyond the window.
        let area = std::f64::consts::PI * radius * radius / (2.05 * 2.05);
        assert!(share.low < area && area < share.high, "{share:?} {area}");
        assert!(share.error() < 0.05, "{share:?}");
    }
}
