//! `schema`: the JSON Schema of a study file, and the lists with which classes and arguments are compared.

use pyo3::prelude::*;
use quell::schema::schema as front_door;
use quell::study::UnitSystem;
use quell::study::vocabulary::{self, KeyScope};
use quell::sweep::QUANTITIES;

use crate::convert;

/// The JSON Schema of a study file, as a dict.
#[pyfunction]
pub(crate) fn schema(py: Python<'_>) -> PyResult<Py<PyAny>> {
    convert::to_python(py, &front_door())
}

/// (table, key, unit, description) of every key of the study file of a belt or a disc.
#[pyfunction]
pub(crate) fn keys() -> Vec<(&'static str, &'static str, &'static str, &'static str)> {
    let all = vocabulary::keys().iter();
    let all = all.filter(|key| key.role.inner().is_none() && key.scope != KeyScope::SYSTEM);
    all.map(|key| (key.section.path(), key.name, key.unit_in_words(UnitSystem::None), key.about))
        .collect()
}

/// ("belt", "disc" or "system", name, description) of every quantity of a map.
#[pyfunction]
pub(crate) fn quantities() -> Vec<(&'static str, &'static str, &'static str)> {
    let all = QUANTITIES.iter().copied().flatten();
    all.map(|quantity| (quantity.kind, quantity.name, quantity.about)).collect()
}
