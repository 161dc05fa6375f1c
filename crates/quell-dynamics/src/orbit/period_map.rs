//! The period map of a belt: one period integrated with its derivative, and the multipliers.

use quell_model::Belt;
use quell_numerics::matrix::Matrix;

use super::no_orbit::NoOrbit;
use super::variation::{Matrix2, Variation};
use crate::simulation::{FinalState, Start, simulate};

/// Bound on the last retained Taylor terms of a step while shooting, relative to F.
pub(super) const TOLERANCE: f64 = 1e-14;

/// Integrates one period: its final state, and the variational matrix along it.
pub(super) fn shoot(
    belt: &Belt,
    start: Start,
    period: f64,
) -> Result<(FinalState, Variation<'_>), NoOrbit> {
    let mut variation = Variation::new(belt);
    let until = start.time + period;
    let end = simulate(belt, start, until, TOLERANCE, &mut variation).map_err(NoOrbit::Stalled)?;
    Ok((end, variation))
}

/// Modulus of the deciding multiplier. A free orbit has a multiplier 1 along it; the other one is the determinant, in pure
/// slip e^−`damping`: the eigenvalues themselves are ill-conditioned where both are near 1.
pub(super) fn deciding(multipliers: [(f64, f64); 2], is_free: bool, damping: Option<f64>) -> f64 {
    let distance_from_one = |(re, im): (f64, f64)| libm::hypot(re - 1.0, im);
    let [larger, smaller] = multipliers;
    match damping {
        Some(damping) if is_free => libm::exp(-damping),
        _ if is_free && distance_from_one(smaller) > distance_from_one(larger) => {
            libm::hypot(smaller.0, smaller.1)
        }
        _ => libm::hypot(larger.0, larger.1),
    }
}

/// [`deciding`] for a run of one period.
pub(super) fn radius_of(variation: &Variation<'_>, is_free: bool) -> f64 {
    let is_pure_slip = variation.events.is_empty() && variation.stuck == 0.0;
    deciding(multipliers_of(&variation.matrix), is_free, is_pure_slip.then_some(variation.damping))
}

/// Multipliers of a period map, the larger modulus first.
pub(crate) fn multipliers_of(matrix: &Matrix2) -> [(f64, f64); 2] {
    let found = quell_numerics::continuation::multipliers(&dense(matrix));
    let both = found.filter(|found| found.len() == 2).map(|found| [found[0], found[1]]);
    // A matrix that is not finite has no eigenvalues; a completed run has a finite one.
    both.map_or([(f64::INFINITY, 0.0); 2], |both| both.map(|value| (value.re, value.im)))
}

/// The matrix as continuation takes it.
pub(super) fn dense(matrix: &Matrix2) -> Matrix {
    Matrix::from_fn(2, 2, |i, j| matrix[i][j])
}
