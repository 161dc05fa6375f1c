//! `bifurcation`: the response along a parameter, swept up and down.

use std::sync::Arc;

use pyo3::prelude::*;
use quell::dataset::Dataset;
use quell::input::Inputs;
use quell::picture;
use quell::plot::Figure;
use quell::run::bifurcation::{Bifurcation, Question, run as bifurcation};
use quell::{Failure, Study, Subject};
use serde_json::Value as Json;

use super::map::{Counter, Watched};
use crate::answer::{Answer, NativeAnswer};
use crate::call;

struct Swept {
    study: Study,
    done: Bifurcation,
}

impl Answer for Swept {
    fn inputs(&self) -> Inputs {
        self.study.inputs()
    }

    fn json(&self) -> Json {
        self.done.json(&self.study)
    }

    fn datasets(&self) -> Vec<(&'static str, Dataset)> {
        vec![("bifurcation", self.done.dataset(&self.study))]
    }

    fn figure(&self) -> Option<Result<Figure, Failure>> {
        Some(Ok(picture::bifurcation(&self.study, &self.done)))
    }
}

/// Answers.
pub(crate) fn run(
    py: Python<'_>,
    subject: Arc<Subject>,
    question: Question,
    progress: Option<Py<PyAny>>,
) -> PyResult<NativeAnswer> {
    let counter = Arc::new(Counter::default());
    let watched = Watched::new(&counter, progress);
    let work = move || {
        let study = subject.the_belt()?.clone();
        let done = bifurcation(&study, &question, counter.running(None))?;
        Ok(NativeAnswer::new(Swept { study, done }))
    };
    call::watched(py, work, watched)
}
