//! The equations of a study as a function of its numbers.
//!
//! A study declares its numbers in a document, which is read once. A [`ParameterId`] is a number of it that a path was followed to;
//! [`Model::at`] assembles the [`System`] of other values, by the same code that reads the study, so that what is refused in a run is
//! what the file would be refused for. Copies of a document share the tables that no value changes, files are held, and modes and fits
//! are kept while their numbers stay.

use std::sync::Arc;

use quell_input::complaint::{Complaint, Complaints, Fault, Origin};
use quell_input::document::{Node, Table, Value};
use quell_model::System;
use quell_model::parameter::Parameter;

use super::path::{self, FoundPath, LostPath};
use super::reader::{Reader, StudyParts};
use super::study_kind::StudyKind;
use super::system::SystemStudy;
use super::vocabulary::DocumentKind;
use super::{Kind, StudyOf, StudySource};

/// A number that a study declares, or could declare, found by its path.
#[derive(Clone, Debug, PartialEq)]
pub struct ParameterId(Arc<FoundPath>);

/// The equations of a study as a function of its numbers.
///
/// ```
/// use quell_study::Study;
///
/// let text = "
///     [system]
///     coordinates = [\"x\"]
///     mass = [1]
///     stiffness = [\"k\"]
///     [parameters]
///     k = 4
/// ";
/// let study = Study::parse(text, &[]).expect("valid");
/// assert_eq!(study.number("parameters.k"), Some(4.0));
/// let model = study.model();
/// let stiffness = model.parameter("parameters.k").expect("a number of the study");
/// let system = model.at(&[(stiffness, 9.0)]).expect("a valid value");
/// assert_eq!(system.structure.mechanical().expect("masses").stiffness()[(0, 0)], 9.0);
/// ```
#[derive(Clone, Debug)]
pub struct Model {
    source: Arc<StudySource>,
}

impl<K> StudyOf<K> {
    /// The equations of the study as a function of its numbers.
    pub fn model(&self) -> Model {
        Model { source: Arc::clone(&self.source) }
    }

    /// The number at a path, in the unit of its key, its formula evaluated; `None` where the study has no such number.
    pub fn number(&self, path: &str) -> Option<f64> {
        self.source.declared.template().number(&self.source.document, path)
    }

    /// The unit to which a value of a path with a unit is converted; `None` without a unit and where the study has no such number.
    pub fn unit_of(&self, path: &str) -> Option<&'static str> {
        path::measured_in(&self.source.document, path)
    }

    /// The path of a number of a contact of the study's system.
    pub fn path_of(&self, contact: &str, parameter: Parameter) -> String {
        self.source.declared.template().path_of(contact, parameter)
    }
}

impl<K: StudyKind> StudyOf<K> {
    /// What the study gives for other values of its numbers, set in order as by `--set`, without what it asks for: axes,
    /// distributions and a design.
    ///
    /// # Errors
    /// All complaints about the changed study.
    pub fn setup_at(&self, numbers: &[(ParameterId, f64)]) -> Result<K, Complaints> {
        let model = self.model();
        let document = model.document_at(numbers);
        model.read(K::reader, &document, K::read)
    }
}

impl SystemStudy {
    /// The system of other values of its numbers, with the row that is observed and the start that the study gives for them.
    ///
    /// # Errors
    /// All complaints about the changed study.
    pub fn varied(&self, numbers: &[(ParameterId, f64)]) -> Result<Self, Complaints> {
        let model = self.model();
        let document = model.document_at(numbers);
        Ok(self.map_kind(model.read(Kind::reader, &document, Kind::described)?))
    }
}

impl Model {
    /// The number that a path names.
    ///
    /// # Errors
    /// A complaint about the path, with the nearest one.
    pub fn parameter(&self, path: &str) -> Result<ParameterId, Box<Complaint>> {
        let lost = |lost: LostPath| {
            let unknown = (Fault::Unknown, "the path of a number of the study");
            Box::new(lost.complaint(path, (Origin::Whole, path.into()), unknown))
        };
        let found = path::follow(&self.source.document, path).map_err(lost)?;
        if !found.is_number {
            return Err(lost(LostPath::default()));
        }
        Ok(ParameterId(Arc::new(found)))
    }

    /// Numbers given by their paths.
    ///
    /// # Errors
    /// A complaint about the first path that names no number, with the nearest one.
    pub fn numbers(
        &self,
        given: &[(&str, f64)],
    ) -> Result<Vec<(ParameterId, f64)>, Box<Complaint>> {
        given.iter().map(|(path, value)| Ok((self.parameter(path)?, *value))).collect()
    }

    /// The system of other values, in the unit of their keys, set in order as by `--set`.
    ///
    /// # Errors
    /// All complaints about the changed study.
    pub fn at(&self, numbers: &[(ParameterId, f64)]) -> Result<System, Complaints> {
        let document = self.document_at(numbers);
        self.read(Kind::reader, &document, Kind::assemble)
    }

    /// The document with words in place of numbers that are varied.
    pub(super) fn varying(&self, varied: &[ParameterId]) -> Table {
        let mut document = self.source.document.clone();
        for parameter in varied {
            let node = Node { value: Value::Text("varied".to_owned()), origin: Origin::Whole };
            path::put(&mut document, &parameter.0, &node);
        }
        document
    }

    /// The document with other values, and without what the study asks for.
    fn document_at(&self, numbers: &[(ParameterId, f64)]) -> Table {
        let mut document = self.source.document.clone();
        for asked in ["sweep", "design", "uncertainty"] {
            document.remove(asked);
        }
        for (parameter, value) in numbers {
            let node = Node { value: Value::Number(*value), origin: Origin::Whole };
            path::put(&mut document, &parameter.0, &node);
        }
        document
    }

    /// Reads a changed document by what this study has read and computed.
    fn read<T>(
        &self,
        reader: impl Fn(&Table) -> Reader,
        document: &Table,
        read: impl Fn(&mut Reader, &Table) -> Option<T>,
    ) -> Result<T, Complaints> {
        let StudySource { files, computed, parts, .. } = &*self.source;
        let by = |parts: StudyParts| {
            let reader = reader(document).of_kind(DocumentKind::of(document));
            let reader = reader.with(files.to_read_again(), computed.clone());
            let mut reader = reader.with_parts(parts);
            match (read(&mut reader, document), reader.into_complaints()) {
                (Some(read), complaints) if complaints.is_empty() => Ok(read),
                (_, complaints) => Err(complaints),
            }
        };
        // What is refused is read in whole, for the complaints that the file would get.
        let whole = |_| by(StudyParts::default()).map_err(super::some_of);
        by(parts.to_reuse()).or_else(whole).map_err(Complaints::from)
    }
}
