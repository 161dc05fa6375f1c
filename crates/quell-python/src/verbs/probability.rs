//! `probability`: how probable it is that a study with uncertain numbers vibrates.

use std::sync::Arc;

use pyo3::prelude::*;
use quell::Study;
use quell::run::probability::{ProbabilityRequest, ProbabilityStart};
use quell::verbs::verbs;

use super::map::{Counter, Watched};
use crate::answer::NativeAnswer;
use crate::call;

/// Runs the verb.
pub(crate) fn run(
    py: Python<'_>,
    study: Arc<Study>,
    (start, samples, seed): (String, Option<usize>, u64),
    threads: Option<usize>,
    progress: Option<Py<PyAny>>,
) -> PyResult<NativeAnswer> {
    let counter = Arc::new(Counter::default());
    let watched = Watched::new(&counter, progress);
    let work = move || {
        let start = ProbabilityStart::named(&start)?;
        let request = ProbabilityRequest { samples, seed, start };
        let done = verbs(&study).probability(request, counter.running(threads))?;
        Ok(NativeAnswer::new(done))
    };
    call::watched(py, work, watched)
}
