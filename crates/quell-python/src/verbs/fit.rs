//! `fit`: friction laws fitted to a file of measurements.

use std::path::PathBuf;

use pyo3::prelude::*;
use quell::outcome::Outcome;
use quell::run::fit::FitRequest;

use crate::{call, convert};

/// Fits laws to a file. Returns the object of the command line.
#[pyfunction]
pub(crate) fn fit(
    py: Python<'_>,
    data: PathBuf,
    law: Vec<String>,
    free: Vec<String>,
    fix: Vec<String>,
) -> PyResult<Py<PyAny>> {
    let object = call::run(py, move || {
        let request = FitRequest::new(&law, &free, &fix)?;
        Ok(quell::run::fit::run(&data, &request)?.json())
    })?;
    convert::to_python(py, &object)
}
