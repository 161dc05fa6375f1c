//! A map that several processes, on one or more machines, compute into one store.
//!
//! ```text
//! study, quantities → Plan ┐
//! path of the store        ┴→ Shared: missing → compute some chunks → … → read the whole map
//! ```
//!
//! The processes share nothing but the store. A scheduler (shards of a Slurm array, a scheduler in Python) may hand out
//! chunks in any order, hand one out twice, and lose workers: a chunk counts once its completion record exists, and it
//! has the same bytes for any writer.

use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

use serde_json::{Value as Json, json};

use super::outcome::recomputed;
use super::{FinishedMap, put, same_program};
use crate::complaint::{Complaint, Failure, Fault, Origin};
use crate::running::Running;
use crate::store::{ChunkState, Store};
use crate::sweep::{self, Plan, Shard};

/// A map in a store that other processes may write at the same time.
#[derive(Debug)]
pub struct Shared {
    plan: Plan,
    store: Store,
}

/// Result of a call of [`Shared::compute`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Part {
    /// Chunks computed.
    pub computed: usize,
    /// Chunks that were already in the store, verified.
    pub there: usize,
    /// Number of computed chunks that were in the store but damaged.
    pub damaged: usize,
    /// Points of the computed chunks.
    pub points: usize,
    /// Elapsed time.
    pub elapsed: Duration,
}

/// A computed shard, and the rest of the map.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Sharded {
    /// The shard.
    pub shard: Shard,
    /// Number of its chunks.
    pub chunks: usize,
    /// Result of the computation.
    pub part: Part,
    /// Number of chunks of the whole map.
    pub map_chunks: usize,
    /// Chunks of the whole map that are not computed yet.
    pub left: usize,
    /// Numbers of the shards that contain them, ascending.
    pub left_shards: Vec<usize>,
}

impl Sharded {
    /// As JSON, with the path of the store.
    pub fn json(&self, path: &Path) -> Json {
        json!({
            "ok": true,
            "shard": { "number": self.shard.number(), "of": self.shard.of() },
            "chunks": self.chunks,
            "computed_chunks": self.part.computed,
            "there_chunks": self.part.there,
            "damaged_chunks": self.part.damaged,
            "computed_points": self.part.points,
            "map_chunks": self.map_chunks,
            "left_chunks": self.left,
            "left_shards": self.left_shards,
            "saved": [path.display().to_string()],
            "warnings": self.warnings(),
        })
    }

    /// Warnings about the store.
    pub fn warnings(&self) -> Vec<String> {
        let damaged = self.part.damaged;
        if damaged > 0 { vec![recomputed(damaged)] } else { Vec::new() }
    }
}

impl Shared {
    /// Opens the store at `path`, or creates it. Any number of processes may do so at once.
    ///
    /// # Errors
    /// The failures of [`Store::open_shared`]; [`Failure::Failed`] if the store holds other bits
    /// at a point than this program computes.
    pub fn open(path: &Path, plan: Plan) -> Result<Self, Failure> {
        let store = Store::open_shared(path, &plan)?;
        let shared = Self { plan, store };
        let unrecorded = shared.store.unrecorded(&shared.plan)?;
        // The first chunk that is missing from this ascending list.
        let first = unrecorded.iter().enumerate().position(|(at, &chunk)| at != chunk);
        let first = first.unwrap_or(unrecorded.len());
        if first < shared.plan.chunks().len()
            && let ChunkState::Whole(values) = shared.store.read(&shared.plan, first)
        {
            same_program(&shared.plan, &shared.store, first, &values)?;
        }
        Ok(shared)
    }

    /// The plan; its chunks are numbered from 0 to `plan().chunks().len()` − 1.
    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    /// Chunks that are missing or damaged: every recorded chunk is read and verified.
    /// On a network file system a chunk that another machine has just written may still appear missing;
    /// computing it again does no harm.
    pub fn missing(&self) -> Vec<usize> {
        let whole =
            |&chunk: &usize| matches!(self.store.read(&self.plan, chunk), ChunkState::Whole(_));
        (0..self.plan.chunks().len()).filter(|chunk| !whole(chunk)).collect()
    }

    /// Chunks that have no completion record yet. Fast, because no chunk is read; later damage to a chunk
    /// is not noticed.
    ///
    /// # Errors
    /// [`Failure::Wrong`] if the records cannot be listed.
    pub fn unrecorded(&self) -> Result<Vec<usize>, Failure> {
        self.store.unrecorded(&self.plan)
    }

