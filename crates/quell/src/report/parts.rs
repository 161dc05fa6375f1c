//! The parts of a report.

use serde_json::{Value as Json, json};

use crate::complaint::Failure;
use crate::outcome::Outcome;
use crate::plot::Sketch;
use crate::study::Study;

/// The answer of a verb in a report.
pub(super) struct ReportedAnswer {
    pub(super) verb: &'static str,
    /// What is asked, in a few words.
    pub(super) heading: &'static str,
    /// Start of the runs, or the motion about which the verb linearises.
    pub(super) start: String,
    /// What was chosen for the report, such as the window of thresholds.
    pub(super) chosen: Option<String>,
    pub(super) outcome: Box<dyn Outcome>,
    pub(super) facts: Json,
}

/// A report about a study.
pub struct StudyReport {
    pub(super) study: Study,
    pub(super) question: String,
    pub(super) sketch: Sketch,
    pub(super) check: Box<dyn Outcome>,
    pub(super) answers: Vec<ReportedAnswer>,
    pub(super) unexamined: Vec<Unexamined>,
}

/// Something that was not examined, and the fact behind it.
pub(super) struct Unexamined {
    pub(super) subject: String,
    pub(super) fact: String,
}

impl Unexamined {
    pub(super) fn new(subject: &str, fact: impl Into<String>) -> Self {
        Self { subject: subject.to_owned(), fact: fact.into() }
    }

    /// A verb that refused or failed.
    pub(super) fn refused(heading: &str, verb: &str, why: &Failure) -> Self {
        Self::new(heading, format!("`quell {verb}` gave no answer: {why}"))
    }

    pub(super) fn json(&self) -> Json {
        json!({ "subject": self.subject, "fact": self.fact })
    }
}
