//! `bifurcation`: the response along a parameter, swept up and down.

use std::sync::Arc;

use pyo3::prelude::*;
use quell::run::bifurcation::SweepRequest;
use quell::verbs::verbs;
use quell::{Failure, Study};

use super::map::{Counter, Watched};
use crate::answer::NativeAnswer;
use crate::call;

/// Runs the verb.
pub(crate) fn run(
    py: Python<'_>,
    study: Arc<Study>,
    request: SweepRequest,
    progress: Option<Py<PyAny>>,
) -> PyResult<NativeAnswer> {
    let counter = Arc::new(Counter::default());
    let watched = Watched::new(&counter, progress);
    let work =
        move || Ok(NativeAnswer::new(verbs(&study).bifurcation(&request, counter.running(None))?));
    call::watched(py, work, watched)
}

/// Runs the ramp of a study that varies in time.
pub(crate) fn ramp(study: &Study) -> Result<NativeAnswer, Failure> {
    Ok(NativeAnswer::new(verbs(study).ramp()?))
}
