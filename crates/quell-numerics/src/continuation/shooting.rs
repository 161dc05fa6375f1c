//! Newton's method for a fixed point of a period map.
//!
//! x ← x − (M − 1)⁻¹(φ(x) − x). Quadratic where the image is smooth. Across borders of signatures the derivative jumps and
//! Newton's method may cycle: it then ends with the best place it met. It may also close perfectly on
//! another branch than the one that was meant: [`Shooting::reach`] bounds how far from the guess it may go.

use std::fmt;

use super::{Image, PeriodMap};
use crate::matrix::Matrix;

/// How a fixed point is looked for. Lengths are relative to [`PeriodMap::scale`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shooting {
    /// Most steps.
    pub most_steps: u32,
    /// Mismatch after a period that counts as closed.
    pub closed: f64,
    /// Mismatch that rounding of a long period may leave: counts as closed where a step no longer halves it.
    pub nearly_closed: f64,
    /// Longest step: far from a fixed point the first order may send the state anywhere.
    pub longest_step: f64,
    /// How far from the guess a fixed point may lie.
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

/// Why no fixed point was found, and where the search stopped.
#[derive(Clone, Debug, PartialEq)]
pub enum NotClosed<E> {
    /// The steps were used up.
    TooManySteps {
        /// Steps taken.
        steps: u32,
        /// Least mismatch met.
        residual: f64,
        /// Where that was.
        at: Vec<f64>,
    },
    /// The derivative has the multiplier 1 to rounding: no step is defined.
    Singular {
        /// Steps taken.
        steps: u32,
        /// Mismatch there.
        residual: f64,
        /// Where.
        at: Vec<f64>,
    },
    /// A fixed point was found, but too far from the guess to be meant by it.
    Strayed {
        /// Steps taken.
        steps: u32,
        /// Largest entry of the way from the guess.
        distance: f64,
        /// Where it is.
        at: Vec<f64>,
    },
    /// There is no image at a place on the way.
    NoImage {
        /// Steps taken.
        steps: u32,
        /// Where.
        at: Vec<f64>,
        /// Why.
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
                "shooting found an orbit at {at:?} after {steps} steps, but {distance:.1e} from the guess: another one"
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

/// The fixed point near `guess` at given parameters, on the piece `held` where one is held.
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
            let way: Vec<f64> = state.iter().zip(guess).map(|(to, from)| to - from).collect();
            let distance = largest(&way);
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
