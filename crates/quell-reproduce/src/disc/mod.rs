//! Chapter 5: tables 5.1 and 5.2, figures 5.2 to 5.15.
//!
//! The dissertation does not specify the outer radius, the true b/a and r₀/a, and the unit of its f axis. b/a = 0.5 gives all
//! thirteen printed speeds. r₀/a = 0.75 and ρha² = 1 (m*, c*, k* = 0.4244 × printed), with the printed f equal to 10⁻⁴ of the
//! consistent value (f* = 4244 × printed), fit the statements of the text. These values were fitted, not read; every caption says
//! so.

mod growth;
pub(super) mod map;
mod modes;
mod responses;
mod tables;
mod zero_lines;

pub(super) use map::{figure as maps, sizes};
pub(super) use modes::figure as modes;
pub(super) use responses::figure as responses;
pub(super) use tables::{PRINTED_INDUCED, PRINTED_UNDITHERED, induced, undithered};

use std::path::Path;

use super::source::EntrySource;
use quell::complaint::Failure;
use quell::study::DiscStudy;

/// Ratio of f* to the printed f.
pub(super) const FRICTION_PER_PRINTED: f64 = 1e4 * STRENGTH_PER_PRINTED;

/// Ratio of m*, c*, k* to the printed values: 1/(π(1 − (b/a)²)) with b/a = 0.5.
pub(super) const STRENGTH_PER_PRINTED: f64 = 1.0 / (0.75 * std::f64::consts::PI);

/// The study of an entry.
///
/// # Errors
/// Complaints about the study file; a test checks that it has no fault.
pub(super) fn study(source: &EntrySource, changes: &[&str]) -> Result<DiscStudy, Failure> {
    let mut changes = source.changes(changes)?;
    let folder = Path::new("");
    if source.most_points.is_some() {
        let fine = DiscStudy::parse_in(source.text, &changes, folder)?;
        changes.extend(source.coarser(fine.sweeps())?);
    }
    Ok(DiscStudy::parse_in(source.text, &changes, folder)?)
}

/// Sentence about the unspecified parameters in every caption of the dissertation's own numbers.
pub(super) const OPEN: &str = "Not specified in the dissertation and fitted to its text: $b$/$a$ = 0.5, $r_0$/$a$ = 0.75, \
     $ρha^2$ = 1 (m*, c*, k* = 0.4244 × printed), and the printed $f$ equal to 10⁻⁴ of the consistent value.";
