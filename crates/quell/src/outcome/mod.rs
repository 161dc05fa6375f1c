//! The answer of a verb for its readers: a sentence, a table, fields, datasets, a sound, a picture.
//!
//! Every verb has two files: `run/VERB.rs` computes, `outcome/VERB.rs` presents the result. The command line and Python
//! both take an [`Outcome`] and need nothing else of a verb's result.

use serde_json::Value as Json;

use crate::complaint::Failure;
use crate::dataset::Dataset;
use crate::input::Inputs;
use crate::plot::Figure;
use crate::study::{StudyKind, StudyOf};

mod actuator;
mod attractor;
mod basins;
mod bifurcation;
pub mod check;
mod cite;
mod compare;
mod decay;
mod describing;
mod design;
mod disc_motion;
mod estimates;
mod fit;
mod friction;
pub mod friction_export;
mod map;
mod modes;
mod noise_response;
mod orbit;
mod probability;
mod ramp;
mod read_file;
mod record_fit;
mod resonances;
mod response;
mod simulate;
mod stability;
mod system;
mod table;
mod thresholds;
mod waveforms;
mod window;

pub use compare::ComparedStudy;
pub(crate) use probability::POINTS as DISTRIBUTION_POINTS;

/// The answer of a verb.
pub trait Outcome: Send + Sync {
    /// The files that the study was read from; no output may overwrite them.
    fn inputs(&self) -> Inputs;

    /// What the answer is: a verb has one of several names where an option asks another question.
    fn name(&self) -> &'static str;

    /// Every field, with units, reasons for null fields, and warnings.
    fn json(&self) -> Json;

    /// The fields without the large arrays of [`Outcome::datasets`]; only a map has such arrays.
    fn facts(&self) -> Json {
        self.json()
    }

    /// The answer in one or two sentences; `None` if the answer is only a table.
    fn sentence(&self) -> Option<String> {
        None
    }

    /// The numbers as text for people.
    fn table(&self) -> String;

    /// What else a reader should know, one sentence each, of the second rank.
    fn notes(&self) -> Vec<String> {
        Vec::new()
    }

    /// The title of the study, if the text begins with it.
    fn title(&self) -> Option<&str> {
        None
    }

    /// The text for people: title, sentence, notes and table.
    fn text(&self) -> String {
        let lines = self.title().map(str::to_owned).into_iter().chain(self.sentence());
        let notes = self.notes().into_iter().map(|note| format!("  {note}"));
        let mut text: String = lines.chain(notes).map(|line| line + "\n").collect();
        text += &self.table();
        text
    }

    /// The warnings, one sentence each.
    fn warnings(&self) -> Vec<String> {
        let object = self.facts();
        let listed = object["warnings"].as_array().map_or(&[][..], Vec::as_slice);
        listed.iter().filter_map(|warning| Some(warning.as_str()?.to_owned())).collect()
    }

    /// Arrays as named datasets; the first is the main one.
    fn datasets(&self) -> Vec<(&'static str, Dataset)> {
        Vec::new()
    }

    /// The bytes of a sound file, if the verb has one.
    fn sound(&self) -> Option<Result<Vec<u8>, Failure>> {
        None
    }

    /// The bytes of a file of another program with this extension, if the verb has one.
    fn exported(&self, extension: &str) -> Option<Result<Vec<u8>, Failure>> {
        let _ = extension;
        None
    }

    /// The picture, if the verb has one.
    fn figure(&self) -> Option<Result<Figure, Failure>> {
        None
    }
}

/// The fields of an outcome with its name as the second of them, `answer`, and its notes after the sentence: what the command line prints with `--json`, and Python's facts.
pub fn named(outcome: &dyn Outcome, mut fields: Json) -> Json {
    if let Json::Object(fields) = &mut fields {
        fields.shift_insert(1.min(fields.len()), "answer".to_owned(), outcome.name().into());
        let after = fields.keys().position(|name| name == "sentence").unwrap_or(1) + 1;
        fields.shift_insert(after.min(fields.len()), "notes".to_owned(), outcome.notes().into());
    }
    fields
}

