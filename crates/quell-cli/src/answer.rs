//! Answers and failures of verbs, printed to standard output and standard error.
//!
//! It is not an error if the reader closes standard output early; the rest of the answer is then not written.

use std::io::{self, Write};
use std::process::ExitCode;

use quell::Failure;
use serde_json::Value as Json;

/// The answer of a verb: text or one JSON object.
#[derive(Debug)]
pub(crate) struct Answer {
    output: String,
    warnings: Vec<String>,
}

impl Answer {
    /// An answer as JSON if `json` is true, else as text. The warnings of the object are printed to standard error.
    pub(crate) fn new(json: bool, object: &Json, text: impl FnOnce() -> String) -> Self {
        let warnings = object["warnings"].as_array().map_or(&[][..], Vec::as_slice);
        let warnings =
            warnings.iter().filter_map(|warning| Some(warning.as_str()?.to_owned())).collect();
        let output = if json { format!("{object}\n") } else { text() };
        Self { output, warnings }
    }

    /// Prints the warnings and the answer.
    pub(crate) fn show(self) -> ExitCode {
        for warning in &self.warnings {
            print_error(&format!("warning: {warning}\n"));
        }
        print(&self.output)
    }
}

/// Prints a failure of the verb `asked`, if one was: with `json` as an object to standard output, else as text to standard error.
pub(crate) fn refuse(failure: &Failure, asked: Option<&str>, json: bool) -> ExitCode {
    if json {
        let mut object = failure.json();
        if let (Some(fields), Some(asked)) = (object.as_object_mut(), asked) {
            // The place that it has in an answer.
            fields.shift_insert(1.min(fields.len()), "answer".to_owned(), asked.into());
        }
        // If standard output fails too, the exit status still reports the failure.
        print(&format!("{object}\n"));
    } else {
        print_error(&lines(failure));
    }
    ExitCode::from(failure.exit_status())
}

/// One line per complaint; further lines of a complaint, such as an example, are indented.
fn lines(failure: &Failure) -> String {
    let texts: Vec<String> = match failure {
        Failure::Wrong(complaints) => complaints.iter().map(ToString::to_string).collect(),
        Failure::Failed { .. } => vec![failure.to_string()],
    };
    let mut lines: Vec<String> =
        texts.iter().map(|text| format!("error: {}\n", text.replace('\n', "\n    "))).collect();
    if lines.len() > 1 {
        lines.push(format!("{} errors; no computation was started\n", lines.len()));
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
            print_error(&format!("error: standard output cannot be written: {error}\n"));
            ExitCode::from(1)
        }
    }
}

/// Writes to standard error; failures are ignored.
pub(crate) fn print_error(text: &str) {
    let _ = io::stderr().write_all(text.as_bytes());
}
