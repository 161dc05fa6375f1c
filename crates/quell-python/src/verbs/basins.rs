//! `basins`: which starts end on which response.

use std::sync::Arc;

use pyo3::prelude::*;
use quell::dataset::Dataset;
use quell::input::Inputs;
use quell::picture;
use quell::plot::Figure;
use quell::run::basins::{Basins, Question, run as basins};
use quell::{Failure, Study, Subject};
use serde_json::Value as Json;

use super::map::{Counter, Watched};
use crate::answer::{Answer, NativeAnswer};
use crate::call;

struct Found {
    study: Study,
    done: Basins,
}

impl Answer for Found {
    fn inputs(&self) -> Inputs {
        self.study.inputs()
    }

    fn json(&self) -> Json {
        self.done.json(&self.study)
    }

    fn datasets(&self) -> Vec<(&'static str, Dataset)> {
        vec![("basins", self.done.dataset(&self.study))]
    }

    fn figure(&self) -> Option<Result<Figure, Failure>> {
        Some(picture::basins(&self.study, &self.done))
    }
}

/// Answers.
pub(crate) fn run(
    py: Python<'_>,
    subject: Arc<Subject>,
    question: Question,
    threads: Option<usize>,
    progress: Option<Py<PyAny>>,
) -> PyResult<NativeAnswer> {
    let counter = Arc::new(Counter::default());
    let watched = Watched::new(&counter, progress);
    let work = move || {
        let study = subject.the_belt()?.clone();
        let done = basins(&study, &question, counter.running(threads))?;
        Ok(NativeAnswer::new(Found { study, done }))
    };
    call::watched(py, work, watched)
}