    /// Computes the given chunks that are missing or damaged, and stores each as soon as it is
    /// done.
    ///
    /// # Errors
    /// [`Failure::Wrong`] for an invalid chunk number; [`Failure::Failed`] if it was
    /// stopped or the store could not be written. Chunks finished by then are kept.
    pub fn compute(&self, chunks: &[usize], running: Running<'_>) -> Result<Part, Failure> {
        self.known(chunks)?;
        let begun = Instant::now();
        let mut part =
            Part { computed: 0, there: 0, damaged: 0, points: 0, elapsed: Duration::ZERO };
        let mut todo = Vec::new();
        let (mut points, mut points_there) = (0, 0);
        for &chunk in chunks {
            let size = self.plan.chunks().points(chunk).len();
            points += size;
            match self.store.read(&self.plan, chunk) {
                ChunkState::Whole(_) => {
                    part.there += 1;
                    points_there += size;
                    continue;
                }
                ChunkState::Damaged => part.damaged += 1,
                ChunkState::Nothing => {}
            }
            todo.push(chunk);
        }
        running.progress.begin(points, points_there);
        let done = AtomicUsize::new(0);
        let outcome = sweep::run(&self.plan, &todo, running, |chunk, values| {
            self.store.write(&self.plan, chunk, &values)?;
            done.fetch_add(1, Ordering::Relaxed);
            Ok(())
        });
        running.progress.end();
        let left = todo.len() - done.into_inner();
        match outcome {
            Ok(()) if left == 0 => {
                part.computed = todo.len();
                part.points = points - points_there;
                part.elapsed = begun.elapsed();
                Ok(part)
            }
            Ok(()) => Err(self.incomplete("stopped", left, chunks.len())),
            Err(Failure::Failed { why, .. }) => Err(self.incomplete(&why, left, chunks.len())),
            Err(wrong) => Err(wrong),
        }
    }

    /// Computes the chunks of a shard with [`Shared::compute`], and lists the rest of the map.
    ///
    /// # Errors
    /// Those of [`Shared::compute`] and [`Shared::unrecorded`].
    pub fn compute_shard(&self, shard: Shard, running: Running<'_>) -> Result<Sharded, Failure> {
        let chunks = shard.chunks(self.plan.chunks());
        let part = self.compute(&chunks, running)?;
        let left = self.unrecorded()?;
        let mut left_shards: Vec<usize> =
            left.iter().map(|&chunk| shard.number_of(chunk)).collect();
        left_shards.sort_unstable();
        left_shards.dedup();
        let map_chunks = self.plan.chunks().len();
        Ok(Sharded { shard, chunks: chunks.len(), part, map_chunks, left: left.len(), left_shards })
    }

    /// Reads the whole map back.
    ///
    /// # Errors
    /// [`Failure::Failed`] if chunks are missing; the message states how many.
    pub fn read(&self) -> Result<FinishedMap, Failure> {
        let begun = Instant::now();
        let points = self.plan.grid().len();
        let mut arrays = self.plan.sheet().missing(points);
        let (mut missing, mut damaged) = (0, 0);
        for chunk in 0..self.plan.chunks().len() {
            match self.store.read(&self.plan, chunk) {
                ChunkState::Whole(values) => put(&self.plan, chunk, &values, &mut arrays),
                ChunkState::Damaged => damaged += 1,
                ChunkState::Nothing => missing += 1,
            }
        }
        if missing + damaged == 0 {
            let plan = self.plan.clone();
            return Ok(FinishedMap {
                plan,
                arrays,
                resumed: points,
                damaged: 0,
                elapsed: begun.elapsed(),
            });
        }
        let chunks = self.plan.chunks().len();
        let changed = match damaged {
            0 => String::new(),
            damaged => format!(", and {damaged} are truncated or changed"),
        };
        Err(self.failed(format!("{missing} of {chunks} chunks are not computed yet{changed}")))
    }

    /// Path of the store.
    pub fn path(&self) -> &Path {
        self.store.path()
    }

    fn known(&self, chunks: &[usize]) -> Result<(), Failure> {
        let count = self.plan.chunks().len();
        let unknown = chunks.iter().filter(|&&chunk| chunk >= count);
        let complaints: Vec<Complaint> = unknown
            .map(|&chunk| {
                let allowed = format!("a chunk number from 0 to {}", count - 1);
                Complaint::new(Fault::Value, "chunk", Origin::Whole, chunk, allowed)
            })
            .collect();
        if complaints.is_empty() { Ok(()) } else { Err(complaints.into()) }
    }

