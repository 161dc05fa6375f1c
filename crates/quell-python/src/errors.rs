//! Failures as exceptions: `quell.StudyError` with every complaint, `quell.RunError` where the work failed.
//!
//! The classes are Python's (`quell._errors`). Complaints that name an option of the command line name
//! the argument of the method instead, and have no line where there was no file.

use pyo3::prelude::*;
use pyo3::types::PyList;
use quell::{Complaint, Failure, Origin};

use crate::convert;

/// Ways of the command line, and what they are in Python.
const WORDS: &[(&str, &str)] = &[
    ("the same command with --resume goes on", "the same call with resume=True goes on"),
    ("--resume goes on with it", "resume=True goes on with it"),
    (
        "--save FILE.zarr keeps what is done, and --resume goes on",
        "store=\"FILE.zarr\" keeps what is done, and resume=True goes on",
    ),
    (
        "or on the command line: --set sweep[0].parameter=dither.amplitude --set 'sweep[0].values=[0.1, 0.2]'",
        "or axes={\"dither.amplitude\": [0.1, 0.2]}",
    ),
    (
        "--from-rest, --from-sliding, --from-squeal or --start",
        "from_rest, from_sliding, from_squeal or start",
    ),
    ("--clear and --frequency", "clear and frequency"),
    ("--quantity", "quantity"),
    ("--save", "store"),
    ("--plot", "plot"),
    ("--from", "from_"),
    ("the keys that `quell schema` lists", "the keys that quell.schema() lists"),
];

/// The exception for a failure.
pub(crate) fn raised(py: Python<'_>, failure: Failure) -> PyErr {
    exception(py, failure).unwrap_or_else(|error| error)
}

fn exception(py: Python<'_>, failure: Failure) -> PyResult<PyErr> {
    let classes = py.import("quell._errors")?;
    let value = match failure {
        Failure::Wrong(complaints) => {
            let errors: Vec<Py<PyAny>> = complaints
                .into_iter()
                .map(|complaint| convert::to_python(py, &pythonic(complaint).json()))
                .collect::<PyResult<_>>()?;
            classes.getattr("StudyError")?.call1((PyList::new(py, errors)?,))?
        }
        Failure::Failed { key, why } => {
            classes.getattr("RunError")?.call1((in_python(&key), in_python(&why)))?
        }
    };
    Ok(PyErr::from_value(value))
}

/// A complaint in the words of Python.
fn pythonic(mut complaint: Complaint) -> Complaint {
    if let Origin::Argument(_) = complaint.origin {
        complaint.origin = Origin::Whole;
    }
    if let Some(option) = complaint.key.strip_prefix("--") {
        complaint.key = match option {
            "from" => "from_".to_owned(),
            _ => option.replace('-', "_"),
        };
    }
    complaint.allowed = in_python(&complaint.allowed);
    complaint
}

fn in_python(text: &str) -> String {
    WORDS.iter().fold(text.to_owned(), |text, (option, word)| text.replace(option, word))
}

/// Complaints of a study that was not read from a file: lines of its text mean nothing to who made it.
pub(crate) fn without_lines(complaints: Vec<Complaint>) -> Vec<Complaint> {
    let without = |complaint| Complaint { origin: Origin::Whole, ..complaint };
    complaints.into_iter().map(without).collect()
}
