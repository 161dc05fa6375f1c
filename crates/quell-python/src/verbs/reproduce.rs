//! `reproduce`: figures and tables of the dissertation, with their data, the table of claims and a report.

use std::path::PathBuf;

use pyo3::prelude::*;
use quell_reproduce::{ENTRIES, Resolution, find, run};

use crate::answer::page;
use crate::{call, convert};

/// Reproduces entries and writes them into a folder. Returns the object of the command line.
#[pyfunction]
pub(crate) fn reproduce(
    py: Python<'_>,
    names: Vec<String>,
    out: PathBuf,
    quick: bool,
    width: Option<String>,
    caption: bool,
) -> PyResult<Py<PyAny>> {
    let object = call::run(py, move || {
        let entries = find(&names)?;
        let pace = if quick { Resolution::Quick } else { Resolution::Full };
        let page = page(width.as_deref(), caption)?;
        let done = run(&entries, &out, pace, page, |_| ())?;
        Ok(done.json(&out, pace))
    })?;
    convert::to_python(py, &object)
}

/// (name, description) of every entry that can be reproduced.
#[pyfunction]
pub(crate) fn reproduce_names() -> Vec<(&'static str, &'static str)> {
    ENTRIES.iter().map(|entry| (entry.name, entry.about)).collect()
}
