//! `modes`: natural frequencies and shapes of a disc.

use quell::dataset::Dataset;
use quell::input::Inputs;
use quell::picture;
use quell::plot::Figure;
use quell::run::disc::modes::{Modes, run as modes};
use quell::{DiscStudy, Failure, Subject};
use serde_json::Value as Json;

use crate::answer::{Answer, NativeAnswer};

struct Found {
    study: DiscStudy,
    done: Modes,
}

impl Answer for Found {
    fn inputs(&self) -> Inputs {
        self.study.inputs()
    }

    fn json(&self) -> Json {
        self.done.json(&self.study)
    }

    fn datasets(&self) -> Vec<(&'static str, Dataset)> {
        vec![("modes", self.done.dataset(&self.study))]
    }

    fn figure(&self) -> Option<Result<Figure, Failure>> {
        Some(picture::disc::modes(&self.study, &self.done))
    }
}

/// Answers.
pub(crate) fn run(subject: &Subject) -> Result<NativeAnswer, Failure> {
    let study = subject.the_disc()?.clone();
    let done = modes(&study);
    Ok(NativeAnswer::new(Found { study, done }))
}
