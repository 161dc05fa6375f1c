//! Independent tasks in parallel, on the threads of the process.

use quell_design::tasks::Tasks;
use quell_dynamics::simulation::{apart, count_taken, left};
use rayon::prelude::*;

/// Tasks in parallel: each may take the integration steps that the request has left, and what all of them took is counted when they have
/// ended, so that no answer depends on which thread ran what.
#[derive(Clone, Copy, Debug)]
pub(crate) struct InParallel;

impl Tasks for InParallel {
    fn run(&self, count: usize, task: &(dyn Fn(usize) + Sync)) {
        let left = left();
        let taken: Vec<u64> =
            (0..count).into_par_iter().map(|index| apart(left, || task(index)).1).collect();
        count_taken(taken.into_iter().fold(0, u64::saturating_add));
    }
}
