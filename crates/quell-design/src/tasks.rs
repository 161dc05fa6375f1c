//! Independent tasks of a question. This crate starts no threads: who asks decides whether tasks run in turn or in parallel.

use std::fmt::Debug;
use std::sync::{Mutex, PoisonError};

/// Who runs independent tasks.
pub trait Tasks: Debug + Sync {
    /// Runs `task` once with each number below `count`, in any order and on any thread, and returns when all have ended.
    fn run(&self, count: usize, task: &(dyn Fn(usize) + Sync));
}

/// One task after the other.
#[derive(Clone, Copy, Debug)]
pub struct InTurn;

impl Tasks for InTurn {
    fn run(&self, count: usize, task: &(dyn Fn(usize) + Sync)) {
        (0..count).for_each(task);
    }
}

/// The answers about items, in their order, however the tasks were run.
pub fn answers<'i, I: Sync, T: Send>(
    tasks: &dyn Tasks,
    items: &'i [I],
    answer: impl Fn(&'i I) -> T + Sync,
) -> Vec<T> {
    let mut places: Vec<Option<T>> = Vec::new();
    places.resize_with(items.len(), || None);
    let found = Mutex::new(places);
    tasks.run(items.len(), &|index| {
        let one = answer(&items[index]);
        found.lock().unwrap_or_else(PoisonError::into_inner)[index] = Some(one);
    });
    found.into_inner().unwrap_or_else(PoisonError::into_inner).into_iter().flatten().collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Tasks from the last to the first.
    #[derive(Debug)]
    struct Backwards;

    impl Tasks for Backwards {
        fn run(&self, count: usize, task: &(dyn Fn(usize) + Sync)) {
            (0..count).rev().for_each(task);
        }
    }

    #[test]
    fn answers_are_in_the_order_of_the_items() {
        let items = [3, 1, 2];
        for tasks in [&InTurn as &dyn Tasks, &Backwards] {
            assert_eq!(answers(tasks, &items, |item| 10 * item), [30, 10, 20]);
        }
    }
}
