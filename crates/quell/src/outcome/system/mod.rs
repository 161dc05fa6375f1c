//! Answers of a study of a system, one file per verb.

mod exact;
mod modes;
mod reach;
mod stability;
mod tracked;

use std::fmt::Write as _;

use quell_linear::spectrum::SmallMotion;

use super::table::figure;
use crate::study::SystemUnits;

/// Motions that a table lists.
const MOST_MOTIONS: usize = 12;

/// Small motions as text, the first [`MOST_MOTIONS`] of them.
fn motions<'a>(units: SystemUnits, all: impl Iterator<Item = &'a SmallMotion>) -> String {
    let hertz = units != SystemUnits::None;
    let all: Vec<&SmallMotion> = all.collect();
    let mut text = format!("  {:>14}", if hertz { "frequency/Hz" } else { "frequency" });
    let _ = writeln!(text, "  {:>14}  {:>14}", "growth rate", "damping ratio");
    for motion in all.iter().take(MOST_MOTIONS) {
        let frequency = motion.frequency();
        let frequency = if hertz { frequency / std::f64::consts::TAU } else { frequency };
        let (rate, ratio) = (motion.eigenvalue.re, motion.damping_ratio());
        let _ = writeln!(
            text,
            "  {:>14}  {:>14}  {:>14}",
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
