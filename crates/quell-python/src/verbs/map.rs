//! `map`: quantities over the axes of a study.

use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use pyo3::prelude::*;
use quell::map::run as front_door;
use quell::running::{MOST_THREADS, Progress, Running};
use quell::store::Store;
use quell::sweep::{MapQuantity, Plan};
use quell::{Failure, Study};

use super::refused;
use crate::answer::NativeAnswer;
use crate::call::{self, Watch};

/// The arguments of `map`.
pub(crate) struct Asked {
    /// The study with its axes.
    pub(crate) study: Arc<Study>,
    /// Names of quantities.
    pub(crate) quantities: Vec<String>,
    /// A Zarr store in which the map is saved.
    pub(crate) store: Option<PathBuf>,
    /// Whether to continue an existing store.
    pub(crate) resume: bool,
    /// Number of threads.
    pub(crate) threads: Option<usize>,
}

/// Progress, shared between two threads.
#[derive(Default)]
pub(crate) struct Counter {
    all: AtomicUsize,
    there: AtomicUsize,
    stop: AtomicBool,
}

impl Counter {
    /// Settings of the run whose points are counted here.
    pub(crate) fn running(&self, threads: Option<usize>) -> Running<'_> {
        Running { threads, stop: &self.stop, progress: self }
    }
}

impl Progress for Counter {
    fn begin(&self, points: usize, there: usize) {
        self.all.store(points, Ordering::Relaxed);
        self.there.store(there, Ordering::Relaxed);
    }

    fn advance(&self, points: usize) {
        self.there.fetch_add(points, Ordering::Relaxed);
    }

    fn end(&self) {}
}

/// Reports progress to Python; a signal stops the work after the chunks in progress.
pub(crate) struct Watched {
    counter: Arc<Counter>,
    progress: Option<Py<PyAny>>,
    reported: Option<usize>,
}

impl Watched {
    pub(crate) fn new(counter: &Arc<Counter>, progress: Option<Py<PyAny>>) -> Self {
        Self { counter: Arc::clone(counter), progress, reported: None }
    }
}

impl Watch for Watched {
    fn tick(&mut self, py: Python<'_>) -> PyResult<()> {
        let all = self.counter.all.load(Ordering::Relaxed);
        let there = self.counter.there.load(Ordering::Relaxed);
        let Some(progress) = &self.progress else { return Ok(()) };
        if all > 0 && self.reported != Some(there) {
            self.reported = Some(there);
            progress.call1(py, (there, all))?;
        }
        Ok(())
    }

    fn stop(&self) -> bool {
        self.counter.stop.store(true, Ordering::Relaxed);
        true
    }
}

/// The plan of a map.
pub(crate) fn plan(study: &Study, names: &[String]) -> Result<Plan, Failure> {
    let (mut asked, mut wrong) = (Vec::new(), Vec::new());
    for name in names {
        match MapQuantity::named(name.trim(), "quantity") {
            Ok(quantity) => asked.push(quantity),
            Err(complaint) => wrong.push(*complaint),
        }
    }
    match Plan::new(study, &asked) {
        Ok(plan) if wrong.is_empty() => Ok(plan),
        Ok(_) => Err(wrong.into()),
        Err(complaint) => {
            wrong.push(*complaint);
            Err(wrong.into())
        }
    }
}

/// Runs the verb.
pub(crate) fn run(
    py: Python<'_>,
    asked: Asked,
    progress: Option<Py<PyAny>>,
) -> PyResult<NativeAnswer> {
    let counter = Arc::new(Counter::default());
    let watched = Watched::new(&counter, progress);
    let work = move || {
        let Asked { study, quantities, store, resume, threads } = asked;
        if threads.is_some_and(|threads| !(1..=MOST_THREADS).contains(&threads)) {
            let allowed = format!("a whole number from 1 to {MOST_THREADS}");
            return Err(refused("threads", threads.unwrap_or(0), &allowed));
        }
        let plan = plan(&study, &quantities)?;
        let store = store.map(|path| Store::open(&path, &plan, resume)).transpose()?;
        let done = front_door(plan, store.as_ref(), counter.running(threads))?;
        Ok(NativeAnswer::new(Box::new(done)))
    };
    call::watched(py, work, watched)
}
