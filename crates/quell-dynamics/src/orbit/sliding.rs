//! Steady sliding without dither: the verdict on it, and how a start on it is displaced.

use quell_linear::growth::Verdict;
use quell_linear::linearised::Linearised;
use quell_linear::spectrum;
use quell_model::System;

use super::{is_on_sliding, kicked_by};

/// Velocity of the displacement of a start on unstable steady sliding, over that of the surface: far above rounding, so that the
/// run leaves in time, and far below that of a limit cycle.
const NUDGE: f64 = 1e-4;

/// A start without dither. A run from unstable steady sliding would stay there until rounding displaces it: such a start is
/// displaced first, by 10⁻⁴ times the velocity of the surface.
pub fn displaced(system: &System, start: &[f64]) -> Vec<f64> {
    if !is_on_sliding(system, start) || sliding_verdict(system) == Ok(Verdict::Stable) {
        return start.to_vec();
    }
    kicked_by(system, NUDGE).unwrap_or_else(|| start.to_vec())
}

/// The verdict on steady sliding of a system without dither, by its small motions.
///
/// # Errors
/// Why it is unknown: there is no steady sliding, or its eigenvalues overflow.
pub fn sliding_verdict(system: &System) -> Result<Verdict, String> {
    let linear = Linearised::new(system).map_err(|why| why.to_string())?;
    let growth = spectrum::growth(&linear, &linear.friction()).map_err(|why| why.to_string())?;
    Ok(growth.verdict())
}
