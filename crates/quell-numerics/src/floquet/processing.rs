//! Processing: a change of coordinates that makes the Strang map itself fourth-order accurate.
//!
//! The Strang map S is e^{εX} M e^{−εX} up to h⁴, with ε = h²/24, X = [A, B] + B′ at the start of the period and B = UΦVᵀ: it
//! has the correct exponents (see [`super::kick`]) in slightly wrong coordinates. M ≈ (1 + εX)⁻¹ S (1 + εX), with X of rank
//! 2r, costs O(n²r) and makes the maps of N and 2N steps agree to h⁴ instead of h², so that the eigenvectors of one can be used
//! for the other. A similarity transformation never changes the exponents.

use super::flow::ConstantFlow;
use super::steps::Phase;
use crate::matrix::Matrix;

/// Increment, in periods, of the finite difference for Φ′(0). Its accuracy affects the agreement of the vectors, but not the
/// exponents.
const DIFFERENCE: f64 = 1e-3;

/// X = left · right at the start of the period.
pub(super) struct Generator {
    left: Matrix,
    right: Matrix,
    /// right · left.
    inner: Matrix,
}

impl Generator {
    pub(super) fn new(flow: &ConstantFlow, period: f64, phi: &dyn Fn(Phase, &mut Matrix)) -> Self {
        let (n, r) = (flow.size, flow.rank);
        let mut start = Matrix::zeros(r, r);
        phi(Phase::new(0.0), &mut start);
        let (mut before, mut after) = (start.clone(), start.clone());
        phi(Phase::new(-DIFFERENCE), &mut before);
        phi(Phase::new(DIFFERENCE), &mut after);
        after.add_scaled(-1.0, &before);
        let mut slope = Matrix::zeros(r, r);
        slope.add_scaled(1.0 / (2.0 * DIFFERENCE * period), &after);
        // [A, UΦVᵀ] + UΦ′Vᵀ = AU (ΦVᵀ) + U (Φ′Vᵀ − ΦVᵀA).
        let along = start.times(&flow.v);
        let mut rest = slope.times(&flow.v);
        rest.add_scaled(-1.0, &start.times(&flow.va));
        let left =
            Matrix::from_fn(
                n,
                2 * r,
                |i, j| {
                    if j < r { flow.au[(i, j)] } else { flow.u[(i, j - r)] }
                },
            );
        let right =
            Matrix::from_fn(2 * r, n, |i, j| if i < r { along[(i, j)] } else { rest[(i - r, j)] });
        let inner = right.times(&left);
        Self { left, right, inner }
    }

    /// (1 + εX)⁻¹ S (1 + εX) for a map with steps h; S itself if 1 + εX cannot be inverted.
    pub(super) fn process(&self, mut map: Matrix, step: f64) -> Matrix {
        let epsilon = step * step / 24.0;
        let mut small = Matrix::identity(self.inner.rows());
        small.add_scaled(epsilon, &self.inner);
        let Some(inverse) = small.solve(&Matrix::identity(self.inner.rows())) else { return map };
        map.add_scaled(epsilon, &map.times(&self.left).times(&self.right));
        map.add_scaled(-epsilon, &self.left.times(&inverse.times(&self.right.times(&map))));
        map
    }
}
