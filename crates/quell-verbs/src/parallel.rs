//! Independent tasks in parallel, on the threads of the process.

use quell_design::tasks::{Tasks, answers};
use quell_dynamics::simulation::{apart, count_taken, left};
use rayon::prelude::*;

/// Tasks in parallel: each may take the integration steps that the request has left, and what all of them took is counted when they have
/// ended, so that no answer depends on which thread ran what.
///
/// It is the only use of rayon's iterators, which are compiled again for each closure, some hundred functions each time.
#[derive(Clone, Copy, Debug)]
pub struct InParallel;

impl Tasks for InParallel {
    fn run(&self, count: usize, task: &(dyn Fn(usize) + Sync)) {
        let left = left();
        let tasks = (0..count).into_par_iter().with_max_len(1);
        let taken: Vec<u64> = tasks.map(|index| apart(left, || task(index)).1).collect();
        count_taken(taken.into_iter().fold(0, u64::saturating_add));
    }
}

/// Items about which something is asked in parallel.
pub trait Parallel<I> {
    /// The answers about the items, in their order, found in parallel.
    fn in_parallel<'i, T: Send>(
        &'i self,
        answer: impl Fn(&'i I) -> T + Sync,
    ) -> std::vec::IntoIter<T>
    where
        I: 'i;
}

impl<I: Sync> Parallel<I> for [I] {
    fn in_parallel<'i, T: Send>(
        &'i self,
        answer: impl Fn(&'i I) -> T + Sync,
    ) -> std::vec::IntoIter<T>
    where
        I: 'i,
    {
        answers(&InParallel, self, answer).into_iter()
    }
}
