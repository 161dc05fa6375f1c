//! `quell report`: one page about a study, in HTML.

use std::fmt::Write as _;
use std::path::PathBuf;

use clap::Args;
use quell::Failure;
use quell::output::Output;
use quell::report::{self, EXTENSIONS, ReportRequest};
use serde_json::Value as Json;

use crate::answer::Answer;
use crate::arguments::{Gathered, StudyArguments, inputs};
use crate::progress::Bar;

/// Writes one page about a study: sketch, values, verdicts, cost, pictures, sources, and what was not examined
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    study: StudyArguments,
    /// File for the page, which is self-contained
    #[arg(long, value_name = "FILE.html")]
    out: PathBuf,
    /// Verbs to leave out, separated by commas, such as thresholds where they take long
    #[arg(long, value_name = "VERB,…", value_delimiter = ',')]
    without: Vec<String>,
}

/// Runs the verb.
pub(crate) fn run(arguments: &Arguments) -> Result<Answer, Failure> {
    let mut complaints = Gathered::default();
    let study = complaints.take(arguments.study.read());
    let inputs = inputs(study.as_ref());
    let output = complaints.take(Output::prepare(&arguments.out, "--out", EXTENSIONS, &inputs));
    let (study, output) = complaints.finish(study.zip(output))?;

    let request = ReportRequest { without: arguments.without.clone() };
    let done = report::run_with_progress(&study, &request, &Bar::of_answers())?;
    let mut object = done.json();
    let written = done.write(output)?;
    object["saved"] = vec![written.as_str()].into();
    Ok(Answer::new(arguments.study.json, &object, || text(&written, &object)))
}

/// The sentences of the answers, and what was not examined.
fn text(written: &str, object: &Json) -> String {
    let mut text = format!("Saved {written}.\n");
    for answer in object["answers"].as_array().into_iter().flatten() {
        if let (Some(heading), Some(sentence)) =
            (answer["heading"].as_str(), answer["sentence"].as_str())
        {
            let _ = writeln!(text, "{heading}: {sentence}");
        }
    }
    let gaps = object["not_examined"].as_array().map_or(0, Vec::len);
    let _ = writeln!(text, "The page lists {gaps} things that were not examined.");
    text
}
