//! The answer of a verb as readers want it: a sentence, a table, fields, datasets, a picture.
//!
//! A verb is two files: `run/VERB.rs` computes, `outcome/VERB.rs` presents what was computed. Both doors, the command line
//! and Python, take an [`Outcome`] and know nothing else of a verb's result.

use serde_json::Value as Json;

use crate::complaint::Failure;
use crate::dataset::Dataset;
use crate::input::Inputs;
use crate::plot::Figure;
use crate::study::{StudyKind, StudyOf};

mod basins;
mod bifurcation;
pub mod check;
mod cite;
mod friction;
mod map;
mod modes;
mod orbit;
mod resonances;
mod response;
mod simulate;
mod stability;
mod table;
mod thresholds;

/// The answer of a verb.
pub trait Outcome: Send + Sync {
    /// The files that the study was read from: none of them is an output.
    fn inputs(&self) -> Inputs;

    /// Every field, with units, reasons for what is null, and warnings: the object that the command line prints with
    /// `--json`.
    fn json(&self) -> Json;

    /// The fields without large arrays, which [`Outcome::datasets`] has: all of them but for a map.
    fn facts(&self) -> Json {
        self.json()
    }

    /// The answer in one or two sentences; `None` where it is a table alone.
    fn sentence(&self) -> Option<String> {
        None
    }

    /// The numbers as text for people.
    fn table(&self) -> String;

    /// The title of the study, where the text begins with it.
    fn title(&self) -> Option<&str> {
        None
    }

    /// What a person reads: title, sentence and table.
    fn text(&self) -> String {
        let lines = self.title().map(str::to_owned).into_iter().chain(self.sentence());
        let mut text: String = lines.map(|line| line + "\n").collect();
        text += &self.table();
        text
    }

    /// What a reader of the answer should know, one sentence each.
    fn warnings(&self) -> Vec<String> {
        let object = self.facts();
        let listed = object["warnings"].as_array().map_or(&[][..], Vec::as_slice);
        listed.iter().filter_map(|warning| Some(warning.as_str()?.to_owned())).collect()
    }

    /// Arrays, each dataset with its name; the first is the main one.
    fn datasets(&self) -> Vec<(&'static str, Dataset)> {
        Vec::new()
    }

    /// The picture, where there is one.
    fn figure(&self) -> Option<Result<Figure, Failure>> {
        None
    }
}

/// What was computed, with its study.
#[derive(Clone, Debug)]
pub struct Answered<K, D> {
    /// The study.
    pub study: StudyOf<K>,
    /// What was computed.
    pub done: D,
}

impl<K: StudyKind, D> Answered<K, D> {
    /// What was computed for a study.
    pub fn new(study: &StudyOf<K>, done: D) -> Self {
        Self { study: study.clone(), done }
    }
}
