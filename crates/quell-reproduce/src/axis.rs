//! Values of the axes of a study.

use quell::study::BeltStudy;

/// Values of the axis that varies `path`; empty where the study has no such axis.
pub(super) fn values(study: &BeltStudy, path: &str) -> Vec<f64> {
    study
        .sweeps()
        .iter()
        .find(|sweep| sweep.path == path)
        .map(|sweep| (0..sweep.axis.len()).map(|index| sweep.axis.value(index)).collect())
        .unwrap_or_default()
}
