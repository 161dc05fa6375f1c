//! `basins`: which starts converge to which response.

use std::sync::Arc;

use pyo3::prelude::*;
use quell::Study;
use quell::kind::verbs;
use quell::run::basins::{BasinsRequest, StartLayout};
use quell::run::system::basins::{PlaneRequest, read_plane};
use quell::run::varied::Range;

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

/// Runs the verb on a system in a plane of two numbers of its state.
pub(crate) fn run_in_plane(
    py: Python<'_>,
    study: Arc<Study>,
    (plane, layout, over): (String, StartLayout, Option<Range>),
    threads: Option<usize>,
    progress: Option<Py<PyAny>>,
) -> PyResult<NativeAnswer> {
    let counter = Arc::new(Counter::default());
    let watched = Watched::new(&counter, progress);
    let work = move || {
        let axes = read_plane(&study.system()?, &plane)?;
        let request = PlaneRequest::of(axes, layout, over);
        let done = verbs(&study).basins_of_system(&request, counter.running(threads))?;
        Ok(NativeAnswer::new(done))
    };
    call::watched(py, work, watched)
}
