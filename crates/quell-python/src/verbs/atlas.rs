//! `atlas`: exact thresholds of belts from the tables in dimensionless groups.

use std::sync::Arc;

use pyo3::prelude::*;
use quell::run::atlas::{recomputed, tables};
use quell::verbs::verbs;
use quell::{Failure, Study};

use super::map::{Counter, Watched};
use crate::answer::NativeAnswer;
use crate::call;

/// Runs the verb for a study.
pub(crate) fn run(study: &Study, exact: bool) -> Result<NativeAnswer, Failure> {
    Ok(NativeAnswer::new(verbs(study).atlas(exact)?))
}

/// The tables, as shipped or computed again.
#[pyfunction]
#[pyo3(signature = (compute, threads, progress))]
pub(crate) fn atlas_tables(
    py: Python<'_>,
    compute: bool,
    threads: Option<usize>,
    progress: Option<Py<PyAny>>,
) -> PyResult<NativeAnswer> {
    if !compute {
        return call::run(py, || Ok(NativeAnswer::new(Box::new(tables()))));
    }
    let counter = Arc::new(Counter::default());
    let watched = Watched::new(&counter, progress);
    let work = move || Ok(NativeAnswer::new(Box::new(recomputed(counter.running(threads))?)));
    call::watched(py, work, watched)
}
