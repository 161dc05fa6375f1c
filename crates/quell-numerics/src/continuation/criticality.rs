//! Whether the bifurcation of a fixed point is supercritical or subcritical, from the derivatives of the period map.
//!
//! The second and third derivatives are differences of the exact first one, central in the step, and the coefficients of
//! [`crate::normal_form`] are extrapolated to step zero (Richardson). The result is the extrapolated value that differs least from
//! the two before it, and its error follows from the larger of these differences. Only states whose signature is that of the fixed
//! point enter: across the border of a signature a map has no derivatives.

use std::fmt;

use num_complex::Complex64;

use super::threshold::BifurcationKind;
use super::{Image, PeriodMap};
use crate::eigen::Decomposition;
use crate::matrix::Matrix;
use crate::normal_form::{CriticalPair, DerivativesAlong, FormCoefficient, flip, neimark_sacker};
use crate::polar::modulus;

/// First step over the typical size of a state: large enough that halvings pass the step at which truncation and rounding balance. If
/// it leaves the region of the signature, the halvings return to it; a much smaller one would leave rounding alone.
pub(super) const FIRST_STEP: f64 = 0.05;

/// Halvings of the step, down to 10⁻⁶ of the size of a state: below it second differences of a derivative known to 10⁻¹² are noise. If
/// no step has the signature of the fixed point, the coefficient is unknown, with that reason.
const MOST_LEVELS: usize = 16;

/// Steps that are computed beyond the best one: rounding grows fourfold with each, so that a better one hardly follows. Fewer could
/// stop at a chance agreement, which the larger of two differences in the error makes rare.
const PATIENCE: usize = 3;

/// Error over the change between extrapolated values: half the step has four times the noise in its second differences.
const NOISE: f64 = 4.0;

/// Largest distance of a critical multiplier from the unit circle: thresholds are located far more closely. A multiplier farther off
/// is not that of the threshold, and the coefficient is unknown.
const ON_THE_CIRCLE: f64 = 1e-4;

/// Distance of λᵏ from 1, k = 1 … 4, below which a resonance is strong: the normal form divides by this distance, and at a hundredth its
/// validity is limited to a tiny neighbourhood. With a larger value more coefficients are withheld, with a smaller one some would
/// describe no vibration that can be observed.
const RESONANT: f64 = 1e-2;

/// Whether a vibration grows from zero beyond a threshold, or the motion jumps.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Criticality {
    /// The vibration beyond the threshold is stable, and its amplitude grows from zero.
    Supercritical,
    /// Before the threshold there is an unstable vibration; beyond it the motion jumps, and on the way back it follows later.
    Subcritical,
}

impl Criticality {
    /// Word in outputs.
    pub fn name(self) -> &'static str {
        match self {
            Self::Supercritical => "supercritical",
            Self::Subcritical => "subcritical",
        }
    }
}

/// The first Lyapunov coefficient, or its counterpart of a map: below zero the bifurcation is supercritical.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FirstLyapunov {
    /// The coefficient.
    pub value: f64,
    /// Estimate of its error.
    pub error: f64,
}

impl FirstLyapunov {
    /// What its sign says; `None` if it is zero within its error.
    pub fn criticality(&self) -> Option<Criticality> {
        if self.value < -self.error {
            Some(Criticality::Supercritical)
        } else if self.value > self.error {
            Some(Criticality::Subcritical)
        } else {
            None
        }
    }
}

/// Why there is no coefficient.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NoFirstLyapunov {
    /// The threshold is none of a smooth pair or of a multiplier −1.
    OtherKind,
    /// λᵏ is close to 1: the normal form has further resonant terms.
    StrongResonance {
        /// The order k, from 1 to 4.
        order: u32,
    },
    /// No multiplier is on the unit circle, or it is not simple.
    NotCritical,
    /// The critical vector does not move the coordinates in which it is measured.
    Unmeasured,
    /// Another eigenvalue is in resonance: a matrix of the normal form is singular.
    Singular,
    /// The equations are linear as long as no contact sticks or opens.
    Linear,
    /// Bristles of a contact move in the critical motion, whose nonlinear terms are not computed.
    Bristles,
    /// States next to the fixed point have no image or meet other events, however near.
    OtherEvents,
}

