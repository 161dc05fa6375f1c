//! `fit`: friction laws fitted to points, a free decay, or a study fitted to a record.

use std::path::PathBuf;
use std::sync::Arc;

use pyo3::prelude::*;
use quell::record::RecordRequest;
use quell::run::decay::DecayRequest;
use quell::run::fit::FitRequest;
use quell::run::record_fit::RecordFitRequest;
use quell::run::system::start::duration;
use quell::{Failure, Study};

use super::compare::RecordTexts;
use super::map::{Counter, Watched};
use crate::answer::NativeAnswer;
use crate::call;

/// Fits laws to a file.
#[pyfunction]
pub(crate) fn fit_laws(
    py: Python<'_>,
    data: PathBuf,
    law: Vec<String>,
    free: Vec<String>,
    fix: Vec<String>,
    columns: Vec<String>,
) -> PyResult<NativeAnswer> {
    call::run(py, move || {
        let request = FitRequest::new(&law, &free, &fix, &columns)?;
        Ok(NativeAnswer::new(Box::new(quell::run::fit::run(&data, &request)?)))
    })
}

/// Fits a free decay to a file.
#[pyfunction]
pub(crate) fn fit_decay(
    py: Python<'_>,
    data: PathBuf,
    law: Vec<String>,
    fix: Vec<String>,
    record: RecordTexts,
) -> PyResult<NativeAnswer> {
    call::run(py, move || {
        let request = DecayRequest::new(record.request()?, &law, &fix)?;
        Ok(NativeAnswer::new(Box::new(quell::run::decay::run(&data, &request)?)))
    })
}

/// Fits numbers of a study to a file.
pub(crate) fn record(
    py: Python<'_>,
    study: Arc<Study>,
    (data, free, fix): (PathBuf, Vec<String>, Vec<String>),
    settle: Option<String>,
    record: RecordTexts,
) -> PyResult<NativeAnswer> {
    let counter = Arc::new(Counter::default());
    let watched = Watched::new(&counter, None);
    let work = move || -> Result<NativeAnswer, Failure> {
        let record: RecordRequest = record.request()?;
        let settle = settle.map(|text| duration(&study.system(), &text, "settle")).transpose()?;
        let request = RecordFitRequest { record, free, fix, settle };
        let stop = counter.running(None).stop;
        let done = quell::run::record_fit::run(&study, &data, &request, stop)?;
        Ok(NativeAnswer::new(Box::new(done)))
    };
    call::watched(py, work, watched)
}
