//! `report`: one page about a study, in HTML.

use std::path::Path;

use quell::output::Output;
use quell::report::{self, EXTENSIONS, ReportRequest};
use quell::{Failure, Study};

/// Runs the verb: the page as text, and in a file if `path` is given.
pub(crate) fn run(
    study: &Study,
    path: Option<&Path>,
    without: Vec<String>,
) -> Result<String, Failure> {
    let inputs = study.inputs();
    let output = path.map(|path| Output::prepare(path, "path", EXTENSIONS, &inputs));
    let output = output.transpose()?;
    let done = report::run(study, &ReportRequest { without })?;
    if let Some(output) = output {
        done.write(output)?;
    }
    Ok(done.html())
}
