//! `cite`: what a study's computations rest on.

use quell::Subject;
use quell::cite::sources_of;
use quell::input::Inputs;
use serde_json::Value as Json;

use crate::answer::{Answer, NativeAnswer};

struct Cited {
    inputs: Inputs,
    object: Json,
}

impl Answer for Cited {
    fn inputs(&self) -> Inputs {
        self.inputs.clone()
    }

    fn json(&self) -> Json {
        self.object.clone()
    }
}

/// Answers.
pub(crate) fn run(subject: &Subject) -> NativeAnswer {
    NativeAnswer::new(Cited { inputs: subject.inputs(), object: sources_of(subject).json() })
}
