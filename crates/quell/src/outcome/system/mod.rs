//! Answers of a study of a system, one file per verb.

mod exact;
mod measured;
mod modes;
mod reach;
mod receptance;
mod tracked;

use std::fmt::Write as _;

use quell_linear::spectrum::SmallMotion;

use quell_numerics::polar::modulus;

use super::table::{NumberColumns, figure, frequency_heading, rate_heading};
use crate::study::UnitSystem;

/// Motions that a table lists.
const MOST_MOTIONS: usize = 12;

/// The width of a column of values with a unit, two spaces after the longest.
pub(super) fn width_of(values: impl Iterator<Item = f64>, unit: &str) -> usize {
    let widths = values.map(|value| figure(value).chars().count() + unit.chars().count() + 2);
    widths.fold(16, usize::max)
}

/// The frequency of a motion that a table lists.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ListedMotion {
    /// |Im λ|, with the damping that the motion has.
    Damped,
    /// |λ|, the frequency of the motion without its damping.
    Natural,
}

/// Small motions as text, the first [`MOST_MOTIONS`] of them. Rates that are zero within their error are printed as 0.
pub(super) fn motions<'a>(
    units: UnitSystem,
    listed: ListedMotion,
    all: impl Iterator<Item = &'a SmallMotion>,
) -> String {
    let all: Vec<&SmallMotion> = all.collect();
    let (frequency, factor) = frequency_heading(units);
    let frequency = match listed {
        ListedMotion::Damped => frequency.to_owned(),
        ListedMotion::Natural => format!("natural {frequency}"),
    };
    let headings = [frequency, rate_heading(units), "damping ratio".to_owned()];
    let (columns, mut text) = NumberColumns::under(&headings);
    text.push('\n');
    for motion in all.iter().take(MOST_MOTIONS) {
        let frequency = match listed {
            ListedMotion::Damped => motion.frequency(),
            ListedMotion::Natural => modulus(motion.eigenvalue),
        };
        let (rate, ratio) = if motion.eigenvalue.re.abs() <= motion.error {
            (0.0, 0.0)
        } else {
            (motion.eigenvalue.re, motion.damping_ratio())
        };
        text += &columns.line(&[frequency * factor, rate, ratio].map(figure));
        text.push('\n');
    }
    if all.len() > MOST_MOTIONS {
        let _ = writeln!(text, "  … and {} more; --json lists all", all.len() - MOST_MOTIONS);
    }
    text
}
