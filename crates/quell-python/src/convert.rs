//! Conversion of JSON and datasets to Python objects.

use numpy::IntoPyArray;
use pyo3::IntoPyObjectExt;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use quell::dataset::{Array, Dataset};
use serde_json::Value as Json;

/// JSON as dicts, lists, numbers and strings.
pub(crate) fn to_python(py: Python<'_>, json: &Json) -> PyResult<Py<PyAny>> {
    match json {
        Json::Null => Ok(py.None()),
        Json::Bool(flag) => flag.into_py_any(py),
        Json::Number(number) => match number.as_i64() {
            Some(whole) => whole.into_py_any(py),
            None => number.as_f64().into_py_any(py),
        },
        Json::String(text) => text.into_py_any(py),
        Json::Array(list) => {
            let items: Vec<Py<PyAny>> =
                list.iter().map(|item| to_python(py, item)).collect::<PyResult<_>>()?;
            PyList::new(py, items)?.into_py_any(py)
        }
        Json::Object(object) => {
            let dict = PyDict::new(py);
            for (name, value) in object {
                dict.set_item(name, to_python(py, value)?)?;
            }
            dict.into_py_any(py)
        }
    }
}

/// A dataset: provenance, axes, arrays. The numbers are moved, not copied.
pub(crate) fn dataset(py: Python<'_>, dataset: Dataset) -> PyResult<Py<PyAny>> {
    let (provenance, axes, arrays) = dataset.into_parts();
    let origin = PyDict::new(py);
    origin.set_item("verb", provenance.verb)?;
    origin.set_item("title", provenance.title)?;
    origin.set_item("study", provenance.text)?;
    origin.set_item("changes", provenance.changes)?;
    origin.set_item("facts", provenance.facts)?;
    let list = |arrays: Vec<Array>| -> PyResult<Vec<Py<PyAny>>> {
        arrays.into_iter().map(|one| array(py, one)).collect()
    };
    (origin, list(axes)?, list(arrays)?).into_py_any(py)
}

/// (name, (unit, scaling), values, words): codes of words are bytes.
fn array(py: Python<'_>, array: Array) -> PyResult<Py<PyAny>> {
    let Array { name, unit, scaling, values, words } = array;
    let unit = (unit, scaling);
    if words.is_empty() {
        return (name, unit, values.into_pyarray(py), py.None()).into_py_any(py);
    }
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "codes are bytes")]
    let codes: Vec<u8> = values.into_iter().map(|code| code as u8).collect();
    (name, unit, codes.into_pyarray(py), words).into_py_any(py)
}
