//! Newton's method for a fixed point of a period map.
//!
//! x ← x − (M − 1)⁻¹(φ(x) − x). Convergence is quadratic where the image is smooth. Across borders of signatures the
//! derivative jumps and Newton's method may cycle: it then reports the best iterate. It may also converge to a fixed point
//! on another branch than intended: [`Shooting::reach`] limits the distance from the guess.

use std::fmt;

use super::{Image, PeriodMap};
use crate::matrix::Matrix;

/// Settings of the shooting method. Lengths are relative to [`PeriodMap::scale`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shooting {
    /// Maximum number of steps.
    pub most_steps: u32,
    /// Mismatch after a period below which the orbit counts as closed.
    pub closed: f64,
    /// Mismatch that rounding over a long period may leave: the orbit counts as closed if a step no longer halves it.
    pub nearly_closed: f64,
    /// Longest step: far from a fixed point, the linearisation may give an arbitrarily large step.
    pub longest_step: f64,
    /// Largest distance of the fixed point from the guess.
    pub reach: f64,
}

impl Default for Shooting {
    fn default() -> Self {
        Self {
            most_steps: 40,
            closed: 1e-12,
            nearly_closed: 1e-9,
            longest_step: 1.0,
            reach: f64::INFINITY,
        }
    }
}

/// A fixed point.
#[derive(Clone, Debug)]
pub struct FixedPoint<S> {
    /// The state.
    pub state: Vec<f64>,
    /// Largest entry of the mismatch after the period.
    pub residual: f64,
    /// Its image.
    pub image: Image<S>,
    /// Newton steps taken.
    pub steps: u32,
}

/// The reason why no fixed point was found, and the state at which the search stopped.
#[derive(Clone, Debug, PartialEq)]
pub enum NotClosed<E> {
    /// The maximum number of steps was reached.
    TooManySteps {
        /// Steps taken.
        steps: u32,
        /// Least mismatch found.
        residual: f64,
        /// The state with the least mismatch.
        at: Vec<f64>,
    },
    /// The derivative has a multiplier that equals 1 up to rounding, so that no step is defined.
    Singular {
        /// Steps taken.
        steps: u32,
        /// Mismatch there.
        residual: f64,
        /// The state.
        at: Vec<f64>,
    },
    /// A fixed point was found, but too far from the guess.
    Strayed {
        /// Steps taken.
        steps: u32,
        /// Largest entry of the difference from the guess.
        distance: f64,
        /// The fixed point.
        at: Vec<f64>,
    },
    /// An iterate has no image.
    NoImage {
        /// Steps taken.
        steps: u32,
        /// The state.
        at: Vec<f64>,
        /// The reason.
        why: E,
    },
}

impl<E: fmt::Display> fmt::Display for NotClosed<E> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::TooManySteps { steps, residual, at } => write!(
                f,
                "shooting stopped after {steps} steps with a mismatch of {residual:.1e} at {at:?}"
            ),
            Self::Singular { steps, residual, at } => write!(
                f,
                "shooting stopped after {steps} steps with a mismatch of {residual:.1e} at {at:?}: a multiplier is 1 there"
            ),
            Self::Strayed { steps, distance, at } => write!(
                f,
                "shooting found an orbit at {at:?} after {steps} steps, but {distance:.1e} from the guess, so it is another orbit"
            ),
            Self::NoImage { steps, at, why } => {
                write!(f, "shooting stopped after {steps} steps at {at:?}: {why}")
            }
        }
    }
}

/// Largest magnitude.
pub(super) fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |most, value| value.abs().max(most))
}

/// The fixed point near `guess` at given parameters, on the piece `held` if one is given.
///
/// # Errors
/// [`NotClosed`].
pub fn fixed_point<F: PeriodMap>(
    family: &F,
    guess: &[f64],
    parameters: &[f64],
    held: Option<&F::Signature>,
    shooting: &Shooting,
) -> Result<FixedPoint<F::Signature>, NotClosed<F::Error>> {
    let n = family.dimension();
    let scale = family.scale();
    let mut state = guess.to_vec();
    let mut best: Option<(f64, Vec<f64>)> = None;
    for steps in 0..shooting.most_steps {
        let image = family.image(&state, parameters, held).map_err(|why| NotClosed::NoImage {
            steps,
            at: state.clone(),
            why,
        })?;
        let mismatch: Vec<f64> =
            image.state.iter().zip(&state).map(|(to, from)| to - from).collect();
        let residual = largest(&mismatch);
        let least = best.as_ref().map_or(f64::INFINITY, |(least, _)| *least);
        let improves = residual < 0.5 * least;
        if residual <= shooting.closed * scale
            || (residual <= shooting.nearly_closed * scale && !improves)
        {
            let difference: Vec<f64> =
                state.iter().zip(guess).map(|(to, from)| to - from).collect();
            let distance = largest(&difference);
            if distance > shooting.reach * scale {
                return Err(NotClosed::Strayed { steps, distance, at: state });
            }
            return Ok(FixedPoint { state, residual, image, steps });
        }
        if residual < least {
            best = Some((residual, state.clone()));
        }
        let stopped = |state: Vec<f64>| NotClosed::Singular { steps, residual, at: state };
        let system =
            Matrix::from_fn(n, n, |i, j| image.derivative[(i, j)] - if i == j { 1.0 } else { 0.0 });
        let right = Matrix::from_fn(n, 1, |i, _| -mismatch[i]);
        let Some(step) = system.solve(&right).filter(Matrix::is_finite) else {
            return Err(stopped(state));
        };
        let share = (shooting.longest_step * scale / step.largest()).min(1.0);
        for (entry, change) in state.iter_mut().zip(step.as_slice()) {
            *entry += share * change;
        }
    }
    let (residual, at) = best.unwrap_or((f64::INFINITY, state));
    Err(NotClosed::TooManySteps { steps: shooting.most_steps, residual, at })
}
