//! `response`: the steady response, what the dither does to it, and what it costs.

use quell::dataset::Dataset;
use quell::input::Inputs;
use quell::picture;
use quell::plot::Figure;
use quell::run::response::{Steady, run as response};
use quell::{Failure, Study, Subject};
use serde_json::Value as Json;

use crate::answer::{Answer, NativeAnswer};

struct Measured {
    study: Study,
    done: Steady,
}

impl Answer for Measured {
    fn inputs(&self) -> Inputs {
        self.study.inputs()
    }

    fn json(&self) -> Json {
        self.done.json(&self.study)
    }

    fn datasets(&self) -> Vec<(&'static str, Dataset)> {
        vec![
            ("record", self.done.record(&self.study)),
            ("spectrum", self.done.spectrum(&self.study)),
        ]
    }

    fn figure(&self) -> Option<Result<Figure, Failure>> {
        Some(Ok(picture::response(&self.study, &self.done)))
    }
}

/// Answers.
pub(crate) fn run(subject: &Subject) -> Result<NativeAnswer, Failure> {
    let study = subject.the_belt()?.clone();
    let done = response(&study)?;
    Ok(NativeAnswer::new(Measured { study, done }))
}
