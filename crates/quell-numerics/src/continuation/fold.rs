//! On which side of a fold two fixed points exist, from the quadratic coefficient of its normal form.
//!
//! With A the derivative of the map, A q = q, pᵀA = pᵀ, ⟨p, q⟩ = 1, B its second derivative and φ_λ the derivative of the image with
//! respect to the parameter, the branch near the fold is
//!
//! ```text
//! x = x₀ + ξ q + O(ξ²),    λ = λ₀ + c ξ² + O(ξ³),    c = −½⟨p, B(q, q)⟩/⟨p, φ_λ⟩
//! ```
//!
//! (Kuznetsov, *Elements of Applied Bifurcation Theory*, 3rd ed. 2004, sec. 4.3 and 5.4.) Above zero it opens towards larger
//! parameters. The derivatives are extrapolated differences, as in [`super::criticality`].

use num_complex::Complex64;

use super::PeriodMap;
use super::criticality::{FIRST_STEP, NoFirstLyapunov, Stencil, critical, extrapolated, image_of};
use crate::normal_form::FormCoefficient;
use crate::polar::modulus;

/// The side of a fold on which two fixed points exist.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum FoldOpening {
    /// At larger values of the parameter.
    Larger,
    /// At smaller values.
    Smaller,
}

impl FoldOpening {
    /// Word in outputs.
    pub fn name(self) -> &'static str {
        match self {
            Self::Larger => "larger",
            Self::Smaller => "smaller",
        }
    }
}

/// The quadratic coefficient c of a fold: the parameter over the square of the amplitude along the critical vector.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FoldCoefficient {
    /// The coefficient.
    pub value: f64,
    /// Estimate of its error.
    pub error: f64,
}

impl FoldCoefficient {
    /// What its sign says; `None` if it is zero within its error, as at a cusp.
    pub fn opening(&self) -> Option<FoldOpening> {
        if self.value > self.error {
            Some(FoldOpening::Larger)
        } else if self.value < -self.error {
            Some(FoldOpening::Smaller)
        } else {
            None
        }
    }
}

/// The coefficient of a fold of fixed points in the parameter at `place`, whose typical change is `width`, with the critical vector of
/// norm 1 in the first `leading` numbers.
///
/// # Errors
/// [`NoFirstLyapunov`]; [`NoFirstLyapunov::Singular`] where the parameter does not move the branch, as at a branching.
pub fn fold_coefficient<F: PeriodMap>(
    map: &F,
    state: &[f64],
    parameters: &[f64],
    (place, width): (usize, f64),
    leading: usize,
) -> Result<FoldCoefficient, NoFirstLyapunov> {
    let centre = map.image(state, parameters, None).map_err(|_| NoFirstLyapunov::OtherEvents)?;
    let pair = critical(&centre.derivative, Some(Complex64::new(1.0, 0.0)), leading)?;
    let stencil = Stencil { map, state, parameters, centre: &centre, pair: &pair };
    let largest = pair.right.iter().fold(0.0, |m: f64, z| m.max(modulus(*z)));
    let right: Vec<f64> = pair.right.iter().map(|z| z.re).collect();
    let along = |vector: &[f64]| -> (f64, f64) {
        let terms = || pair.left.iter().zip(vector).map(|(p, x)| p.re * x);
        (terms().sum(), terms().map(f64::abs).sum())
    };
    let moved = |change: f64| -> Option<Vec<f64>> {
        let mut others = parameters.to_vec();
        others[place] += change;
        let image = map.image(state, &others, None).ok()?;
        (image.signature == centre.signature).then_some(image.state)
    };
    let (value, error) = extrapolated(FIRST_STEP, |step| {
        let [bend, _] = stencil.differences(&right, step * map.scale() / largest)?;
        let bent: Vec<f64> = image_of(&bend, &pair.right).iter().map(|z| z.re).collect();
        let (after, before) = (moved(step * width)?, moved(-step * width)?);
        let pushed = after.iter().zip(&before).map(|(a, b)| (a - b) / (2.0 * step * width));
        let (push, size_of_push) = along(&pushed.collect::<Vec<_>>());
        let (curvature, size) = along(&bent);
        let noise = right.len() as f64 * f64::EPSILON * pair.condition;
        if push.abs() <= noise * size_of_push {
            return Some(Err(NoFirstLyapunov::Singular));
        }
        let value = -0.5 * curvature / push;
        let rounding = noise * (0.5 * size / push.abs() + value.abs() * size_of_push / push.abs());
        Some(Ok(FormCoefficient { value, rounding }))
    })?;
    Ok(FoldCoefficient { value, error })
}
