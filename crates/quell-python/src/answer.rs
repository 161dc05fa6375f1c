//! The answer of a verb: facts, datasets and the picture, converted on request.

use std::path::PathBuf;
use std::sync::Arc;

use pyo3::prelude::*;
use quell::dataset::Dataset;
use quell::outcome::{self, Outcome, friction_export};
use quell::output::Output;
use quell::picture::{self, EXTENSIONS, PicturePage, PictureWidth};
use quell::plot::Figure;
use quell::table_file::TableFormat;
use quell::{Complaint, Failure, Fault, Origin};
use serde_json::Value as Json;

use crate::{call, convert};

/// The answer of a verb.
#[pyclass(name = "NativeAnswer", module = "quell._quell", frozen)]
pub(crate) struct NativeAnswer {
    inner: Arc<dyn Outcome>,
}

impl NativeAnswer {
    pub(crate) fn new(outcome: Box<dyn Outcome>) -> Self {
        Self { inner: Arc::from(outcome) }
    }

    fn figure(&self) -> Result<Figure, Failure> {
        self.inner.figure().unwrap_or_else(|| {
            let allowed = "this result has no picture";
            Err(Complaint::new(Fault::Usage, "plot", Origin::Whole, Json::Null, allowed).into())
        })
    }
}

/// The complaint about a file of another program that the result does not have.
const NO_EXPORT: &str = "only averaged friction is saved as .inp, .m or .mo";

/// The datasets of an outcome. The events of a run are a field of its facts in Python, not a dataset.
fn tables(outcome: &dyn Outcome) -> Vec<(&'static str, Dataset)> {
    outcome.datasets().into_iter().filter(|(name, _)| *name != "events").collect()
}

#[pymethods]
impl NativeAnswer {
    /// The facts of the answer, as a dict.
    fn facts(&self, py: Python<'_>) -> PyResult<Py<PyAny>> {
        let facts = outcome::named(self.inner.as_ref(), self.inner.facts());
        convert::to_python(py, &facts)
    }

    /// (name, (provenance, axes, arrays)) of every dataset.
    fn datasets(&self, py: Python<'_>) -> PyResult<Vec<(&'static str, Py<PyAny>)>> {
        let inner = Arc::clone(&self.inner);
        let found = py.detach(move || tables(inner.as_ref()));
        found
            .into_iter()
            .map(|(name, dataset)| Ok((name, convert::dataset(py, dataset)?)))
            .collect()
    }

    /// The picture as data, for matplotlib.
    #[pyo3(signature = (width=None, caption=false, title=true))]
    fn description(
        &self,
        py: Python<'_>,
        width: Option<String>,
        caption: bool,
        title: bool,
    ) -> PyResult<Py<PyAny>> {
        let inner = Self { inner: Arc::clone(&self.inner) };
        let data = call::run(py, move || {
            let page = page(width.as_deref(), caption, title)?;
            Ok(page.laid_out(inner.figure()?).described())
        })?;
        convert::to_python(py, &data)
    }

    /// The picture as SVG.
    fn svg(&self, py: Python<'_>) -> PyResult<String> {
        let inner = Self { inner: Arc::clone(&self.inner) };
        call::run(py, move || Ok(inner.figure()?.to_svg()))
    }

    /// Writes the picture.
    #[pyo3(signature = (path, width=None, caption=false, title=true))]
    fn picture(
        &self,
        py: Python<'_>,
        path: PathBuf,
        width: Option<String>,
        caption: bool,
        title: bool,
    ) -> PyResult<String> {
        let inner = Self { inner: Arc::clone(&self.inner) };
        call::run(py, move || {
            let page = page(width.as_deref(), caption, title)?;
            let output = Output::prepare(&path, "path", EXTENSIONS, &inner.inner.inputs())?;
            picture::write(&page.laid_out(inner.figure()?), output)
        })
    }

    /// Writes the sound.
    fn sound(&self, py: Python<'_>, path: PathBuf) -> PyResult<String> {
        let inner = Arc::clone(&self.inner);
        call::run(py, move || {
            let output = Output::prepare(&path, "path", &["wav"], &inner.inputs())?;
            let sound = inner.sound().unwrap_or_else(|| {
                let allowed = "this result has no sound";
                let origin = Origin::Whole;
                Err(Complaint::new(Fault::Usage, "save", origin, Json::Null, allowed).into())
            });
            Ok(output.write(&sound?)?.display().to_string())
        })
    }

    /// Writes the datasets as a table, or the file of another program. Datasets after the first go to further files in the same
    /// folder if the format holds only one.
    fn table(&self, py: Python<'_>, path: PathBuf) -> PyResult<Vec<String>> {
        let inner = Arc::clone(&self.inner);
        call::run(py, move || {
            let inputs = inner.inputs();
            let extensions = [TableFormat::EXTENSIONS, friction_export::EXTENSIONS].concat();
            let first = Output::prepare(&path, "path", &extensions, &inputs)?;
            let extension = first.extension();
            let format = TableFormat::of_extension(&extension);
            if let Some(bytes) = inner.exported(&extension) {
                return Ok(vec![first.write(&bytes?)?.display().to_string()]);
            }
            let datasets = match format {
                Some(TableFormat::Csv) => tables(inner.as_ref()),
                _ => inner.datasets(),
            };
            let Some(format) = format.filter(|_| !datasets.is_empty()) else {
                let allowed =
                    if datasets.is_empty() { "this result has no table" } else { NO_EXPORT };
                let (fault, origin) = (Fault::Usage, Origin::Whole);
                return Err(Complaint::new(fault, "save", origin, Json::Null, allowed).into());
            };
            let mut outputs = Vec::new();
            for (name, _) in datasets.iter().skip(1).filter(|_| !format.holds_all()) {
                outputs.push(first.sibling(name, "path", &inputs)?);
            }
            outputs.insert(0, first);
            let files = format.files(&datasets, "path")?;
            let written = outputs.into_iter().zip(files);
            written.map(|(output, file)| Ok(output.write(&file)?.display().to_string())).collect()
        })
    }
}

/// The page of a picture from the arguments of Python.
pub(crate) fn page(
    width: Option<&str>,
    caption: bool,
    title: bool,
) -> Result<PicturePage, Failure> {
    let width = width.map(|text| PictureWidth::parse(text, "width")).transpose()?;
    Ok(PicturePage { width, caption, without_title: !title })
}
