//! A checked study and its verbs.

use std::path::PathBuf;
use std::sync::Arc;

use numpy::PyReadonlyArray1;
use pyo3::prelude::*;
use quell::document::{Node, Table};
use quell::run::basins::StartLayout;
use quell::run::bifurcation::SweepRequest;
use quell::run::fewer_contacts::{Conversion, FewerContacts};
use quell::run::moment::at_time;
use quell::run::response::ResponseTexts;
use quell::run::varied::Range;
use quell::study::{Files, key_at};
use quell::{Change, Complaints, Failure, RealInterval, Study};

use crate::answer::NativeAnswer;
use crate::arguments::{GivenState, Pair, ends};
use crate::verbs::attractor::TimeTexts;
use crate::verbs::basins::GivenPlane;
use crate::verbs::compare::RecordTexts;
use crate::verbs::map::Asked;
use crate::verbs::simulate::{Begin, GivenTimes, SoundTexts};
use crate::verbs::{
    actuator, attractor, basins, bifurcation, check, cite, compare, design, fit, friction, map,
    modes, orbit, probability, receptance, report, resonances, response, simulate, sketch,
    stability, thresholds, waveforms,
};
use crate::{call, convert, errors};

/// A checked study.
#[pyclass(name = "NativeStudy", module = "quell._quell", frozen)]
pub(crate) struct NativeStudy {
    inner: Arc<Study>,
    changes: Vec<(String, String)>,
    /// Axes in place of those of the text, each as (key, value).
    axes: Option<Vec<AxisKeys>>,
    /// Whether line numbers are meaningful to the user.
    has_lines: bool,
    /// The file from which it was read, which must not be an output.
    file: Option<PathBuf>,
}

/// Keys and values of an axis.
type AxisKeys = Vec<(String, String)>;

/// Everything needed to rebuild a study: text, folder, changes, axes, whether it has lines, the file from which it was read, and path
/// and contents of the files that it names.
type Parts = (
    String,
    PathBuf,
    Vec<(String, String)>,
    Option<Vec<AxisKeys>>,
    bool,
    Option<PathBuf>,
    Vec<(PathBuf, String)>,
);

impl NativeStudy {
    fn made(py: Python<'_>, parts: Parts) -> PyResult<Self> {
        let (text, folder, changes, axes, has_lines, file, held) = parts;
        let (made, swept, source) = (changes.clone(), axes.clone(), file.clone());
        let study = call::here(py, move || {
            let changes: Vec<Change> = made.iter().map(change).collect();
            let study = Study::parse_with(&text, &changes, &Files::holding(&folder, held));
            let study = study.and_then(|study| sweeping(study, swept.as_deref()));
            let study = lines_as_known(study, has_lines)?;
            Ok(match source {
                Some(file) => study.read_from(file),
                None => study,
            })
        })?;
        Ok(Self { inner: Arc::new(study), changes, axes, has_lines, file })
    }

    /// The same text with these changes and axes; its files are not read again.
    fn remade(
        &self,
        py: Python<'_>,
        changes: Vec<(String, String)>,
        axes: Option<Vec<AxisKeys>>,
    ) -> PyResult<Self> {
        let (study, has_lines) = (self.study(), self.has_lines);
        let (made, swept) = (changes.clone(), axes.clone());
        let study = call::here(py, move || {
            let changes: Vec<Change> = made.iter().map(change).collect();
            let study = study.changed(&changes);
            lines_as_known(study.and_then(|study| sweeping(study, swept.as_deref())), has_lines)
        })?;
        Ok(Self { inner: Arc::new(study), changes, axes, has_lines, file: self.file.clone() })
    }

    /// The study itself.
    pub(crate) fn study(&self) -> Arc<Study> {
        Arc::clone(&self.inner)
    }
}

/// A study, or complaints with the lines of its text only if the user knows this text.
fn lines_as_known(study: Result<Study, Complaints>, has_lines: bool) -> Result<Study, Failure> {
    study.map_err(|complaints| {
        Failure::Wrong(if has_lines { complaints } else { errors::without_lines(complaints) })
    })
}

