//! `cite`: what a study's computations rest on.

use quell::Subject;
use quell::cite::sources_of;
use serde_json::Value as Json;

use crate::answer::{Answer, NativeAnswer};

struct Cited(Json);

impl Answer for Cited {
    fn json(&self) -> Json {
        self.0.clone()
    }
}

/// Answers.
pub(crate) fn run(subject: &Subject) -> NativeAnswer {
    NativeAnswer::new(Cited(sources_of(subject).json()))
}
