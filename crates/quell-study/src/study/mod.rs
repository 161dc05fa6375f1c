//! The study file: text, its document, and the checked study.
//!
//! `study.toml` → [`quell_input::document::Table`] → [`Study`], which is valid by construction. All errors are reported together, with
//! key, line, value, allowed values, and the nearest valid key.
//!
//! One [`Study`] serves every kind: the parts that all kinds share (title, axes, text, changes) are read here, the rest by
//! the kind ([`StudyKind`]). [`Kind`] lists the kinds; adding one is a file like `belt/mod.rs` or `disc/mod.rs`, its keys in
//! [`vocabulary`], and a variant there.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use quell_input::complaint::{Complaint, Complaints, Failure, Fault, Origin};
use quell_input::document::{Table, Value};
use quell_input::input::Inputs;
use quell_model::units::measure;
use serde_json::Value as Json;

use computed::Computed;
use reader::StudyParts;
use vocabulary::{DocumentKind, SCHEMA_VERSION};

mod actuator;
mod address;
mod band;
pub mod belt;
mod change;
mod computed;
mod converted;
mod course;
mod design;
pub mod disc;
pub(crate) mod dither_size;
mod fewer_contacts;
mod friction;
mod kind;
mod model;
pub mod passivity;
mod path;
pub mod plausible;
mod reader;
mod root;
mod steady;
mod study_kind;
pub mod suggest;
mod sweep;
pub mod system;
mod template;
mod uncertainty;
pub mod vocabulary;
mod waveform;
mod without_units;

pub use address::NumberAddress;
pub use belt::{BeltSetup, BeltStudy};
pub use change::Change;
pub use converted::ConvertedStudy;
pub use design::{BurstNumber, Confidence, Design, DesignRange, DitherPlace};
pub use disc::{DiscSetup, DiscStudy};
pub use dither_size::GivenSize;
pub use friction::Measured;
pub use kind::{Kind, Study};
pub use model::{Model, ParameterId};
pub use path::{Address, key_at, with_unit};
pub use quell_dynamics::response::Solver;
pub use quell_input::files::Files;
pub use quell_model::units::UnitSystem;
pub use steady::{not_periodic, varies_in_time};
pub use study_kind::{StudyKind, not_available};
pub use sweep::{Axis, Sweep};
pub use system::{
    FrequencyResponse, RecordSettings, ScaledTime, SystemSetup, SystemStart, SystemStudy,
};
pub use uncertainty::Uncertainty;

/// A checked study of the kind `K`: of any kind ([`Study`]), of a belt ([`BeltStudy`]), of a disc ([`DiscStudy`]),
/// of a system ([`SystemStudy`]).
#[derive(Clone, Debug, PartialEq)]
pub struct StudyOf<K> {
    kind: K,
    source: Arc<StudySource>,
}

/// What every kind of study shares.
#[derive(Clone, Debug, PartialEq)]
struct StudySource {
    title: Option<String>,
    sweeps: Vec<Sweep>,
    uncertainty: Option<Uncertainty>,
    document: Table,
    text: Arc<str>,
    /// The files that the study names.
    files: Files,
    computed: Computed,
    parts: StudyParts,
    /// What it was read as, whichever kind it is answered as.
    declared: Kind,
    /// The file that it was read from; `-` is standard input.
    file: Option<PathBuf>,
    changes: Vec<String>,
}

/// Where a document comes from, and what is known of it before it is read.
#[derive(Clone, Debug)]
struct DocumentOrigin {
    text: Arc<str>,
    files: Files,
    computed: Computed,
    file: Option<PathBuf>,
    changes: Vec<String>,
}

/// Largest number of changes that a title names.
const CHANGES_IN_TITLE: usize = 3;