/// The result of a verb for a study of kind `K`; with its study it is an [`Outcome`], whose methods these are.
///
/// Most results have methods `json` and `sentence` of their own, which these call.
pub trait Presented<K>: Send + Sync {
    /// [`Outcome::name`].
    const NAME: &'static str;

    /// Whether the text begins with the title of the study.
    const TITLED: bool = false;

    /// [`Outcome::json`].
    fn json(&self, study: &StudyOf<K>) -> Json;

    /// [`Outcome::sentence`].
    fn sentence(&self, study: &StudyOf<K>) -> Option<String> {
        let _ = study;
        None
    }

    /// [`Outcome::table`].
    fn table(&self, study: &StudyOf<K>) -> String;

    /// [`Outcome::notes`].
    fn notes(&self, study: &StudyOf<K>) -> Vec<String> {
        let _ = study;
        Vec::new()
    }

    /// [`Outcome::datasets`].
    fn datasets(&self, study: &StudyOf<K>) -> Vec<(&'static str, Dataset)> {
        let _ = study;
        Vec::new()
    }

    /// [`Outcome::sound`].
    fn sound(&self, study: &StudyOf<K>) -> Option<Result<Vec<u8>, Failure>> {
        let _ = study;
        None
    }

    /// [`Outcome::exported`].
    fn exported(&self, study: &StudyOf<K>, extension: &str) -> Option<Result<Vec<u8>, Failure>> {
        let _ = (study, extension);
        None
    }

    /// [`Outcome::figure`].
    fn figure(&self, study: &StudyOf<K>) -> Option<Result<Figure, Failure>> {
        let _ = study;
        None
    }
}

/// The result of a verb with its study.
#[derive(Clone, Debug)]
pub struct Answered<K, D> {
    /// The study.
    pub study: StudyOf<K>,
    /// The result.
    pub done: D,
}

impl<K: StudyKind, D> Answered<K, D> {
    /// The result of a verb for a study.
    pub fn new(study: &StudyOf<K>, done: D) -> Self {
        Self { study: study.clone(), done }
    }
}

impl<K: StudyKind + Send + Sync, D: Presented<K>> Outcome for Answered<K, D> {
    fn inputs(&self) -> Inputs {
        self.study.inputs()
    }

    fn name(&self) -> &'static str {
        D::NAME
    }

    fn json(&self) -> Json {
        self.done.json(&self.study)
    }

    fn title(&self) -> Option<&str> {
        self.study.title().filter(|_| D::TITLED)
    }

    fn sentence(&self) -> Option<String> {
        self.done.sentence(&self.study)
    }

    fn table(&self) -> String {
        self.done.table(&self.study)
    }

    fn notes(&self) -> Vec<String> {
        self.done.notes(&self.study)
    }

    fn datasets(&self) -> Vec<(&'static str, Dataset)> {
        self.done.datasets(&self.study)
    }

    fn sound(&self) -> Option<Result<Vec<u8>, Failure>> {
        self.done.sound(&self.study)
    }

    fn exported(&self, extension: &str) -> Option<Result<Vec<u8>, Failure>> {
        self.done.exported(&self.study, extension)
    }

    fn figure(&self) -> Option<Result<Figure, Failure>> {
        let figure = self.done.figure(&self.study)?;
        Some(figure.map(|figure| titled(figure, &self.study)))
    }
}

/// A picture of a study with the title of that study: a changed one does not keep that of its file.
pub(crate) fn titled<K: StudyKind>(figure: Figure, study: &StudyOf<K>) -> Figure {
    match study.picture_title() {
        Some(title) if !figure.title.is_empty() => figure.title(title),
        _ => figure,
    }
}
