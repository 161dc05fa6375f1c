//! Reference numbers with which `python -m quell.selftest` compares an installation.

use pyo3::prelude::*;

/// Files of `reference/`, which also documents their origin.
const FILES: &[(&str, &str)] = &[
    ("averaging", include_str!("../../../reference/averaging.json")),
    ("trajectories", include_str!("../../../reference/trajectories.json")),
    ("quench_thresholds", include_str!("../../../reference/quench_thresholds.json")),
    ("disc_eigenvalues", include_str!("../../../reference/disc_eigenvalues.json")),
    ("disc_floquet", include_str!("../../../reference/disc_floquet.json")),
    ("disc_modes", include_str!("../../../reference/disc_modes.json")),
];

/// A unit in the notation of unit packages such as pint, and the scale of the numbers.
#[pyfunction]
pub(crate) fn readable_unit(unit: &str) -> (String, String) {
    quell::dataset::readable(unit)
}

/// The text of a reference file; `None` if no file has that name.
#[pyfunction]
pub(crate) fn reference(name: &str) -> Option<&'static str> {
    FILES.iter().find(|(file, _)| *file == name).map(|(_, text)| *text)
}
