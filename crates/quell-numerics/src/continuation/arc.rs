//! One step along a one-dimensional set of solutions: N equations for N + 1 unknowns.
//!
//! Predictor: the tangent. Corrector: Newton's method on the hyperplane through the predicted point, orthogonal to the
//! direction of the step (Keller's pseudo-arclength), which is regular at folds. The equations are given by an
//! [`UnderdeterminedSystem`].

use crate::matrix::Matrix;

/// Mismatch below which the equations count as solved.
const SOLVED: f64 = 1e-12;

/// Mismatch that may remain because of rounding.
const NEARLY_SOLVED: f64 = 1e-9;

/// Maximum number of Newton corrections per step.
const MOST_CORRECTIONS: u32 = 12;

/// Largest accepted distance of the corrected point from the predicted one, as a fraction of the step.
pub(super) const NEAR: f64 = 0.1;

/// Distance within which the solutions on both sides of a border meet; further apart they belong to different branches.
pub(super) const MEETING: f64 = 1e-8;

/// Least cosine of the angle between successive tangents.
pub(super) const TURN: f64 = 0.9;

/// Increment of the finite difference with respect to a parameter; it only steers Newton's method.
pub(super) const NUDGE: f64 = 1e-6;

/// How far a state may move in that increment, over its scale: over a wide window the increment itself would lead over borders. A larger one
/// would lead over nearer ones; a much smaller one is no difference any more, as images have errors of 10⁻¹³.
pub(super) const FARTHEST_NUDGE: f64 = 1e-3;

/// Number of points before a curve may close.
const CLOSING: usize = 8;

/// Whether a curve with this number of points has returned to its start: closer than a fraction of the last step, in the same
/// direction. `here` and `begin` are each a point and its tangent.
pub(super) fn closes(
    points: usize,
    last_step: f64,
    here: (&[f64], &[f64]),
    begin: (&[f64], &[f64]),
) -> bool {
    points > CLOSING
        && distance(here.0, begin.0) < 0.6 * last_step
        && cosine(here.1, begin.1) > TURN
}

/// N equations for N + 1 unknowns, all scaled.
pub(super) trait UnderdeterminedSystem {
    /// Data computed along with the mismatch.
    type Known;
    /// The reason why there is no mismatch.
    type Error;

    /// Mismatch of the equations.
    fn mismatch(&self, unknowns: &[f64]) -> Result<(Vec<f64>, Self::Known), Self::Error>;

    /// Derivative of the mismatch, N × (N + 1). `before` is a derivative at a nearby point whose expensive parts may be
    /// reused; `heading` is the direction of the step, in which one-sided differences are taken.
    fn derivative(
        &self,
        unknowns: &[f64],
        known: &Self::Known,
        before: Option<&Matrix>,
        heading: &[f64],
    ) -> Result<Matrix, Self::Error>;
}

/// A solution.
#[derive(Clone, Debug)]
pub(super) struct Solved<K> {
    pub(super) unknowns: Vec<f64>,
    pub(super) residual: f64,
    pub(super) known: K,
    pub(super) derivative: Matrix,
}

fn product(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Distance between two points.
pub(super) fn distance(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt()
}

/// The vector scaled to length 1.
pub(super) fn normalised(mut vector: Vec<f64>) -> Vec<f64> {
    let length = product(&vector, &vector).sqrt();
    if length > 0.0 {
        for entry in &mut vector {
            *entry /= length;
        }
    }
    vector
}

/// Cosine of the angle between two unit vectors.
pub(super) fn cosine(a: &[f64], b: &[f64]) -> f64 {
    product(a, b)
}

/// The solution on the hyperplane through `predicted` orthogonal to `normal`; `None` if the corrections do not converge
/// or the mismatch does not exist at an iterate.
pub(super) fn corrected<S: UnderdeterminedSystem>(
    system: &S,
    predicted: &[f64],
    normal: &[f64],
    before: Option<&Matrix>,
) -> Option<Solved<S::Known>> {
    let mut unknowns = predicted.to_vec();
    let mut derivative: Option<Matrix> = None;
    let mut last = f64::INFINITY;
    for _ in 0..MOST_CORRECTIONS {
        let (mismatch, known) = system.mismatch(&unknowns).ok()?;
        let residual = super::shooting::largest(&mismatch);
        if !residual.is_finite() {
            return None;
        }
        let nearby = derivative.as_ref().or(before);
        let slope = system.derivative(&unknowns, &known, nearby, normal).ok()?;
        let off: Vec<f64> = unknowns.iter().zip(predicted).map(|(u, p)| u - p).collect();
        let aside = product(normal, &off);
        let solved = residual <= SOLVED || (residual <= NEARLY_SOLVED && residual > 0.5 * last);
        if solved && aside.abs() < 1e-9 {
            return Some(Solved { unknowns, residual, known, derivative: slope });
        }
        last = residual;
        let n = mismatch.len();
        let bordered = bordered(&slope, normal);
        let right = Matrix::from_fn(n + 1, 1, |i, _| if i < n { -mismatch[i] } else { -aside });
        let step = bordered.solve(&right).filter(Matrix::is_finite)?;
        for (entry, change) in unknowns.iter_mut().zip(step.as_slice()) {
            *entry += change;
        }
        derivative = Some(slope);
    }
    None
}

/// The unit tangent at a solution, oriented towards `heading`.
pub(super) fn tangent(derivative: &Matrix, heading: &[f64]) -> Option<Vec<f64>> {
    let n = derivative.rows();
    let right = Matrix::from_fn(n + 1, 1, |i, _| f64::from(u8::from(i == n)));
    let found = bordered(derivative, heading).solve(&right).filter(Matrix::is_finite)?;
    Some(normalised(found.as_slice().to_vec()))
}

fn bordered(derivative: &Matrix, row: &[f64]) -> Matrix {
    let n = derivative.rows();
    Matrix::from_fn(n + 1, n + 1, |i, j| if i < n { derivative[(i, j)] } else { row[j] })
}

/// The cubic Hermite interpolant of two points and their unit tangents, at the fraction `s` between them.
pub(super) fn between(a: (&[f64], &[f64]), b: (&[f64], &[f64]), s: f64) -> Vec<f64> {
    let length = distance(a.0, b.0);
    let (s2, s3) = (s * s, s * s * s);
    let (h00, h01) = (2.0 * s3 - 3.0 * s2 + 1.0, 3.0 * s2 - 2.0 * s3);
    let (h10, h11) = (length * (s3 - 2.0 * s2 + s), length * (s3 - s2));
    (0..a.0.len()).map(|k| h00 * a.0[k] + h01 * b.0[k] + h10 * a.1[k] + h11 * b.1[k]).collect()
}
