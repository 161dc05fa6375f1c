//! One figure or table: its study file, and the function that computes it.

use std::fmt;

use super::product::Product;
use super::shared::SharedMeasurements;
use super::source::EntrySource;
use quell::complaint::Failure;

/// One figure or table of the dissertation.
#[derive(Clone, Copy)]
pub struct CatalogueEntry {
    /// Name on the command line: `2.3`, `claims`.
    pub name: &'static str,
    /// Its content in one line.
    pub about: &'static str,
    /// Text of its study file; empty for the table of claims, which has none.
    pub(super) study: &'static str,
    pub(super) make: fn(&EntrySource) -> Result<Product, Failure>,
}

/// Resolution of the grids of the figures.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Resolution {
    /// The resolution of the study files.
    #[default]
    Full,
    /// At most a few points along each axis of a map. Claims are still measured in full.
    Quick,
}

/// Largest number of points along an axis of a map at quick resolution.
const QUICK_POINTS: usize = 12;

impl CatalogueEntry {
    /// Computes the figure or table.
    ///
    /// # Errors
    /// [`Failure`] if a run stops or an average has no value.
    pub fn product(&self) -> Result<Product, Failure> {
        (self.make)(&self.source())
    }

    /// The same with at most `most_points` points along each axis of its sweeps.
    ///
    /// # Errors
    /// As [`CatalogueEntry::product`].
    pub fn coarse_product(&self, most_points: usize) -> Result<Product, Failure> {
        (self.make)(&EntrySource { most_points: Some(most_points), ..self.source() })
    }

    /// The product at this resolution, using the shared measurements of the run.
    pub(super) fn at(
        &self,
        resolution: Resolution,
        shared: &SharedMeasurements,
    ) -> Result<Product, Failure> {
        let most_points = match resolution {
            Resolution::Full => None,
            Resolution::Quick => Some(QUICK_POINTS),
        };
        (self.make)(&EntrySource { most_points, shared: shared.clone(), ..self.source() })
    }

    /// Its name and study file.
    pub fn source(&self) -> EntrySource {
        EntrySource {
            name: self.name,
            about: self.about,
            text: self.study,
            most_points: None,
            shared: SharedMeasurements::default(),
        }
    }

    /// Name of its files, without extension.
    pub fn stem(&self) -> String {
        match self.name.chars().next() {
            Some(first) if first.is_ascii_digit() => format!("figure-{}", self.name),
            _ => self.name.to_owned(),
        }
    }
}

impl fmt::Debug for CatalogueEntry {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("CatalogueEntry")
            .field("name", &self.name)
            .field("about", &self.about)
            .finish_non_exhaustive()
    }
}
