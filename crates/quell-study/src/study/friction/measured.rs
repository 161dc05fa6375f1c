//! The samples of a measured law.

use quell_model::friction::samples::Fit;

/// Samples and the law fitted to them, with the options of the fit, which show whether it is still current.
#[derive(Clone, Debug, PartialEq)]
pub struct Measured {
    /// Name of the file that holds the samples, if any, as the study gives it.
    pub file: Option<String>,
    /// Slip speed, in the study's unit, and coefficient.
    pub samples: Vec<(f64, f64)>,
    pub(super) static_coefficient: Option<f64>,
    pub(super) terms: Option<usize>,
    pub(super) fit: Fit,
}
