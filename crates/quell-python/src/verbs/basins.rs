//! `basins`: which starts converge to which response.

use std::sync::Arc;

use pyo3::prelude::*;
use quell::Study;
use quell::kind::verbs;
use quell::run::basins::BasinsRequest;

use super::map::{Counter, Watched};
use crate::answer::NativeAnswer;
use crate::call;

/// Runs the verb.
pub(crate) fn run(
    py: Python<'_>,
    study: Arc<Study>,
    request: BasinsRequest,
    threads: Option<usize>,
    progress: Option<Py<PyAny>>,
) -> PyResult<NativeAnswer> {
    let counter = Arc::new(Counter::default());
    let watched = Watched::new(&counter, progress);
    let work =
        move || Ok(NativeAnswer::new(verbs(&study).basins(&request, counter.running(threads))?));
    call::watched(py, work, watched)
}
