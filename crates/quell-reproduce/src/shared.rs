//! Measurements that both a figure and the table of claims need, made once per run.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use super::amplitude_columns::AmplitudeColumns;
use quell::complaint::Failure;
use quell::study::BeltStudy;

/// A measurement that one thread makes while other threads that need it wait.
type Once<T> = Arc<OnceLock<Result<Arc<T>, Failure>>>;

/// Measurements that the entries of one run have made so far; a clone is another handle to the same measurements.
#[derive(Clone, Debug, Default)]
pub(super) struct SharedMeasurements {
    columns: Arc<Mutex<BTreeMap<String, Once<AmplitudeColumns>>>>,
}

impl SharedMeasurements {
    /// The columns of a study of single responses.
    ///
    /// They are measured on the first thread that requests them. Waiting here for work in the thread pool could deadlock, because
    /// every thread of the pool might be waiting for this measurement.
    pub(super) fn columns(
        &self,
        name: &str,
        study: &BeltStudy,
    ) -> Result<Arc<AmplitudeColumns>, Failure> {
        let key = format!("{}\n{:?}", study.text(), study.changes());
        let once = {
            let mut known = self.columns.lock().unwrap_or_else(PoisonError::into_inner);
            Arc::clone(known.entry(key).or_default())
        };
        once.get_or_init(|| AmplitudeColumns::of(name, study.clone()).map(Arc::new)).clone()
    }
}