fn sweeping(study: Study, axes: Option<&[AxisKeys]>) -> Result<Study, Complaints> {
    let Some(axes) = axes else { return Ok(study) };
    let table = |axis: &AxisKeys| {
        let mut table = Table::default();
        for (key, value) in axis {
            table.set(key, Node::from_argument(value, "axes"));
        }
        table
    };
    let tables: Vec<Table> = axes.iter().map(table).collect();
    study.sweeping(&tables)
}

pub(crate) fn change((path, value): &(String, String)) -> Change {
    Change { path: path.trim().to_owned(), node: Node::from_argument(value, "set") }
}

#[pymethods]
impl NativeStudy {
    /// Builds and checks a study from its parts.
    #[staticmethod]
    fn parse(py: Python<'_>, parts: Parts) -> PyResult<Self> {
        Self::made(py, parts)
    }

    /// Reads and checks a study file.
    #[staticmethod]
    fn read(py: Python<'_>, path: PathBuf, changes: Vec<(String, String)>) -> PyResult<Self> {
        let made = changes.clone();
        // The working directory may differ when the study is changed later.
        let file = std::path::absolute(&path).ok();
        let study = call::here(py, move || {
            let changes: Vec<Change> = made.iter().map(change).collect();
            Study::read(&path, &changes)
        })?;
        Ok(Self { inner: Arc::new(study), changes, axes: None, has_lines: true, file })
    }

    /// The same study with values changed as by `--set path=value`.
    fn changed(&self, py: Python<'_>, changes: Vec<(String, String)>) -> PyResult<Self> {
        let all = self.changes.iter().cloned().chain(changes).collect();
        self.remade(py, all, self.axes.clone())
    }

    /// The study of another text, without lines, that names the files of this one, which are not read again.
    fn rewritten(&self, py: Python<'_>, text: String) -> PyResult<Self> {
        let files = self.inner.files().clone();
        let study =
            call::here(py, move || lines_as_known(Study::parse_with(&text, &[], &files), false))?;
        Ok(Self {
            inner: Arc::new(study),
            changes: Vec::new(),
            axes: None,
            has_lines: false,
            file: None,
        })
    }

    /// The study as that of a system, with at most so many contacts on a surface; what was left out, and what that changes.
    fn converted(
        &self,
        py: Python<'_>,
        fewer: Option<(usize, f64)>,
    ) -> PyResult<(Self, Vec<String>)> {
        let study = self.study();
        let done = call::run(py, move || {
            Conversion::of(&study, fewer).map_err(|failure| match failure {
                Failure::Wrong(complaints) => Failure::Wrong(errors::without_lines(complaints)),
                failed @ Failure::Failed { .. } => failed,
            })
        })?;
        let mut warnings = done.warnings();
        warnings.extend(done.fewer().map(FewerContacts::sentence));
        let inner = Arc::new(done.study().clone());
        let study = Self { inner, changes: Vec::new(), axes: None, has_lines: false, file: None };
        Ok((study, warnings))
    }

    /// The same study with these axes in place of its own.
    fn swept(&self, py: Python<'_>, axes: Vec<AxisKeys>) -> PyResult<Self> {
        self.remade(py, self.changes.clone(), Some(axes))
    }

    /// Everything needed to rebuild this study, as [`parse`](Self::parse) takes it.
    fn parts(&self) -> Parts {
        let (text, files) = (self.inner.text().to_owned(), self.inner.files());
        let folder = files.folder().to_owned();
        let held = files.held().map(|(path, text)| (path.to_owned(), text.to_owned())).collect();
        let (changes, axes) = (self.changes.clone(), self.axes.clone());
        (text, folder, changes, axes, self.has_lines, self.file.clone(), held)
    }

