//! The samples of a measured law.

use std::path::PathBuf;

use quell_model::friction::samples::Fit;

/// Samples and the law fitted to them, with the options of the fit, which show whether it is still current.
#[derive(Clone, Debug, PartialEq)]
pub struct Measured {
    /// The file that holds the samples, if any.
    pub file: Option<PathBuf>,
    /// Slip speed, in the study's unit, and coefficient.
    pub samples: Vec<(f64, f64)>,
    pub(super) static_coefficient: Option<f64>,
    pub(super) terms: Option<usize>,
    pub(super) fit: Fit,
}

impl Measured {
    /// The setting that determines the law, with enough digits to read back the same numbers.
    pub(in crate::study) fn settings(&self) -> (String, String) {
        ("friction.fit".to_owned(), self.fit.formula())
    }
}
