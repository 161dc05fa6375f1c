//! `reproduce`: figures and tables of the dissertation, with their data, the table of claims and a report.

use std::path::PathBuf;

use pyo3::prelude::*;
use quell_reproduce::{ENTRIES, ReproductionOptions, Resolution, find, run};

use crate::study::change;
use crate::{answer, call, convert};

/// Reproduces entries and writes them into a folder. Returns the object of the command line.
#[pyfunction]
pub(crate) fn reproduce(
    py: Python<'_>,
    names: Vec<String>,
    out: PathBuf,
    quick: bool,
    set: Vec<(String, String)>,
    page: (Option<String>, bool, bool),
) -> PyResult<Py<PyAny>> {
    let (width, caption, title) = page;
    let object = call::run(py, move || {
        let entries = find(&names)?;
        let options = ReproductionOptions {
            resolution: if quick { Resolution::QUICK } else { Resolution::Full },
            page: answer::page(width.as_deref(), caption, title)?,
            changes: set.iter().map(change).collect(),
        };
        let done = run(&entries, &out, &options, |_| ())?;
        Ok(done.json(&out, &options))
    })?;
    convert::to_python(py, &object)
}

/// (name, description) of every entry that can be reproduced.
#[pyfunction]
pub(crate) fn reproduce_names() -> Vec<(&'static str, &'static str)> {
    ENTRIES.iter().map(|entry| (entry.name, entry.about)).collect()
}
