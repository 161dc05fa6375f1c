//! What a map needs of a kind of study: its quantities, its axes, the cost of a point, and the computation.

use quell_model::units::Scales;

use super::evaluate::{Computation, Results};
use super::grid::Grid;
use super::quantity::MapQuantity;
use crate::study::Sweep;

/// Results at a point, with the scales of its study.
pub(super) type PointResults = (Option<Scales>, Results);

/// A kind of study that maps can compute.
pub(crate) trait Mapped: Send + Sync {
    /// The quantities of this kind.
    fn quantities(&self) -> &'static [MapQuantity];

    /// The values of an axis.
    fn values(&self, sweep: &Sweep) -> Vec<f64> {
        sweep.axis.values().collect()
    }

    /// Estimated seconds of one point.
    fn seconds(&self, wanted: &[Computation]) -> f64;

    /// Computes some points, by their index in the grid; `None` where the axis values do not form a valid study.
    fn compute(
        &self,
        grid: &Grid,
        indices: &[usize],
        wanted: &[Computation],
    ) -> Vec<Option<PointResults>>;
}
