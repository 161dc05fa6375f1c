//! What a map needs of a kind of study: its quantities, its axes, the cost of a point, and the computation.

use quell_model::units::Scales;

use super::belt::BeltPoints;
use super::disc::DiscPoints;
use super::evaluate::{Computation, Results};
use super::grid::Grid;
use super::quantity::Quantity;
use crate::study::{Kind, Study, Sweep};

/// What was computed at a point, with the scales of its study.
pub(super) type Point = (Option<Scales>, Results);

/// A kind of study as a map sees it.
pub(crate) trait Mapped: Send + Sync {
    /// What a map of this kind can show.
    fn quantities(&self) -> &'static [Quantity];

    /// The values of an axis.
    fn values(&self, sweep: &Sweep) -> Vec<f64> {
        sweep.axis.values().collect()
    }

    /// Seconds that one point takes, as an estimate.
    fn seconds(&self, wanted: &[Computation]) -> f64;

    /// Computes some points, by their index in the grid; `None` where the values together make no valid study.
    fn compute(&self, grid: &Grid, indices: &[usize], wanted: &[Computation])
    -> Vec<Option<Point>>;
}

/// The kind of a study as a map sees it.
pub(crate) fn of(study: &Study) -> Box<dyn Mapped> {
    match study.kind() {
        Kind::Belt(_) => Box::new(BeltPoints::of(study)),
        Kind::Disc(_) => Box::new(DiscPoints::of(study)),
    }
}
