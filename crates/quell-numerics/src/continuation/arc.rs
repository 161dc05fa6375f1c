//! One step along a one-dimensional set of solutions: N equations for N + 1 unknowns.
//!
//! Predictor: the tangent. Corrector: Newton's method on the hyperplane through the predicted point, orthogonal to the way
//! (Keller's pseudo-arclength), which passes folds without noticing. What the equations are is told by a [`UnderdeterminedSystem`].

use crate::matrix::Matrix;

/// Mismatch that counts as solved.
const SOLVED: f64 = 1e-12;

/// Mismatch that rounding may leave.
const NEARLY_SOLVED: f64 = 1e-9;

/// Corrections of one step.
const MOST_CORRECTIONS: u32 = 12;

/// A corrected point off the predicted one by more than this share of the step is not believed.
pub(super) const NEAR: f64 = 0.1;

/// Least cosine of the turn of a step.
pub(super) const TURN: f64 = 0.9;

/// Difference by which the derivative by a parameter is taken: it steers Newton's method only.
pub(super) const NUDGE: f64 = 1e-6;

/// Points before a way may close.
const CLOSING: usize = 8;

/// The value at a share of a window; its ends exactly.
pub(super) fn value((from, to): (f64, f64), share: f64) -> f64 {
    if share == 1.0 { to } else { (to - from).mul_add(share, from) }
}

/// Whether a way of so many points is back where it began: nearer than a part of the last step, in the same direction. Each
/// of the two is a point and its tangent.
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
    /// What is known beside the mismatch.
    type Known;
    /// Why there is none.
    type Error;

    /// Mismatch of the equations.
    fn mismatch(&self, unknowns: &[f64]) -> Result<(Vec<f64>, Self::Known), Self::Error>;

    /// Derivative of the mismatch, N × (N + 1). `before` is one from nearby whose expensive parts may be kept; `way`
    /// is where the step goes, the side to which one-sided differences are taken.
    fn derivative(
        &self,
        unknowns: &[f64],
        known: &Self::Known,
        before: Option<&Matrix>,
        way: &[f64],
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

/// Distance of two points.
pub(super) fn distance(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt()
}

/// The vector of length 1 in a direction.
pub(super) fn direction(mut vector: Vec<f64>) -> Vec<f64> {
    let length = product(&vector, &vector).sqrt();
    if length > 0.0 {
        for entry in &mut vector {
            *entry /= length;
        }
    }
    vector
}

/// Cosine of the angle of two directions.
pub(super) fn cosine(a: &[f64], b: &[f64]) -> f64 {
    product(a, b)
}

/// The solution on the hyperplane through `predicted` orthogonal to `normal`; `None` where corrections do not come to an
/// end, or the equations have no mismatch on the way.
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

/// The tangent at a solution, towards `way`.
pub(super) fn tangent(derivative: &Matrix, way: &[f64]) -> Option<Vec<f64>> {
    let n = derivative.rows();
    let right = Matrix::from_fn(n + 1, 1, |i, _| f64::from(u8::from(i == n)));
    let found = bordered(derivative, way).solve(&right).filter(Matrix::is_finite)?;
    Some(direction(found.as_slice().to_vec()))
}

fn bordered(derivative: &Matrix, row: &[f64]) -> Matrix {
    let n = derivative.rows();
    Matrix::from_fn(n + 1, n + 1, |i, j| if i < n { derivative[(i, j)] } else { row[j] })
}

/// The cubic through two points with their tangents, at the share `s` of the way; tangents have length 1.
pub(super) fn between(a: (&[f64], &[f64]), b: (&[f64], &[f64]), s: f64) -> Vec<f64> {
    let length = distance(a.0, b.0);
    let (s2, s3) = (s * s, s * s * s);
    let (h00, h01) = (2.0 * s3 - 3.0 * s2 + 1.0, 3.0 * s2 - 2.0 * s3);
    let (h10, h11) = (length * (s3 - 2.0 * s2 + s), length * (s3 - s2));
    (0..a.0.len()).map(|k| h00 * a.0[k] + h01 * b.0[k] + h10 * a.1[k] + h11 * b.1[k]).collect()
}