    /// "belt", "disc" or "system".
    #[getter]
    fn kind(&self) -> &'static str {
        self.inner.kind().name()
    }

    /// Unit of the number at a path, in words; of a path that names no key none.
    fn unit(&self, path: &str) -> Option<&'static str> {
        let kind = self.inner.document_kind();
        let address = key_at(path, kind).ok()?;
        Some(address.key.unit_in_words(kind, self.inner.file_units()))
    }

    /// The title, if any.
    #[getter]
    fn title(&self) -> Option<&str> {
        self.inner.title()
    }

    /// Every value after its changes, as (path, value).
    #[getter]
    fn settings(&self) -> Vec<(String, String)> {
        self.inner.settings()
    }

    /// ω₀ of a belt in radians per second; none without units, and of other kinds.
    #[getter]
    fn angular_frequency(&self) -> Option<f64> {
        self.inner.scales().map(|scales| scales.angular_frequency())
    }

    fn check(&self, py: Python<'_>) -> PyResult<NativeAnswer> {
        let study = self.study();
        call::here(py, move || check::run(&study))
    }

    /// The mechanism as SVG; `path`: a file for it; `width`: a length with its unit.
    #[pyo3(signature = (path, width))]
    fn sketch(
        &self,
        py: Python<'_>,
        path: Option<PathBuf>,
        width: Option<String>,
    ) -> PyResult<String> {
        let study = self.study();
        call::run(py, move || sketch::run(&study, path.as_deref(), width.as_deref()))
    }

    /// The page of a report as HTML; `path`: a file for it; `without`: verbs to leave out.
    #[pyo3(signature = (path, without))]
    fn report(
        &self,
        py: Python<'_>,
        path: Option<PathBuf>,
        without: Vec<String>,
    ) -> PyResult<String> {
        let study = self.study();
        call::run(py, move || report::run(&study, path.as_deref(), without))
    }

    fn cite(&self, py: Python<'_>) -> PyResult<NativeAnswer> {
        let study = self.study();
        call::here(py, move || Ok(cite::run(&study)))
    }

    /// `at`: slip velocities in the units of the study; `texts`: slip velocities with units. If both are empty, a grid is used.
    /// `measured`: whether friction is also measured on steady responses.
    #[pyo3(signature = (at, texts, measured))]
    fn friction(
        &self,
        py: Python<'_>,
        at: Option<PyReadonlyArray1<'_, f64>>,
        texts: Vec<String>,
        measured: bool,
    ) -> PyResult<NativeAnswer> {
        let study = self.study();
        let at = at.map(|at| at.as_array().to_vec());
        call::run(py, move || friction::run(&study, at, &texts, measured))
    }

    /// `largest`: the largest velocity amplitude of the slow sinusoid.
    fn describing(&self, py: Python<'_>, largest: String) -> PyResult<NativeAnswer> {
        let study = self.study();
        call::run(py, move || friction::describing(&study, &largest))
    }

    /// `exact`: whether Floquet exponents of a dithered system decide.
    fn stability(&self, py: Python<'_>, exact: bool) -> PyResult<NativeAnswer> {
        let study = self.study();
        call::run(py, move || stability::run(&study, exact))
    }

    /// Eigenvalues of a system over a parameter; `along`: a second parameter and its range.
    #[pyo3(signature = (parameter, range, along))]
    fn tracked_stability(
        &self,
        py: Python<'_>,
        parameter: String,
        range: Pair,
        along: Option<(String, Pair)>,
    ) -> PyResult<NativeAnswer> {
        let study = self.study();
        call::run(py, move || stability::run_tracked(&study, parameter, &range, along))
    }

    /// `until`: τ, or a time with its unit; `kept`: whether events and samples are kept; `begin`: an exact time and state, a
    /// state of a belt with its time, or names of the state of a system with their values; `times`: those of the samples, as
    /// numbers or texts with units; `sound`: its transposition and gain.
    #[pyo3(signature = (until, kept, begin, times, sound))]
    fn simulate(
        &self,
        py: Python<'_>,
        until: Option<String>,
        kept: (bool, bool),
        begin: Option<Begin>,
        times: Option<GivenTimes>,
        sound: Option<SoundTexts>,
    ) -> PyResult<NativeAnswer> {
        let study = self.study();
        let asked = simulate::GivenRun { until, kept, begin, times, sound };
        call::run(py, move || simulate::run(&study, &asked))
    }

    /// Every key and value after the changes, as nested dicts and lists, with title and axes.
    fn document(&self, py: Python<'_>) -> PyResult<Py<PyAny>> {
        convert::to_python(py, &self.inner.document())
    }

    /// The document of the steady study of a moment.
    fn document_at(&self, py: Python<'_>, time: String) -> PyResult<Py<PyAny>> {
        let study = self.study();
        let steady = call::here(py, move || at_time(&study, &time))?;
        convert::to_python(py, &steady.document())
    }

    /// One run in which a drive, a load or an amplitude changes slowly.
    fn ramp(&self, py: Python<'_>) -> PyResult<NativeAnswer> {
        let study = self.study();
        call::run(py, move || bifurcation::ramp(&study))
    }

    /// The folder in which the files that the study names are searched.
    #[getter]
    fn folder(&self) -> PathBuf {
        self.inner.files().folder().to_owned()
    }

    /// Whether a dither is noise.
    fn is_noise(&self) -> bool {
        self.study().noise().is_some()
    }

    /// `settle` and `record`: times of the response; `window`: two times of a run; `seeds`: number of runs under noise.
    #[pyo3(signature = (settle, record, window, seeds))]
    fn response(
        &self,
        py: Python<'_>,
        settle: Option<String>,
        record: Option<String>,
        window: Option<(String, String)>,
        seeds: Option<usize>,
    ) -> PyResult<NativeAnswer> {
        let study = self.study();
        call::run(py, move || {
            let window = window.as_ref().map(|(from, to)| (from.as_str(), to.as_str()));
            let texts =
                ResponseTexts { settle: settle.as_deref(), record: record.as_deref(), window };
            response::run(&study, texts, seeds)
        })
    }

    /// `after`: name of a start; or `start`: a state. The run from there is followed to its response.
    #[pyo3(signature = (near, periods, after, start))]
    fn orbit(
        &self,
        py: Python<'_>,
        near: Option<GivenState>,
        periods: u32,
        after: Option<String>,
        start: Option<GivenState>,
    ) -> PyResult<NativeAnswer> {
        let study = self.study();
        call::run(py, move || {
            orbit::run(&study, near.as_ref(), periods, after.as_deref(), start.as_ref())
        })
    }

    /// `times`: before the record of the exponents and its length, if they are requested.
    #[pyo3(signature = (start, times))]
    fn attractor(
        &self,
        py: Python<'_>,
        start: Option<GivenState>,
        times: Option<TimeTexts>,
    ) -> PyResult<NativeAnswer> {
        let study = self.study();
        call::run(py, move || attractor::run(&study, start.as_ref(), times.as_ref()))
    }

    /// `runs`: names of starts, a further start as a state, and the time of their ramp; `near`: a state with its number of periods.
    #[pyo3(signature = (parameter, range, runs, near))]
    fn thresholds(
        &self,
        py: Python<'_>,
        parameter: String,
        range: thresholds::Ends,
        runs: (Vec<String>, Option<GivenState>, String),
        near: Option<(GivenState, u32)>,
    ) -> PyResult<NativeAnswer> {
        let study = self.study();
        call::run(py, move || {
            let (names, start, ramp) = &runs;
            let near = near.as_ref().map(|(state, periods)| (state, *periods));
            thresholds::run(&study, parameter, &range, (names, start.as_ref(), ramp), near)
        })
    }

    /// Threshold curves in the plane of two parameters.
    fn threshold_curves(
        &self,
        py: Python<'_>,
        parameter: String,
        range: thresholds::Ends,
        along: String,
        between: Pair,
    ) -> PyResult<NativeAnswer> {
        let study = self.study();
        call::run(py, move || thresholds::run_along(&study, parameter, &range, along, &between))
    }

    /// `ways`: whether the sweep up and the sweep down are requested.
    #[pyo3(signature = (parameter, range, points, ways, progress))]
    fn bifurcation(
        &self,
        py: Python<'_>,
        parameter: String,
        range: Pair,
        points: usize,
        ways: (bool, bool),
        progress: Option<Py<PyAny>>,
    ) -> PyResult<NativeAnswer> {
        let (up, down) = ways;
        let study = self.study();
        let range = call::here(py, move || {
            let RealInterval { lower: from, upper: to } = ends(&study, &parameter, &range)?;
            Ok(Range { parameter, from, to, points })
        })?;
        let request = SweepRequest { range, up, down };
        bifurcation::run(py, self.study(), request, progress)
    }

    /// `plane`: two names of the state with their windows, or windows of the first displacement and its velocity; `layout`: a grid, or
    /// instead a number of random states and a seed; `over`: a parameter with the ends of its range and the number of values.
    #[pyo3(signature = (plane, layout, over, threads, progress))]
    fn basins(
        &self,
        py: Python<'_>,
        plane: GivenPlane,
        layout: GivenLayout,
        over: Option<(String, Pair, usize)>,
        threads: Option<usize>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<NativeAnswer> {
        let study = self.study();
        let over = call::here(py, move || range_over(&study, over))?;
        let layout = match layout {
            (_, Some((count, seed))) => Some(StartLayout::Sample { count, seed }),
            (Some((columns, rows)), None) => Some(StartLayout::Grid { columns, rows }),
            (None, None) => None,
        };
        basins::run(py, self.study(), plane, (layout, over), threads, progress)
    }

    fn waveforms(&self, py: Python<'_>) -> PyResult<NativeAnswer> {
        let study = self.study();
        call::run(py, move || waveforms::run(&study))
    }

    fn design(&self, py: Python<'_>) -> PyResult<NativeAnswer> {
        let study = self.study();
        call::run(py, move || design::run(&study))
    }

    #[pyo3(signature = (frequency))]
    fn actuator(&self, py: Python<'_>, frequency: Option<Pair>) -> PyResult<NativeAnswer> {
        let study = self.study();
        call::run(py, move || actuator::run(&study, frequency.as_ref()))
    }

    #[pyo3(signature = (start, samples, seed, threads, progress))]
    fn probability(
        &self,
        py: Python<'_>,
        start: String,
        samples: Option<usize>,
        seed: u64,
        threads: Option<usize>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<NativeAnswer> {
        probability::run(py, self.study(), (start, samples, seed), threads, progress)
    }

    fn compare(
        &self,
        py: Python<'_>,
        files: (PathBuf, Option<PathBuf>),
        settle: Option<String>,
        record: RecordTexts,
    ) -> PyResult<NativeAnswer> {
        let study = self.study();
        call::run(py, move || compare::run(&study, files, settle.as_deref(), &record))
    }

    fn fit_record(
        &self,
        py: Python<'_>,
        asked: (PathBuf, Vec<String>, Vec<String>),
        settle: Option<String>,
        record: RecordTexts,
    ) -> PyResult<NativeAnswer> {
        fit::record(py, self.study(), asked, settle, record)
    }

    fn modes(&self, py: Python<'_>) -> PyResult<NativeAnswer> {
        let study = self.study();
        call::run(py, move || modes::run(&study))
    }

    fn receptance(
        &self,
        py: Python<'_>,
        rows: [Vec<String>; 2],
        contacts: String,
        frequencies: (Option<Pair>, Option<usize>, Vec<String>),
    ) -> PyResult<NativeAnswer> {
        let study = self.study();
        call::run(py, move || receptance::run(&study, rows, &contacts, &frequencies))
    }

    #[pyo3(signature = (speeds, order, clear, frequency))]
    fn resonances(
        &self,
        py: Python<'_>,
        speeds: Option<Pair>,
        order: String,
        clear: Option<Pair>,
        frequency: Option<Pair>,
    ) -> PyResult<NativeAnswer> {
        let study = self.study();
        call::run(py, move || resonances::run(&study, &order, [speeds, clear, frequency]))
    }

    /// `progress`: called with the number of finished points and the number of all points.
    #[pyo3(signature = (quantities, store, resume, threads, progress))]
    fn map(
        &self,
        py: Python<'_>,
        quantities: Vec<String>,
        store: Option<PathBuf>,
        resume: bool,
        threads: Option<usize>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<NativeAnswer> {
        let asked = Asked { study: self.study(), quantities, store, resume, threads };
        map::run(py, asked, progress)
    }

    /// Changes of the text, axes included, as `path=value`.
    #[getter]
    fn changes(&self) -> Vec<String> {
        self.inner.changes().to_vec()
    }
}

/// The parameter of `over` with its range.
fn range_over(
    study: &Study,
    over: Option<(String, Pair, usize)>,
) -> Result<Option<Range>, Failure> {
    let Some((parameter, range, points)) = over else { return Ok(None) };
    let RealInterval { lower: from, upper: to } = ends(study, &parameter, &range)?;
    Ok(Some(Range { parameter, from, to, points }))
}

/// A grid of starts, or a number of random ones and a seed.
type GivenLayout = (Option<(usize, usize)>, Option<(usize, u64)>);
