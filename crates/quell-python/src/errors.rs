//! Failures as exceptions: `quell.StudyError` with every complaint, `quell.RunError` if a computation failed.
//!
//! The classes are defined in Python (`quell._errors`). Names of command line options are replaced by names of arguments
//! (`words`); complaints have no line number if the study was not read from a file.

use pyo3::prelude::*;
use pyo3::types::PyList;
use quell::{Complaint, Complaints, Failure, Origin};

use crate::convert;
use crate::words::{in_python, key_in_python};

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
            classes.getattr("RunError")?.call1((key_in_python(&key), in_python(&why)))?
        }
    };
    Ok(PyErr::from_value(value))
}

/// A complaint in terms of the Python API.
fn pythonic(mut complaint: Complaint) -> Complaint {
    if let Origin::Argument(_) = complaint.origin {
        complaint.origin = Origin::Whole;
    }
    complaint.key = key_in_python(&complaint.key);
    complaint.allowed = in_python(&complaint.allowed).into();
    complaint
}

/// Complaints of a study that was not read from a file, whose line numbers have no meaning for the user.
pub(crate) fn without_lines(complaints: Complaints) -> Complaints {
    let without = |complaint| Complaint { origin: Origin::Whole, ..complaint };
    Complaints::from(complaints.into_iter().map(without).collect::<Vec<_>>())
}