    fn incomplete(&self, why: &str, left: usize, chunks: usize) -> Failure {
        let done = chunks - left;
        self.failed(format!(
            "{why}; {done} of the {chunks} requested chunks kept, {left} left: run it again to continue"
        ))
    }

    fn failed(&self, why: String) -> Failure {
        Failure::Failed { key: self.path().display().to_string(), why: why.into() }
    }
}

#[cfg(test)]
mod tests {
    use std::fs;
    use std::sync::atomic::AtomicBool;

    use super::*;
    use crate::status::Status;
    use crate::study::BeltStudy;
    use crate::sweep::MapQuantity;

    const TEXT: &str = "schema = 1\n[belt]\ndamping_ratio = 0.01\nnormal_load = 0.5\n\
        belt_velocity = 0.1\n[friction]\nlaw = \"decreasing\"\nstatic_coefficient = 0.4\n\
        minimum_coefficient = 0.2\nreference_velocity = 0.2\n[dither]\ndirection = \"normal\"\n\
        waveform = \"sine\"\namplitude = 0.1\nfrequency_ratio = 10\n\
        [[sweep]]\nparameter = \"dither.amplitude\"\nfrom = 0.1\nto = 0.4\npoints = 300\n\
        [[sweep]]\nparameter = \"belt.belt_velocity\"\nfrom = 0.05\nto = 0.2\npoints = 300\n";

    fn plan() -> Plan {
        let study = BeltStudy::parse(TEXT, &[]).expect("valid");
        Plan::new(&study, &[MapQuantity::named("growth", "--quantity").expect("a quantity")])
            .expect("two axes")
    }

    fn running(stop: &AtomicBool) -> Running<'_> {
        Running { threads: Some(1), stop, progress: &() }
    }

    #[test]
    fn two_workers_make_a_map_chunk_by_chunk() {
        let place = tempfile::tempdir().expect("a folder");
        let path = place.path().join("m.zarr");
        let go = AtomicBool::new(false);
        let (one, other) = (Shared::open(&path, plan()), Shared::open(&path, plan()));
        let (one, other) = (one.expect("made"), other.expect("opened"));
        let all: Vec<usize> = (0..plan().chunks().len()).collect();
        assert!(all.len() > 2, "one chunk is no test");
        assert_eq!(one.missing(), all);
        let mut last_first = all.clone();
        last_first.reverse();
        let part = one.compute(&last_first[..2], running(&go)).expect("computed");
        assert_eq!((part.computed, part.there), (2, 0));
        assert_eq!(other.missing(), all[..all.len() - 2]);
        let early = other.read().expect_err("chunks are missing").to_string();
        assert!(early.contains("chunks are not computed yet"), "{early}");
        let part = other.compute(&all, running(&go)).expect("computed");
        assert_eq!((part.computed, part.there), (all.len() - 2, 2));
        assert!(one.missing().is_empty() && one.unrecorded().expect("a list").is_empty());
        let map = one.read().expect("whole");
        let here = plan().compute_points(0..plan().grid().len());
        let entry = map.plan().sheet().entries()[0];
        for point in 0..plan().grid().len() {
            assert_eq!(map.status(&entry, point), Status::Known);
            let value = map.number(&entry, point).expect("known");
            let sweep::Data::Numbers(values) = &here[entry.value] else {
                panic!("growth is a number");
            };
            assert_eq!(value.to_bits(), values[point].to_bits());
        }
    }

    #[test]
    fn a_damaged_chunk_is_missing_and_stopping_says_what_is_left() {
        let place = tempfile::tempdir().expect("a folder");
        let path = place.path().join("m.zarr");
        let (go, stop) = (AtomicBool::new(false), AtomicBool::new(true));
        let shared = Shared::open(&path, plan()).expect("made");
        shared.compute(&[0, 1], running(&go)).expect("computed");
        fs::write(path.join("growth/c/0/0"), "short").expect("damaged");
        assert!(shared.missing().contains(&0) && !shared.missing().contains(&1));
        let stopped = shared.compute(&[0, 1, 2], running(&stop)).expect_err("stopped").to_string();
        assert!(stopped.contains("1 of the 3 requested chunks kept, 2 left"), "{stopped}");
        assert_eq!(shared.compute(&[0], running(&go)).expect("computed").damaged, 1);
        let wrong = shared.compute(&[0, 1_000_000], running(&go)).expect_err("no such chunk");
        assert!(wrong.to_string().contains("1000000"), "{wrong}");
    }
}
