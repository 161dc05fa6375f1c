//! One figure or table: its study file, and the function that computes it.

use std::fmt;

use super::product::Product;
use super::shared::SharedMeasurements;
use super::source::EntrySource;
use quell::complaint::Failure;
use quell::picture::PicturePage;
use quell::study::Change;

/// One figure or table of the dissertation.
#[derive(Clone, Copy)]
pub struct CatalogueEntry {
    /// Name on the command line: `2.3`, `claims`.
    pub name: &'static str,
    /// Its content in one line.
    pub about: &'static str,
    /// Text of its study file; empty for the table of claims, which has none.
    pub(super) study: &'static str,
    /// Paths of which it has several values besides those of its axes.
    pub(super) families: &'static [&'static str],
    pub(super) make: fn(&EntrySource) -> Result<Product, Failure>,
}

/// Resolution of the grids of the figures.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Resolution {
    /// The resolution of the study files.
    #[default]
    Full,
    /// At most so many points along each axis of a map. Claims are still measured in full.
    AtMost(usize),
}

impl Resolution {
    /// That of `--quick`.
    pub const QUICK: Self = Self::AtMost(12);

    /// The largest number of points along an axis; `None` without a limit.
    pub(super) fn most_points(self) -> Option<usize> {
        match self {
            Self::Full => None,
            Self::AtMost(points) => Some(points),
        }
    }
}

/// Options of a reproduction.
#[derive(Clone, Debug, Default)]
pub struct ReproductionOptions {
    /// Resolution of the grids [default: full].
    pub resolution: Resolution,
    /// Width and parts of the pictures.
    pub page: PicturePage,
    /// Changes for numbers of one's own, as after `--set`; a list of values replaces a family of the figure [default: the numbers of
    /// the dissertation].
    pub changes: Vec<Change>,
}

impl CatalogueEntry {
    /// Computes the figure or table.
    ///
    /// # Errors
    /// [`Failure`] if a run stops or an average has no value.
    pub fn product(&self) -> Result<Product, Failure> {
        (self.make)(&self.source())
    }

    /// The product with these options, using the shared measurements of the run.
    pub(super) fn at(
        &self,
        options: &ReproductionOptions,
        shared: &SharedMeasurements,
    ) -> Result<Product, Failure> {
        let most_points = options.resolution.most_points();
        let source = self.source().with(&options.changes)?;
        (self.make)(&EntrySource { most_points, shared: shared.clone(), ..source })
    }

    /// Whether it has numbers that can be changed: the claims are of the dissertation's, and figure 5.6 sketches three rates.
    pub(super) fn has_numbers(&self) -> bool {
        !self.study.is_empty() && self.name != "5.6"
    }

    /// Its name and study file.
    pub fn source(&self) -> EntrySource {
        EntrySource {
            name: self.name,
            about: self.about,
            text: self.study,
            most_points: None,
            families: self.families,
            shared: SharedMeasurements::default(),
            own: Vec::new(),
            own_families: Vec::new(),
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
