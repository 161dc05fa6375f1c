//! Computes chunks on threads; can be stopped between chunks.

use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering};

use rayon::{ThreadPool, ThreadPoolBuilder};

use super::plan::Plan;
use super::sheet::Data;
use crate::complaint::Failure;
use crate::parallel::Parallel;

/// Largest number of threads that can be requested.
pub const MOST_THREADS: usize = 1024;

/// Receives the progress of a map.
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

/// Execution settings of a map.
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
    pub(crate) fn pool(&self) -> Result<ThreadPool, Failure> {
        let mut pool = ThreadPoolBuilder::new();
        if let Some(threads) = self.threads {
            pool = pool.num_threads(threads);
        }
        pool.build().map_err(|why| Failure::Failed {
            key: "--threads".to_owned(),
            why: format!("no threads could be started: {why}"),
        })
    }
}

/// Computes the chunks `todo` of a plan in any order and passes each to `keep`, until
/// stopped.
///
/// # Errors
/// The first failure of `keep`, after which no other chunk is begun; or no thread could be started.
pub(crate) fn run(
    plan: &Plan,
    todo: &[usize],
    running: Running<'_>,
    keep: impl Fn(usize, Vec<Data>) -> Result<(), Failure> + Sync,
) -> Result<(), Failure> {
    let pool = running.pool()?;
    let failure = OnceLock::new();
    // One chunk at a time: the next free thread takes the next chunk.
    let compute = |&number: &usize| {
        if running.stop.load(Ordering::Relaxed) || failure.get().is_some() {
            return;
        }
        match keep(number, plan.compute(number)) {
            Ok(()) => running.progress.advance(plan.chunks().points(number).len()),
            // Another failure at the same moment is one like it.
            Err(why) => drop(failure.set(why)),
        }
    };
    pool.install(|| todo.in_parallel(compute));
    failure.into_inner().map_or(Ok(()), Err)
}
