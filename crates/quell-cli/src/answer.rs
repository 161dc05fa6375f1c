//! What a verb answers, and how it leaves the process.
//!
//! A reader that closes standard output early is no error: the rest is not written.

use std::io::{self, Write};
use std::process::ExitCode;

use quell::Failure;
use serde_json::Value as Json;

/// The answer of a verb: text for people or one JSON object.
#[derive(Debug)]
pub(crate) struct Answer {
    output: String,
    warnings: Vec<String>,
}

impl Answer {
    /// One of the two, as asked for. The warnings of the object go to standard error.
    pub(crate) fn new(json: bool, object: &Json, text: impl FnOnce() -> String) -> Self {
        let told = object["warnings"].as_array().map_or(&[][..], Vec::as_slice);
        let warnings = told.iter().filter_map(|it| Some(it.as_str()?.to_owned())).collect();
        let output = if json { format!("{object}\n") } else { text() };
        Self { output, warnings }
    }

    /// Writes it.
    pub(crate) fn show(self) -> ExitCode {
        for warning in &self.warnings {
            tell(&format!("warning: {warning}\n"));
        }
        print(&self.output)
    }
}

/// Tells what is wrong: in JSON on standard output, else on standard error.
pub(crate) fn refuse(failure: &Failure, json: bool) -> ExitCode {
    if json {
        // Should standard output fail too, the exit status still tells.
        print(&format!("{}\n", failure.json()));
    } else {
        tell(&lines(failure));
    }
    ExitCode::from(failure.exit_status())
}

/// One line a complaint; what follows on further lines, such as an example, is indented.
fn lines(failure: &Failure) -> String {
    let told: Vec<String> = match failure {
        Failure::Wrong(complaints) => complaints.iter().map(ToString::to_string).collect(),
        Failure::Failed { .. } => vec![failure.to_string()],
    };
    let mut lines: Vec<String> =
        told.iter().map(|text| format!("error: {}\n", text.replace('\n', "\n    "))).collect();
    if lines.len() > 1 {
        lines.push(format!("{} complaints; nothing was computed\n", lines.len()));
    }
    lines.concat()
}

/// Writes to standard output.
pub(crate) fn print(text: &str) -> ExitCode {
    let mut output = io::stdout().lock();
    match output.write_all(text.as_bytes()).and_then(|()| output.flush()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => ExitCode::SUCCESS,
        Err(error) => {
            tell(&format!("error: standard output cannot be written: {error}\n"));
            ExitCode::from(1)
        }
    }
}

/// Writes to standard error; where that is closed nobody listens.
pub(crate) fn tell(text: &str) {
    let _ = io::stderr().write_all(text.as_bytes());
}
