//! The implementation of maps for each kind of study.

use super::belt::BeltPoints;
use super::disc::DiscPoints;
use super::evaluate::Computation;
use super::grid::Grid;
use super::mapped::{Mapped, PointResults};
use super::quantity::MapQuantity;
use crate::complaint::Complaint;
use crate::study::Study;

impl Grid {
    /// The grid of a study.
    ///
    /// # Errors
    /// A complaint if the study has no axis, two axes that set the same number, or too many points.
    pub fn of(study: impl Into<Study>) -> Result<Self, Box<Complaint>> {
        let study = study.into();
        let mapped = of(&study);
        Self::with_values(study, |sweep| mapped.values(sweep))
    }
}

/// A study of a kind that has no maps.
struct Unmapped;

impl Mapped for Unmapped {
    fn quantities(&self) -> &'static [MapQuantity] {
        &[]
    }

    fn seconds(&self, _: &[Computation]) -> f64 {
        0.0
    }

    fn compute(&self, _: &Grid, indices: &[usize], _: &[Computation]) -> Vec<Option<PointResults>> {
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
