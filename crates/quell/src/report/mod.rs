//! One page about a study: its question, sketch, values, verdicts, cost and pictures, what was not examined, and its sources.
//!
//! A report is made of the answers of the verbs. It computes nothing by itself and judges nothing: every sentence, table, number
//! and warning is that of a verb, and a verb that refuses is listed with its reason.
//!
//! ```
//! use quell::Study;
//! use quell::report::{ReportRequest, run};
//!
//! let text = "[belt]\ndamping_ratio = 0.005\nnormal_load = 1.0\nbelt_velocity = 0.3\n\
//!     [friction]\nlaw = \"coulomb\"\ncoefficient = 0.4\n";
//! let study = Study::parse(text, &[])?;
//! let report = run(&study, &ReportRequest::default())?;
//! assert!(report.html().contains("What was not examined"));
//! # Ok::<(), quell::Failure>(())
//! ```

mod facts;
mod limits;
mod page;
mod parts;
mod plan;

use serde_json::Value as Json;

use crate::complaint::{Complaint, Failure, Fault, Origin};
use crate::fields::Fields;
use crate::output::Output;
use crate::picture::sketch::sketch;
use crate::running::Progress;
use crate::study::{Kind, Study};
use crate::verbs::verbs;

pub use parts::StudyReport;

use parts::{ReportedAnswer, Unexamined};
use plan::{is_dithered, planned};

/// File name extensions of a report.
pub const EXTENSIONS: &[&str] = &["html"];

/// Width of the sketch in a report (mm).
const SKETCH_WIDTH_MM: f64 = 150.0;

/// Options of a report.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ReportRequest {
    /// Verbs that are left out, such as `thresholds` where they take long.
    pub without: Vec<String>,
}

/// Runs the verbs of a report.
///
/// # Errors
/// A complaint about a verb to be left out that the report does not have. A verb that refuses or fails does not end the report.
pub fn run(study: &Study, request: &ReportRequest) -> Result<StudyReport, Failure> {
    run_with_progress(study, request, &())
}

/// As [`run`], with the progress over its verbs.
///
/// # Errors
/// As [`run`].
pub fn run_with_progress(
    study: &Study,
    request: &ReportRequest,
    progress: &dyn Progress,
) -> Result<StudyReport, Failure> {
    let verbs = verbs(study);
    verbs.has("report")?;
    let plan = planned(study);
    for name in &request.without {
        if !plan.iter().any(|step| step.verb == name) {
            let known: Vec<&str> = plan.iter().map(|step| step.verb).collect();
            let allowed = format!("one of {}", known.join(", "));
            let origin = Origin::Argument("--without");
            return Err(
                Complaint::new(Fault::Value, "--without", origin, name.as_str(), allowed).into()
            );
        }
    }
    let (mut answers, mut unexamined) = (Vec::new(), Vec::new());
    progress.begin(plan.len(), 0);
    for step in plan {
        let plan::ReportStep { verb, heading, start, chosen, ask } = step;
        if request.without.iter().any(|name| name == verb) {
            unexamined
                .push(Unexamined::new(heading, format!("`{verb}` was left out by --without.")));
            progress.advance(1);
            continue;
        }
        match ask(&verbs) {
            Ok(outcome) => {
                let facts = outcome.facts();
                answers.push(ReportedAnswer { verb, heading, start, chosen, outcome, facts });
            }
            Err(why) => unexamined.push(Unexamined::refused(heading, verb, &why)),
        }
        progress.advance(1);
    }
    progress.end();
    unexamined.extend(limits::of(study, &answers));
    Ok(StudyReport {
        question: question(study),
        sketch: sketch(study, Some(SKETCH_WIDTH_MM))?,
        check: verbs.check()?,
        study: study.clone(),
        answers,
        unexamined,
    })
}

/// The question that the first comment of the study asks, or the one that a study of its kind answers.
fn question(study: &Study) -> String {
    let first = study.text().lines().next().unwrap_or_default();
    if let Some(asked) = first.strip_prefix('#').map(str::trim).filter(|line| line.ends_with('?')) {
        return asked.to_owned();
    }
    match (study.kind(), is_dithered(study)) {
        (Kind::Disc(_), true) => {
            "Is the disc stable under this dither, and which motion grows first?"
        }
        (Kind::Disc(_), false) => "Is the disc stable, and which motion grows first?",
        (_, true) => {
            "What does this dither do to the vibration, how sure is that, and at what cost?"
        }
        (_, false) => "Does this system vibrate by its friction, and how sure is that?",
    }
    .to_owned()
}

impl StudyReport {
    /// The page in HTML, complete in itself: without scripts and references to other files.
    pub fn html(&self) -> String {
        page::html(self)
    }

    /// As JSON: what was asked, the sentence and facts of every verb, and what was not examined.
    pub fn json(&self) -> Json {
        let answers = self.answers.iter().map(|answer| {
            let chosen = answer.chosen.as_deref().ok_or("nothing was chosen for the report");
            let mut inner = Fields::new();
            inner
                .plain("verb", answer.verb)
                .plain("heading", answer.heading)
                .plain("start", answer.start.as_str())
                .known_plain("chosen", chosen)
                .known_plain("sentence", answer.outcome.sentence().ok_or("the answer is a table"))
                .plain("notes", answer.outcome.notes())
                .plain("facts", answer.facts.clone());
            inner
        });
        let mut fields = Fields::new();
        fields
            .plain("ok", true)
            .known_plain("title", self.study.title().ok_or("the study has no title"))
            .plain("question", self.question.as_str())
            .list("answers", answers)
            .plain(
                "not_examined",
                self.unexamined.iter().map(Unexamined::json).collect::<Vec<_>>(),
            );
        fields.finish()
    }

    /// Writes the page.
    ///
    /// # Errors
    /// [`Failure::Failed`] if the file cannot be written.
    pub fn write(&self, output: Output) -> Result<String, Failure> {
        output.write(self.html().as_bytes()).map(|path| path.display().to_string())
    }
}