impl fmt::Display for NoFirstLyapunov {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::OtherKind => f.write_str(
                "criticality is defined for Hopf, Neimark–Sacker and flip bifurcations only",
            ),
            Self::StrongResonance { order } => write!(
                f,
                "strong resonance 1:{order}: power {order} of the multiplier is close to 1, and the coefficient alone does not \
                 decide"
            ),
            Self::NotCritical => {
                f.write_str("no simple eigenvalue is at the limit of stability at the computed value")
            }
            Self::Unmeasured => {
                f.write_str("the critical motion does not move any displacement of the study")
            }
            Self::Singular => f.write_str(
                "another eigenvalue is in resonance with the critical one, and the coefficient does not exist",
            ),
            Self::Bristles => f.write_str(
                "the nonlinear terms of bristles are not computed; a run from next to the threshold shows which side it is",
            ),
            Self::Linear => f.write_str(
                "the equations are linear until a contact sticks or opens, and nothing limits the vibration before that",
            ),
            Self::OtherEvents => f.write_str(
                "motions next to it meet other events, however near: the map has no second and third derivatives there",
            ),
        }
    }
}

impl std::error::Error for NoFirstLyapunov {}

/// The coefficient of a Neimark–Sacker or flip bifurcation of a fixed point of a map, with the critical vector of norm 1 in its
/// first `leading` numbers; per period.
///
/// # Errors
/// [`NoFirstLyapunov`].
pub fn first_lyapunov<F: PeriodMap>(
    map: &F,
    state: &[f64],
    parameters: &[f64],
    kind: BifurcationKind,
    leading: usize,
) -> Result<FirstLyapunov, NoFirstLyapunov> {
    let target = match kind {
        BifurcationKind::NeimarkSacker => None,
        BifurcationKind::Flip => Some(Complex64::new(-1.0, 0.0)),
        _ => return Err(NoFirstLyapunov::OtherKind),
    };
    let centre = map.image(state, parameters, None).map_err(|_| NoFirstLyapunov::OtherEvents)?;
    let pair = critical(&centre.derivative, target, leading)?;
    if target.is_none() {
        let mut power = pair.value / modulus(pair.value);
        for order in 1..=4 {
            if modulus(power - 1.0) < RESONANT {
                return Err(NoFirstLyapunov::StrongResonance { order });
            }
            power *= pair.value / modulus(pair.value);
        }
    }
    let stencil = Stencil { map, state, parameters, centre: &centre, pair: &pair };
    stencil.extrapolated(target.is_some())
}

/// The multiplier nearest to the target, or the one of a pair nearest to the unit circle.
pub(super) fn critical(
    derivative: &Matrix,
    target: Option<Complex64>,
    leading: usize,
) -> Result<CriticalPair, NoFirstLyapunov> {
    let decomposition = Decomposition::new(derivative).map_err(|_| NoFirstLyapunov::NotCritical)?;
    let distance = |z: Complex64| match target {
        Some(target) => modulus(z - target),
        None if z.im > 0.0 => (modulus(z) - 1.0).abs(),
        None => f64::INFINITY,
    };
    let values = decomposition.values().iter().map(|z| distance(*z)).enumerate();
    let (index, off) =
        values.min_by(|a, b| a.1.total_cmp(&b.1)).ok_or(NoFirstLyapunov::NotCritical)?;
    if off.is_nan() || off > ON_THE_CIRCLE {
        return Err(NoFirstLyapunov::NotCritical);
    }
    CriticalPair::new(&decomposition.pair(index), leading).ok_or(NoFirstLyapunov::Unmeasured)
}

/// A fixed point with its critical vector.
pub(super) struct Stencil<'a, F: PeriodMap> {
    pub(super) map: &'a F,
    pub(super) state: &'a [f64],
    pub(super) parameters: &'a [f64],
    pub(super) centre: &'a Image<F::Signature>,
    pub(super) pair: &'a CriticalPair,
}

