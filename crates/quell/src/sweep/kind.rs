//! The interface of a kind of study to maps: its quantities, its axes, the cost of a point, and the computation.

use quell_model::units::Scales;

use super::belt::BeltPoints;
use super::disc::DiscPoints;
use super::evaluate::{Computation, Results};
use super::grid::Grid;
use super::quantity::Quantity;
use crate::study::{Study, Sweep};

/// Results at a point, with the scales of its study.
pub(super) type Point = (Option<Scales>, Results);

/// A kind of study that maps can compute.
pub(crate) trait Mapped: Send + Sync {
    /// The quantities of this kind.
    fn quantities(&self) -> &'static [Quantity];

    /// The values of an axis.
    fn values(&self, sweep: &Sweep) -> Vec<f64> {
        sweep.axis.values().collect()
    }

    /// Estimated seconds of one point.
    fn seconds(&self, wanted: &[Computation]) -> f64;

    /// Computes some points, by their index in the grid; `None` where the axis values do not form a valid study.
    fn compute(&self, grid: &Grid, indices: &[usize], wanted: &[Computation])
    -> Vec<Option<Point>>;
}

/// A study of a kind that has no maps.
struct Unmapped;

impl Mapped for Unmapped {
    fn quantities(&self) -> &'static [Quantity] {
        &[]
    }

    fn seconds(&self, _: &[Computation]) -> f64 {
        0.0
    }

    fn compute(&self, _: &Grid, indices: &[usize], _: &[Computation]) -> Vec<Option<Point>> {
        indices.iter().map(|_| None).collect()
    }
}

/// The implementation of maps for the kind of a study.
pub(crate) fn of(study: &Study) -> Box<dyn Mapped> {
    match (study.belt(), study.disc()) {
        (Ok(study), _) => Box::new(BeltPoints::of(study)),
        (_, Ok(study)) => Box::new(DiscPoints::of(study)),
        _ => Box::new(Unmapped),
    }
}
