//! `map`: quantities over the axes of a study, computed, stored and resumed.

mod boundary;
mod outcome;
mod shared;

use quell_input::said::{Mention, Said};
use std::sync::Mutex;
use std::time::Instant;

use crate::complaint::Failure;
use crate::running::Running;
use crate::store::{ChunkState, Store};
use crate::sweep::{self, Data, Plan};

pub use boundary::{Boundary, amplitude_and_other, boundaries, boundaries_at};
pub use outcome::{Extreme, FinishedMap, Summary};
pub use shared::{Part, Sharded, Shared};

/// Computes a map. With a store, every finished chunk is kept there, and chunks that it already has are
/// not computed again.
///
/// # Errors
/// [`Failure::Failed`] if it was stopped, if the store could not be written, or if the
/// store holds other bits than this program computes; the message states how much is left.
pub fn run(
    plan: Plan,
    store: Option<&Store>,
    running: Running<'_>,
) -> Result<FinishedMap, Failure> {
    let begun = Instant::now();
    let points = plan.grid().len();
    let mut arrays = plan.sheet().missing(points);
    let Earlier { todo, resumed, damaged } = earlier(&plan, store, &mut arrays)?;
    running.progress.begin(points, resumed);
    let arrays = Mutex::new((arrays, 0_usize));
    let outcome = sweep::run(&plan, &todo, running, |number, values| {
        if let Some(store) = store {
            store.write(&plan, number, &values)?;
        }
        // A panic of a thread here ends the program, so a poisoned lock holds no data in use.
        let mut shared = arrays.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        put(&plan, number, &values, &mut shared.0);
        shared.1 += 1;
        Ok(())
    });
    running.progress.end();
    let (arrays, done) = arrays.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner);
    let left = todo.len() - done;
    let chunks = plan.chunks().len();
    match outcome {
        Ok(()) if left == 0 => {
            Ok(FinishedMap { plan, arrays, resumed, damaged, elapsed: begun.elapsed() })
        }
        Ok(()) => Err(stopped(store, left, chunks)),
        Err(failure) => Err(interrupted(failure, store, left, chunks)),
    }
}

/// The part of a map that a store already has.
struct Earlier {
    /// Chunks still to be computed.
    todo: Vec<usize>,
    /// Points found in the store.
    resumed: usize,
    /// Damaged chunks found in the store.
    damaged: usize,
}

/// Reads the chunks of the store.
fn earlier(plan: &Plan, store: Option<&Store>, arrays: &mut [Data]) -> Result<Earlier, Failure> {
    let mut earlier = Earlier { todo: Vec::new(), resumed: 0, damaged: 0 };
    for number in 0..plan.chunks().len() {
        match store.map_or(ChunkState::Nothing, |store| store.read(plan, number)) {
            ChunkState::Whole(values) => {
                if let Some(store) = store.filter(|_| earlier.resumed == 0) {
                    same_program(plan, store, number, &values)?;
                }
                put(plan, number, &values, arrays);
                earlier.resumed += plan.chunks().points(number).len();
            }
            ChunkState::Damaged => {
                earlier.damaged += 1;
                earlier.todo.push(number);
            }
            ChunkState::Nothing => earlier.todo.push(number),
        }
    }
    Ok(earlier)
}

/// Checks that this program gives the bits that the store holds, by computing one stored point
/// again. Versions are compared when a store is opened; this finds differences without a version.
fn same_program(plan: &Plan, store: &Store, number: usize, values: &[Data]) -> Result<(), Failure> {
    let first = plan.chunks().points(number).into_iter().take(1).map(|(_, index)| index);
    let again = plan.compute_points(first);
    if values.iter().zip(&again).all(|(old, new)| old.same_bits(0, new, 0)) {
        return Ok(());
    }
    Err(Failure::Failed {
        key: store.path().display().to_string(),
        why: "this build of Quell computes a stored point with different bits (the store was made by another \
              build): choose another name"
            .into(),
    })
}

fn put(plan: &Plan, number: usize, values: &[Data], arrays: &mut [Data]) {
    for (from, (_, to)) in plan.chunks().points(number).into_iter().enumerate() {
        for (array, values) in arrays.iter_mut().zip(values) {
            array.take(to, values, from);
        }
    }
}

/// A text, and how a stored map is continued.
fn continues(said: Said) -> Said {
    said.mention(Mention::SameRequest).text(" with ").mention(Mention::Resume).text(" continues")
}

fn stopped(store: Option<&Store>, left: usize, chunks: usize) -> Failure {
    let done = chunks - left;
    match store {
        Some(store) => Failure::Failed {
            key: store.path().display().to_string(),
            why: continues(
                format!("stopped; {done} of {chunks} chunks kept, {left} left: ").into(),
            ),
        },
        None => Failure::Failed {
            key: "map".to_owned(),
            why: Said::from("stopped; nothing was kept: ")
                .mention(Mention::Store)
                .text(" keeps finished chunks, and ")
                .mention(Mention::Resume)
                .text(" continues"),
        },
    }
}

fn interrupted(failure: Failure, store: Option<&Store>, left: usize, chunks: usize) -> Failure {
    match (failure, store) {
        (Failure::Failed { key, why }, Some(_)) => Failure::Failed {
            key,
            why: continues(why.text(format!(
                "; {} of {chunks} chunks kept, {left} left: once the cause is fixed, ",
                chunks - left
            ))),
        },
        (failure, _) => failure,
    }
}
