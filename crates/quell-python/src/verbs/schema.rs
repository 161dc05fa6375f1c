//! `schema`: the JSON Schema of a study file, and the lists with which classes and arguments are compared.

use pyo3::prelude::*;
use quell::needs::Needs;
use quell::schema::schema as front_door;
use quell::study::UnitSystem;
use quell::study::vocabulary::{self, DocumentKind};
use quell::sweep::QUANTITIES;

use crate::convert;

/// The JSON Schema of a study file, as a dict.
#[pyfunction]
pub(crate) fn schema(py: Python<'_>) -> PyResult<Py<PyAny>> {
    convert::to_python(py, &front_door())
}

/// A key of a study file: the kind of study, its table, its name, its unit and its description.
type KeyTuple = (&'static str, &'static str, &'static str, &'static str, &'static str);

/// Every key that takes a value in the study file of a belt and of a disc.
#[pyfunction]
pub(crate) fn keys() -> Vec<KeyTuple> {
    let of_kind = |kind: DocumentKind| {
        let own = vocabulary::keys().iter().filter(move |key| key.scope.includes(kind));
        let own = own.filter(|key| key.role.inner().is_none());
        own.map(move |key| {
            let unit = key.unit_in_words(kind, UnitSystem::None);
            (kind.section().path(), key.section.path(), key.name, unit, key.about)
        })
    };
    of_kind(DocumentKind::Belt).chain(of_kind(DocumentKind::Disc)).collect()
}

/// ("belt", "disc" or "system", name, description) of every quantity of a map; some are of one mass alone.
#[pyfunction]
pub(crate) fn quantities() -> Vec<(&'static str, &'static str, &'static str)> {
    let of_kind = |kind: &'static str| {
        let all = QUANTITIES.iter().copied().flatten();
        let its = all.filter(move |quantity| kind != "disc" || quantity.needs == Needs::SLIDING);
        its.map(move |quantity| (kind, quantity.name, quantity.about))
    };
    ["belt", "disc", "system"].into_iter().flat_map(of_kind).collect()
}