impl<F: PeriodMap> Stencil<'_, F> {
    /// The derivative at the state moved by a vector, if the signature is the same there.
    fn derivative(&self, direction: &[f64], step: f64) -> Option<Matrix> {
        let moved: Vec<f64> =
            self.state.iter().zip(direction).map(|(x, d)| step.mul_add(*d, *x)).collect();
        let image = self.map.image(&moved, self.parameters, None).ok()?;
        let same = image.signature == self.centre.signature && image.derivative.is_finite();
        same.then_some(image.derivative)
    }

    /// First and second differences of the derivative along a real direction; zero along none.
    pub(super) fn differences(&self, direction: &[f64], step: f64) -> Option<[Matrix; 2]> {
        let n = direction.len();
        if direction.iter().all(|d| *d == 0.0) {
            return Some([Matrix::zeros(n, n), Matrix::zeros(n, n)]);
        }
        let (after, before) =
            (self.derivative(direction, step)?, self.derivative(direction, -step)?);
        let centre = &self.centre.derivative;
        let first = Matrix::from_fn(n, n, |i, j| (after[(i, j)] - before[(i, j)]) / (2.0 * step));
        let second = Matrix::from_fn(n, n, |i, j| {
            let bend = (after[(i, j)] - centre[(i, j)]) - (centre[(i, j)] - before[(i, j)]);
            bend / (step * step)
        });
        Some([first, second])
    }

    fn coefficient(&self, step: f64, is_flip: bool) -> Option<Result<FormCoefficient, ()>> {
        let part =
            |of: fn(&Complex64) -> f64| -> Vec<f64> { self.pair.right.iter().map(of).collect() };
        let [by_real, by_real_twice] = self.differences(&part(|z| z.re), step)?;
        let imaginary = if is_flip { vec![0.0; self.state.len()] } else { part(|z| z.im) };
        let [by_imaginary, by_imaginary_twice] = self.differences(&imaginary, step)?;
        let mut twice = by_real_twice;
        twice.add_scaled(1.0, &by_imaginary_twice);
        let forms = Differences { first: [by_real, by_imaginary], twice, q: &self.pair.right };
        let of = if is_flip { flip } else { neimark_sacker };
        Some(of(&self.centre.derivative, self.pair, &forms).ok_or(()))
    }

    fn extrapolated(&self, is_flip: bool) -> Result<FirstLyapunov, NoFirstLyapunov> {
        let largest = self.pair.right.iter().fold(0.0, |m: f64, z| m.max(modulus(*z)));
        let first = FIRST_STEP * self.map.scale() / largest;
        let (value, error) = extrapolated(first, |step| {
            let found = self.coefficient(step, is_flip)?;
            Some(found.map_err(|()| NoFirstLyapunov::Singular))
        })?;
        Ok(FirstLyapunov { value, error })
    }
}

/// A coefficient from differences with a step, extrapolated to step zero, and its error. `None` at a step whose states meet other
/// events.
pub(super) fn extrapolated(
    first: f64,
    coefficient: impl Fn(f64) -> Option<Result<FormCoefficient, NoFirstLyapunov>>,
) -> Result<(f64, f64), NoFirstLyapunov> {
    let mut step = first;
    // A row of the table, and its last entries in the rows so far.
    let mut before: Vec<f64> = Vec::new();
    let mut ends: Vec<f64> = Vec::new();
    let mut best: Option<(usize, (f64, f64))> = None;
    for level in 0..MOST_LEVELS {
        let found = coefficient(step);
        step *= 0.5;
        let Some(found) = found else {
            before.clear();
            ends.clear();
            continue;
        };
        let FormCoefficient { value, rounding } = found?;
        let mut row = vec![value];
        let mut power = 1.0;
        for (k, coarser) in before.iter().enumerate() {
            power *= 4.0;
            row.push(row[k] + (row[k] - coarser) / (power - 1.0));
        }
        let value = row[row.len() - 1];
        if let [.., earlier, last] = ends[..] {
            // Two steps, for one alone may be small by chance.
            let change = (value - last).abs().max((last - earlier).abs());
            let error = NOISE * change + rounding;
            if best.is_none_or(|(_, (_, known))| error < known) {
                best = Some((level, (value, error)));
            }
        }
        ends.push(value);
        before = row;
        if best.is_some_and(|(found, _)| level >= found + PATIENCE) {
            break;
        }
    }
    best.map(|(_, coefficient)| coefficient).ok_or(NoFirstLyapunov::OtherEvents)
}

/// Second and third derivatives by differences along the real and the imaginary part of q.
struct Differences<'a> {
    /// D_a A and D_b A for q = a + ib.
    first: [Matrix; 2],
    /// D_a D_a A + D_b D_b A.
    twice: Matrix,
    q: &'a [Complex64],
}

pub(super) fn image_of(matrix: &Matrix, vector: &[Complex64]) -> Vec<Complex64> {
    (0..matrix.rows())
        .map(|i| matrix.row(i).iter().zip(vector).map(|(a, z)| z * *a).sum())
        .collect()
}

impl DerivativesAlong for Differences<'_> {
    fn quadratic(&self, v: &[Complex64]) -> Vec<Complex64> {
        let [real, imaginary] = &self.first;
        let turn = Complex64::new(0.0, 1.0);
        let parts = image_of(real, v).into_iter().zip(image_of(imaginary, v));
        parts.map(|(a, b)| a + turn * b).collect()
    }

    // q q q̄ = (a a + b b)(a + ib) as symmetric products.
    fn cubic(&self) -> Vec<Complex64> {
        image_of(&self.twice, self.q)
    }
}
