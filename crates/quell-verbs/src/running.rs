//! How a verb with many runs is executed: threads, progress, and how it is stopped.

use std::sync::atomic::AtomicBool;

use rayon::{ThreadPool, ThreadPoolBuilder};

use crate::complaint::Failure;

/// Largest number of threads that can be requested.
pub const MOST_THREADS: usize = 1024;

/// Receives the progress of a verb with many runs.
pub trait Progress: Sync {
    /// The work begins: `points` in total, `there` of them from an earlier run.
    fn begin(&self, points: usize, there: usize);
    /// More points are done.
    fn advance(&self, points: usize);
    /// The work ends, complete or not.
    fn end(&self);
}

/// Ignores progress.
impl Progress for () {
    fn begin(&self, _points: usize, _there: usize) {}
    fn advance(&self, _points: usize) {}
    fn end(&self) {}
}

/// Execution settings of a verb with many runs.
#[derive(Clone, Copy)]
pub struct Running<'a> {
    /// Number of threads; `None` for all cores.
    pub threads: Option<usize>,
    /// Set from outside to stop: running chunks are finished, and no other is begun.
    pub stop: &'a AtomicBool,
    /// Receives the progress.
    pub progress: &'a dyn Progress,
}

impl Running<'_> {
    /// The threads.
    ///
    /// # Errors
    /// [`Failure::Failed`] if none could be started.
    pub fn pool(&self) -> Result<ThreadPool, Failure> {
        let mut pool = ThreadPoolBuilder::new();
        if let Some(threads) = self.threads {
            pool = pool.num_threads(threads);
        }
        pool.build().map_err(|why| Failure::Failed {
            key: "--threads".to_owned(),
            why: format!("no threads could be started: {why}").into(),
        })
    }
}
