//! Computes chunks on threads; can be stopped between chunks.

use std::sync::OnceLock;
use std::sync::atomic::Ordering;

use super::plan::Plan;
use super::sheet::Data;
use crate::complaint::Failure;
use crate::parallel::Parallel;
use crate::running::Running;

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
