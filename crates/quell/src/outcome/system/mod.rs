//! Answers of a study of a system, one file per verb.

mod exact;
mod measured;
mod modes;
mod reach;
mod tracked;

use std::fmt::Write as _;

use quell_linear::spectrum::SmallMotion;

use quell_numerics::eigen::modulus;

use super::table::figure;
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
    let hertz = units != UnitSystem::None;
    let all: Vec<&SmallMotion> = all.collect();
    let heading = match (listed, hertz) {
        (ListedMotion::Damped, false) => "frequency |Im λ|",
        (ListedMotion::Natural, false) => "frequency |λ|",
        (ListedMotion::Damped, true) => "|Im λ|/2π in Hz",
        (ListedMotion::Natural, true) => "|λ|/2π in Hz",
    };
    let mut text = format!("  {heading:>16}");
    let rate = if hertz { "rate/(1/s)" } else { "growth rate" };
    let _ = writeln!(text, "  {rate:>14}  {:>14}", "damping ratio");
    for motion in all.iter().take(MOST_MOTIONS) {
        let frequency = match listed {
            ListedMotion::Damped => motion.frequency(),
            ListedMotion::Natural => modulus(motion.eigenvalue),
        };
        let frequency = if hertz { frequency / std::f64::consts::TAU } else { frequency };
        let (rate, ratio) = if motion.eigenvalue.re.abs() <= motion.error {
            (0.0, 0.0)
        } else {
            (motion.eigenvalue.re, motion.damping_ratio())
        };
        let _ = writeln!(
            text,
            "  {:>16}  {:>14}  {:>14}",
            figure(frequency),
            figure(rate),
            figure(ratio)
        );
    }
    if all.len() > MOST_MOTIONS {
        let _ = writeln!(text, "  … and {} more; --json lists all", all.len() - MOST_MOTIONS);
    }
    text
}
