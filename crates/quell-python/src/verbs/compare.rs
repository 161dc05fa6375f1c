//! `compare`: a measured record or spectrum against the response of a study.

use std::path::PathBuf;

use pyo3::prelude::*;
use quell::outcome::ComparedStudy;
use quell::record::RecordRequest;
use quell::run::compare::{self, CompareRequest};
use quell::run::system::start::duration;
use quell::{Failure, Study};

use crate::answer::NativeAnswer;

/// How a measured file is read: column, quantity, gain and window, and columns by other names.
#[derive(Debug, FromPyObject)]
pub(crate) struct RecordTexts(
    Option<String>,
    Option<String>,
    Option<String>,
    Option<String>,
    Vec<String>,
);

impl RecordTexts {
    /// The checked request.
    pub(crate) fn request(&self) -> Result<RecordRequest, Failure> {
        let Self(column, quantity, gain, window, columns) = self;
        RecordRequest::new(
            column.as_deref(),
            quantity.as_deref(),
            gain.as_deref(),
            window.as_deref(),
            columns,
        )
    }
}

/// Runs the verb.
pub(crate) fn run(
    study: &Study,
    (measured, after): (PathBuf, Option<PathBuf>),
    settle: Option<&str>,
    record: &RecordTexts,
) -> Result<NativeAnswer, Failure> {
    let record = record.request()?;
    let settle = settle.map(|text| duration(&study.system(), text, "settle")).transpose()?;
    let request = CompareRequest { measured, after, record, settle };
    let done = compare::run(study, &request)?;
    Ok(NativeAnswer::new(Box::new(ComparedStudy { study: study.clone(), done })))
}
