//! Processing: a change of coordinates that makes the Strang map itself fourth-order accurate.
//!
//! The Strang map S is e^{εX} M e^{−εX} up to h⁴, with ε = h²/24, X = [A, B] + B′ at the start of the period and B = UΦVᵀ: it
//! has the correct exponents (see [`super::kick`]) in slightly wrong coordinates. M ≈ (1 + εX)⁻¹ S (1 + εX), with X of rank
//! 2r, costs O(n²r) and makes the maps of N and 2N steps agree to h⁴ instead of h², so that the eigenvectors of one can be used
//! for the other. A similarity transformation never changes the exponents.

use super::flow::ConstantFlow;
use super::steps::Phase;
use crate::dispatch::{Work, with_fused_multiply_add};
use crate::groups::{add_scaled, dot};
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
        // (1 + ε L R)⁻¹ = 1 − ε L (1 + ε R L)⁻¹ R.
        let outer = self.left.times(&inverse);
        with_fused_multiply_add(Similar { generator: self, outer, epsilon, map: &mut map });
        map
    }
}

/// The two updates of rank 2r of a map.
struct Similar<'a> {
    generator: &'a Generator,
    /// left · (1 + ε right · left)⁻¹.
    outer: Matrix,
    epsilon: f64,
    map: &'a mut Matrix,
}

impl Work for Similar<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self { generator: Generator { left, right, .. }, outer, epsilon, map } = self;
        let (n, rank) = (map.rows(), right.rows());
        // The columns of `left` as rows, so that every loop runs along rows.
        let columns = left.transpose();
        let mut factors = vec![0.0; rank];
        for i in 0..n {
            let row = map.row_mut(i);
            for (factor, column) in factors.iter_mut().zip(0..rank) {
                *factor = epsilon * dot(row, columns.row(column));
            }
            for (c, &factor) in factors.iter().enumerate() {
                add_scaled(row, factor, right.row(c));
            }
        }
        // right · map after the first update.
        let mut along = Matrix::zeros(rank, n);
        for i in 0..n {
            for c in 0..rank {
                add_scaled(along.row_mut(c), right[(c, i)], map.row(i));
            }
        }
        for i in 0..n {
            for c in 0..rank {
                add_scaled(map.row_mut(i), -epsilon * outer[(i, c)], along.row(c));
            }
        }
    }
}
