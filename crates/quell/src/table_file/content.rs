//! What every format of tables says about a dataset.

use crate::dataset::Dataset;

/// Lengths of the axes of a dataset.
pub(super) fn shape(dataset: &Dataset) -> Vec<usize> {
    dataset.axes().iter().map(|axis| axis.values.len()).collect()
}

/// The line that names the program.
pub(super) fn program(verb: &str) -> String {
    format!("quell {} {verb}", env!("CARGO_PKG_VERSION"))
}
