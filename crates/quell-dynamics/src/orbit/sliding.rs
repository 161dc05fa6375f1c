//! Steady sliding without dither: the verdict on it, and how a start on it is displaced.

use std::fmt;

use quell_linear::growth::Verdict;
use quell_linear::linearised::Linearised;
use quell_linear::spectrum;
use quell_linear::steady::NoSteadySliding;
use quell_model::System;
use quell_numerics::eigen::EigenError;

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

/// Why the verdict on steady sliding is unknown.
#[derive(Clone, Debug, PartialEq)]
pub enum NoSlidingVerdict {
    /// There is no steady sliding.
    NoSliding(NoSteadySliding),
    /// The eigenvalues of its small motions are unknown.
    Eigenvalues(EigenError),
}

impl fmt::Display for NoSlidingVerdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoSliding(why) => why.fmt(f),
            Self::Eigenvalues(why) => why.fmt(f),
        }
    }
}

impl std::error::Error for NoSlidingVerdict {}

/// The verdict on steady sliding of a system without dither, by its small motions.
///
/// # Errors
/// [`NoSlidingVerdict`].
pub fn sliding_verdict(system: &System) -> Result<Verdict, NoSlidingVerdict> {
    let linear = Linearised::new(system).map_err(NoSlidingVerdict::NoSliding)?;
    let growth = spectrum::growth(&linear, &linear.friction());
    Ok(growth.map_err(NoSlidingVerdict::Eigenvalues)?.verdict())
}