/// A title without the number of a figure or table of the dissertation: "Figure 2.4: effective friction" is "Effective friction".
fn without_figure(title: &str) -> String {
    let rest = ["Figure ", "Table "].iter().find_map(|kind| {
        let (number, rest) = title.strip_prefix(kind)?.split_once(": ")?;
        number.chars().all(|letter| letter.is_ascii_digit() || letter == '.').then_some(rest)
    });
    let Some(rest) = rest else { return title.to_owned() };
    let mut letters = rest.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

impl<K: StudyKind + Into<Kind>> StudyOf<K> {
    /// Reads and checks a study file (`-` is standard input) after changing it.
    ///
    /// # Errors
    /// All complaints together.
    pub fn read(path: &Path, changes: &[Change]) -> Result<Self, Failure> {
        let text = quell_input::study_file::text(path)?;
        let folder = path.parent().unwrap_or(Path::new(""));
        Ok(Self::parse_in(&text, changes, folder)?.read_from(quell_input::study_file::place(path)))
    }

    /// Checks the text of a study after changing it; files that it names are searched in the working directory.
    ///
    /// # Errors
    /// All complaints together.
    pub fn parse(text: &str, changes: &[Change]) -> Result<Self, Complaints> {
        Self::parse_in(text, changes, Path::new(""))
    }

    /// Checks the text of a study after changing it; files that it names are searched in `folder`.
    ///
    /// # Errors
    /// All errors together, those of the changes and those of the check.
    pub fn parse_in(text: &str, changes: &[Change], folder: &Path) -> Result<Self, Complaints> {
        Self::parse_with(text, changes, &Files::in_folder(folder))
    }

    /// Checks the text of a study after changing it; files that it names are taken from `files`, where they are held.
    ///
    /// # Errors
    /// All errors together, those of the changes and those of the check.
    pub fn parse_with(text: &str, changes: &[Change], files: &Files) -> Result<Self, Complaints> {
        let from = DocumentOrigin {
            text: text.into(),
            files: files.to_read_again(),
            computed: Computed::default(),
            file: None,
            changes: changes.iter().map(Change::to_string).collect(),
        };
        Self::compile(from, changes)
    }

    /// The text of this study with these changes in place of its own; files are not read again.
    ///
    /// # Errors
    /// All errors together, those of the changes and those of the check.
    pub fn changed(&self, changes: &[Change]) -> Result<Self, Complaints> {
        Self::compile(self.origin_with(changes.iter().map(Change::to_string).collect()), changes)
    }

    /// Changes and checks a text.
    fn compile(from: DocumentOrigin, changes: &[Change]) -> Result<Self, Complaints> {
        let mut document = Table::parse(&from.text)?;
        let mut refused: Vec<Complaint> = changes
            .iter()
            .filter_map(|change| change.apply(&mut document).err())
            .map(|complaint| *complaint)
            .collect();
        document.unprintable("", &mut refused);
        match Self::check(document, from) {
            Ok(study) if refused.is_empty() => Ok(study),
            Ok(_) => Err(refused.into()),
            Err(complaints) => Err(complaints.and(refused)),
        }
    }

    /// The same study, which was read from this file.
    #[must_use]
    pub fn read_from(self, file: PathBuf) -> Self {
        let source =
            Arc::new(StudySource { file: Some(file), ..Arc::unwrap_or_clone(self.source) });
        Self { source, ..self }
    }

    /// The same study with one number changed, by any path of the file, SI twins included; its axes stay.
    ///
    /// # Errors
    /// All complaints about the changed study.
    pub fn with(&self, path: &str, value: f64) -> Result<Self, Complaints> {
        let mut document = self.source.document.clone();
        Change::number(path, value, Origin::Whole).apply(&mut document)?;
        let mut changes = self.source.changes.clone();
        changes.push(format!("{path}={value:?}"));
        self.check_again(document, changes)
    }

    /// The study at one point of a map or of a sample: its numbers set in order as by `--set`, without axes and distributions. It equals the study that the
    /// file would give with these changes.
    ///
    /// # Errors
    /// All complaints about the changed study.
    pub fn at<'a>(
        &self,
        numbers: impl IntoIterator<Item = (&'a str, f64)>,
    ) -> Result<Self, Complaints> {
        let mut document = self.source.document.clone();
        document.remove("sweep");
        document.remove("uncertainty");
        let mut changes = self.source.changes.clone();
        for (path, value) in numbers {
            let change =
                Change::number(path, value, Origin::Argument("a point of a sweep or a sample"));
            change.apply(&mut document)?;
            changes.push(change.to_string());
        }
        self.check_again(document, changes)
    }

    /// The same study with these axes in place of its own.
    ///
    /// # Errors
    /// All complaints about the axes.
    pub fn sweeping(&self, axes: &[Table]) -> Result<Self, Complaints> {
        let mut document = self.source.document.clone();
        sweep::replace(&mut document, axes);
        self.check_again(document, sweep::changes(&self.source.changes, axes))
    }

    /// Checks the changed document of this study; files are not read again.
    fn check_again(&self, document: Table, changes: Vec<String>) -> Result<Self, Complaints> {
        Self::check(document, self.origin_with(changes))
    }

    fn check(document: Table, from: DocumentOrigin) -> Result<Self, Complaints> {
        let DocumentOrigin { text, files, computed, file, changes } = from;
        let reader = K::reader(&document).of_kind(DocumentKind::of(&document));
        let mut reader = reader.with(files, computed);
        let title = root::read(&mut reader, &document);
        let kind = K::read(&mut reader, &document);
        let sweeps = sweep::read(&mut reader, &document);
        let uncertainty = uncertainty::read(&mut reader, &document);
        let (complaints, files, computed, parts) = reader.finish();
        let (Some(kind), Some(sweeps), Some(uncertainty)) = (kind, sweeps, uncertainty) else {
            return Err(some_of(complaints).into());
        };
        if !complaints.is_empty() {
            return Err(complaints.into());
        }
        let source = StudySource {
            title,
            sweeps,
            uncertainty,
            document,
            text,
            files,
            computed,
            parts,
            declared: kind.clone().into(),
            file,
            changes,
        };
        let study = Self { kind, source: Arc::new(source) };
        study.ends_are_valid()?;
        study.distributions_are_valid()?;
        Ok(study)
    }

    /// Whether the study is valid at the ends of every axis.
    fn ends_are_valid(&self) -> Result<(), Complaints> {
        let mut complaints = Vec::new();
        for (index, sweep) in self.sweeps().iter().enumerate() {
            let entry = match self.source.document.get("sweep").map(|node| &node.value) {
                Some(Value::List(list)) => list.get(index),
                _ => None,
            };
            let origin = entry.map_or(Origin::Whole, |node| node.origin);
            for value in sweep.axis.extremes() {
                let Err(wrong) = self.at([(sweep.path.as_str(), value)]) else { continue };
                complaints.extend(wrong.into_iter().map(|mut complaint| {
                    if complaint.fault == Fault::Value {
                        let Complaint { key, value: other, allowed, .. } = &complaint;
                        let what = if *key == sweep.path {
                            format!("{key} = {value}")
                        } else {
                            format!("at {} = {value}, {key} = {other}", sweep.path)
                        };
                        complaint.allowed = format!(
                            "a path and values that give valid studies; {what} must be {allowed}"
                        )
                        .into();
                    }
                    let key = format!("sweep[{index}].parameter");
                    Complaint { key, origin, value: sweep.path.clone().into(), ..complaint }
                }));
            }
        }
        complaints.dedup_by(|a, b| a.key == b.key && a.fault == b.fault && a.allowed == b.allowed);
        if complaints.is_empty() { Ok(()) } else { Err(complaints.into()) }
    }

    /// Whether the study is valid at the ends of every distribution, or where it hardly ever is beyond.
    fn distributions_are_valid(&self) -> Result<(), Complaints> {
        let mut complaints: Vec<Complaint> = Vec::new();
        for (path, origin, distribution, extremes) in
            self.uncertainty().into_iter().flat_map(Uncertainty::extremes)
        {
            for value in extremes {
                let Err(wrong) = self.at([(path, value)]) else { continue };
                let key = format!("uncertainty.\"{path}\"");
                let given = uncertainty::in_words(distribution);
                complaints.extend(wrong.into_iter().map(|complaint| {
                    let allowed = uncertainty::beyond(path, value, &complaint);
                    Complaint {
                        key: key.clone(),
                        origin,
                        value: given.clone().into(),
                        allowed: allowed.into(),
                        ..complaint
                    }
                }));
            }
        }
        complaints.dedup_by(|a, b| a.key == b.key && a.fault == b.fault);
        if complaints.is_empty() { Ok(()) } else { Err(complaints.into()) }
    }

    /// Every value of the study after its changes as `path = value`, in the order of paths, and what the files that it names
    /// contribute; neither title nor axes nor distributions. The version of the file is among them even where the text leaves it out. Two
    /// studies with equal settings compute the same.
    pub fn settings(&self) -> Vec<(String, String)> {
        self.settings_of(&self.source.document)
    }

    /// The settings of a study some of whose numbers are varied: they have the value `"varied"`, by whichever key the study gives them.
    pub fn settings_varying(&self, varied: &[ParameterId]) -> Vec<(String, String)> {
        self.settings_of(&self.model().varying(varied))
    }

    fn settings_of(&self, document: &Table) -> Vec<(String, String)> {
        let mut settings = Vec::new();
        let apart = ["title", "sweep", "uncertainty"];
        for (name, node) in document.iter().filter(|(name, _)| !apart.contains(name)) {
            node.leaves(name, &mut settings);
        }
        for (path, value) in &mut settings {
            self.in_unit_of_key(path, value);
        }
        if !document.has("schema") {
            settings.push(("schema".to_owned(), format!("{:?}", f64::from(SCHEMA_VERSION))));
        }
        settings.extend(self.source.files.settings());
        settings.sort();
        settings
    }
}

impl<K> StudyOf<K> {
    /// What a reading of this study with other changes begins with.
    fn origin_with(&self, changes: Vec<String>) -> DocumentOrigin {
        let StudySource { text, files, computed, file, .. } = &*self.source;
        let (text, files) = (Arc::clone(text), files.to_read_again());
        DocumentOrigin { text, files, computed: computed.clone(), file: file.clone(), changes }
    }

    /// Replaces a quoted number with a unit by the number in the unit of its key.
    fn in_unit_of_key(&self, path: &str, value: &mut String) {
        let Some(text) = value.strip_prefix('"').and_then(|text| text.strip_suffix('"')) else {
            return;
        };
        if !measure::has_unit(text) {
            return;
        }
        let unit = path::measured_in(&self.source.document, path);
        if let Some(number) = unit.and_then(|unit| measure::read(text, Some(unit)).ok()) {
            *value = format!("{number:?}");
        }
    }

    /// The units of the bare numbers of the study.
    pub fn file_units(&self) -> UnitSystem {
        address::units_of(&self.source.document)
    }

    /// The study as it was declared: a belt or a disc that is answered as a system is the belt or the disc.
    pub fn declared(&self) -> Study {
        self.map_kind(self.source.declared.clone())
    }

    /// The number that a path names.
    ///
    /// # Errors
    /// The nearest path that names a number.
    pub fn address(&self, path: &str) -> Result<NumberAddress, Option<String>> {
        path::resolve(&self.source.document, path).map_err(|lost| lost.nearest)
    }

    /// The files that it was read from, which outputs must not overwrite.
    pub fn inputs(&self) -> Inputs {
        let StudySource { file, files, .. } = &*self.source;
        Inputs::of(file.as_deref().into_iter().chain(files.paths()))
    }

    /// The files that the study names.
    pub fn files(&self) -> &Files {
        &self.source.files
    }

    /// Every key and value after the changes as JSON, with title and axes: the document that would give this study without
    /// changes.
    pub fn document(&self) -> Json {
        self.source.document.json()
    }

    /// The parts that only this kind of study has.
    pub fn kind(&self) -> &K {
        &self.kind
    }

    /// The same study of a kind made from this one's.
    fn map_kind<L>(&self, kind: L) -> StudyOf<L> {
        StudyOf { kind, source: Arc::clone(&self.source) }
    }

    /// Title, if the file gives one.
    pub fn title(&self) -> Option<&str> {
        self.source.title.as_deref()
    }

    /// Title of a picture: that of the file, unless changes make it another study. Then it names the changes and no figure of the
    /// dissertation; a title that is changed itself stays as it is given.
    pub fn picture_title(&self) -> Option<String> {
        let title = self.title()?;
        let changes = self.changes();
        if changes.iter().any(|change| change.starts_with("title=")) {
            return Some(title.to_owned());
        }
        // Axes and solvers change no study.
        let mut named = changes
            .iter()
            .filter(|change| !change.starts_with("sweep") && !change.starts_with("solver."))
            .map(|change| change.replacen('=', " = ", 1).replace('"', ""));
        let mut words: Vec<String> = named.by_ref().take(CHANGES_IN_TITLE).collect();
        if words.is_empty() {
            return Some(title.to_owned());
        }
        let others = named.count();
        if others > 0 {
            words.push(format!("{others} more"));
        }
        Some(format!("{}; changed: {}", without_figure(title), words.join(", ")))
    }

    /// The axes of a map, in order.
    pub fn sweeps(&self) -> &[Sweep] {
        &self.source.sweeps
    }

    /// The uncertain numbers, if the study has any.
    pub fn uncertainty(&self) -> Option<&Uncertainty> {
        self.source.uncertainty.as_ref()
    }

    /// Changes made to the text, as `path=value`.
    pub fn changes(&self) -> &[String] {
        &self.source.changes
    }

    /// The kind of the document in which its numbers are declared, also of the system of a belt or a disc.
    pub fn document_kind(&self) -> DocumentKind {
        DocumentKind::of(&self.source.document)
    }

    /// The text of the file as it was read, without changes.
    pub fn text(&self) -> &str {
        &self.source.text
    }
}
/// Complaints about a study that could not be built, at least one.
fn some_of(complaints: Vec<Complaint>) -> Vec<Complaint> {
    if !complaints.is_empty() {
        return complaints;
    }
    let allowed = "numbers that make a system together";
    vec![Complaint::new(Fault::Value, "study", Origin::Whole, Json::Null, allowed)]
}
