//! The implementation of maps for each kind of study.

use super::belt::BeltPoints;
use super::disc::DiscPoints;
use super::grid::Grid;
use super::mapped::Mapped;
use super::system::SystemPoints;
use crate::complaint::Complaint;
use crate::study::{Kind, Study};

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

/// The implementation of maps for the kind of a study.
pub(crate) fn of(study: &Study) -> Box<dyn Mapped> {
    match study.kind() {
        Kind::Belt(setup) => Box::new(BeltPoints::of(study.narrowed(setup.as_ref()))),
        Kind::Disc(setup) => Box::new(DiscPoints::of(study.narrowed(setup.as_ref()))),
        Kind::System(setup) => Box::new(SystemPoints::of(study.narrowed(setup.as_ref()))),
    }
}
