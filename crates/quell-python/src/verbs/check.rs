//! `check`: the study in numbers.

use std::sync::Arc;

use quell::Subject;
use quell::input::Inputs;
use quell::run::check::Check;
use quell::run::disc::check as disc;
use serde_json::Value as Json;

use crate::answer::{Answer, NativeAnswer};

struct Checked(Arc<Subject>);

impl Answer for Checked {
    fn inputs(&self) -> Inputs {
        self.0.inputs()
    }

    fn json(&self) -> Json {
        json(&self.0)
    }
}

/// The study as JSON.
pub(crate) fn json(subject: &Subject) -> Json {
    match subject {
        Subject::Belt(study) => Check { study }.json(),
        Subject::Disc(study) => disc::json(study),
    }
}

/// Answers.
pub(crate) fn run(subject: Arc<Subject>) -> NativeAnswer {
    NativeAnswer::new(Checked(subject))
}
