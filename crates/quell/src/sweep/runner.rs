//! Computes chunks on threads, and can be stopped between them.

use std::sync::atomic::{AtomicBool, Ordering};

use rayon::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};

use super::plan::Plan;
use super::sheet::Data;
use crate::complaint::Failure;

/// Most threads that can be asked for.
pub const MOST_THREADS: usize = 1024;

/// Who is told how far a map is.
pub trait Progress: Sync {
    /// The work begins: `points` in all, `there` of them from an earlier run.
    fn begin(&self, points: usize, there: usize);
    /// So many more points are there.
    fn advance(&self, points: usize);
    /// The work ends, done or not.
    fn end(&self);
}

/// Nobody is told.
impl Progress for () {
    fn begin(&self, _points: usize, _there: usize) {}
    fn advance(&self, _points: usize) {}
    fn end(&self) {}
}

/// How a map is computed.
#[derive(Clone, Copy)]
pub struct Running<'a> {
    /// Number of threads; all there are where it is `None`.
    pub threads: Option<usize>,
    /// Set from outside to stop: chunks that run are finished, no other is begun.
    pub stop: &'a AtomicBool,
    /// Who is told how far it is.
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

/// Computes the chunks `todo` of a plan in any order and hands each to `keep`, until it is
/// stopped.
///
/// # Errors
/// The first failure of `keep`, after which no other chunk is begun; or no threads.
pub(crate) fn run(
    plan: &Plan,
    todo: &[usize],
    running: Running<'_>,
    keep: impl Fn(usize, Vec<Data>) -> Result<(), Failure> + Sync,
) -> Result<(), Failure> {
    let pool = running.pool()?;
    pool.install(|| {
        // One chunk at a time: whoever is free takes the next.
        todo.par_iter().with_max_len(1).try_for_each(|&number| {
            if running.stop.load(Ordering::Relaxed) {
                return Ok(());
            }
            keep(number, plan.compute(number))?;
            running.progress.advance(plan.chunks().points(number).len());
            Ok(())
        })
    })
}
