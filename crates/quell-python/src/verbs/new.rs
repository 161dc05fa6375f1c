//! `new`: commented studies to start from.

use std::path::PathBuf;

use pyo3::prelude::*;
use quell::template::{CommentedStudy, list};

use crate::{call, convert};

/// A template, written to `save` if given; without a name, the list of questions. Returns the object of the command line.
#[pyfunction]
pub(crate) fn new(
    py: Python<'_>,
    question: Option<String>,
    save: Option<PathBuf>,
    overwrite: bool,
) -> PyResult<Py<PyAny>> {
    let object = call::run(py, move || {
        let Some(name) = question else { return Ok(list()) };
        let template = CommentedStudy::find(&name)?;
        let saved = save.map(|path| template.save(&path, overwrite)).transpose()?;
        Ok(template.json(saved.as_deref()))
    })?;
    convert::to_python(py, &object)
}
