//! What a map needs of a kind of study: its quantities, its axes, the cost of a point, and the computation.

use quell_model::units::Scales;

use super::evaluate::{Computation, Results};
use super::grid::Grid;
use super::quantity::MapQuantity;
use crate::study::Sweep;

/// What the numbers of the equations of a point are in the units of its study.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum PointScales {
    /// The same.
    Own,
    /// Those of a belt with mass and stiffness.
    Belt(Scales),
    /// Those of a disc whose ω_ref is this, in rad/s.
    Disc(f64),
}

/// Results at a point, with the scales of its study.
pub(super) type PointResults = (PointScales, Results);

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
