//! The answer of `design` about the text of a study, for several test files.

use quell::outcome::named;
use quell::verbs::verbs;
use quell::{Failure, Study};
use serde_json::Value as Json;

/// The facts of the answer.
pub(crate) fn facts(text: &str) -> Json {
    let study = Study::parse(text, &[]).unwrap_or_else(|errors| panic!("{errors}\n{text}"));
    let found = verbs(&study).design().unwrap_or_else(|why| panic!("{why}"));
    named(found.as_ref(), found.facts())
}

/// Why the study or the verb is refused.
pub(crate) fn complaint(text: &str) -> String {
    match Study::parse(text, &[]) {
        Err(complaints) => complaints.to_string(),
        Ok(study) => match verbs(&study).design() {
            Err(Failure::Wrong(complaints)) => complaints.to_string(),
            Err(other) => other.to_string(),
            Ok(_) => panic!("accepted: {text}"),
        },
    }
}
