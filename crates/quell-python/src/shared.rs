//! A map that several processes compute into one store, for schedulers in Python.

use std::path::PathBuf;
use std::sync::Arc;

use pyo3::prelude::*;
use quell::map::Shared;
use quell::sweep::Shard;

use crate::answer::NativeAnswer;
use crate::study::NativeStudy;
use crate::verbs::map::{Counter, Watched, plan};
use crate::{call, convert, errors};

/// A map in a store that other processes may write at the same time.
#[pyclass(name = "NativeShared", module = "quell._quell", frozen)]
pub(crate) struct NativeShared {
    inner: Arc<Shared>,
}

#[pymethods]
impl NativeShared {
    /// Opens the store, or creates it.
    #[staticmethod]
    fn open(
        py: Python<'_>,
        study: &NativeStudy,
        quantities: Vec<String>,
        path: PathBuf,
    ) -> PyResult<Self> {
        let study = study.study();
        let shared = call::run(py, move || Shared::open(&path, plan(&study, &quantities)?))?;
        Ok(Self { inner: Arc::new(shared) })
    }

    /// Number of points of each chunk, in their order.
    fn points(&self) -> Vec<usize> {
        let chunks = self.inner.plan().chunks();
        (0..chunks.len()).map(|chunk| chunks.points(chunk).len()).collect()
    }

    /// Chunks that have no completion record yet.
    fn unrecorded(&self, py: Python<'_>) -> PyResult<Vec<usize>> {
        let inner = Arc::clone(&self.inner);
        call::run(py, move || inner.unrecorded())
    }

    /// Chunks that are missing or damaged; all chunks are read to find them.
    fn missing(&self, py: Python<'_>) -> PyResult<Vec<usize>> {
        let inner = Arc::clone(&self.inner);
        call::run(py, move || Ok(inner.missing()))
    }

    /// Rejects a text that is not a shard `k/n`, before a store is created.
    #[staticmethod]
    fn check_shard(py: Python<'_>, text: &str) -> PyResult<()> {
        read(py, text).map(drop)
    }

    /// Computes shard `k/n`: (facts, seconds).
    #[pyo3(signature = (text, threads, progress))]
    fn compute_shard(
        &self,
        py: Python<'_>,
        text: &str,
        threads: Option<usize>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<(Py<PyAny>, f64)> {
        let (inner, shard) = (Arc::clone(&self.inner), read(py, text)?);
        let counter = Arc::new(Counter::default());
        let watched = Watched::new(&counter, progress);
        let work = move || inner.compute_shard(shard, counter.running(threads));
        let done = call::watched(py, work, watched)?;
        let facts = convert::to_python(py, &done.json(self.inner.path()))?;
        Ok((facts, done.part.elapsed.as_secs_f64()))
    }

    /// Computes those of the chunks that are not in the store: (computed, there, damaged, points, seconds).
    #[pyo3(signature = (chunks, threads, progress))]
    fn compute(
        &self,
        py: Python<'_>,
        chunks: Vec<usize>,
        threads: Option<usize>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<(usize, usize, usize, usize, f64)> {
        let inner = Arc::clone(&self.inner);
        let counter = Arc::new(Counter::default());
        let watched = Watched::new(&counter, progress);
        let part =
            call::watched(py, move || inner.compute(&chunks, counter.running(threads)), watched)?;
        Ok((part.computed, part.there, part.damaged, part.points, part.elapsed.as_secs_f64()))
    }

    /// The whole map.
    fn read(&self, py: Python<'_>) -> PyResult<NativeAnswer> {
        let inner = Arc::clone(&self.inner);
        call::run(py, move || inner.read().map(|map| NativeAnswer::new(Box::new(map))))
    }
}

fn read(py: Python<'_>, text: &str) -> PyResult<Shard> {
    Shard::parse(text, "--shard").map_err(|complaint| errors::raised(py, complaint.into()))
}
