//! `[system]`: the study of any linear structure with friction contacts.
//!
//! A structure is given by matrices over named coordinates, by first-order equations, by modes, or by a measured frequency
//! response; `[[contact]]` and `[[dither]]` name its coordinates in their rows. Numbers are in the units of the file
//! ([`SystemUnits`]), and any of them may be a formula of `[parameters]`.

mod contact;
mod dither;
mod friction;
mod initial;
pub mod keys;
mod mass;
mod numbers;
mod parameters;
mod path;
mod read;
mod rows;
mod structure;
mod units;

use std::path::Path;
use std::sync::Arc;

use quell_model::System;

use super::StudyOf;
use super::document::{Node, Table, Value};
use super::reader::Reader;
use super::study_kind::{Given, StudyKind};
use crate::complaint::{Complaint, Complaints, Origin};
use crate::study::Measured;

pub use initial::SystemStart;
pub use path::{SystemAddress, resolve_in};
pub use units::SystemUnits;

pub(super) use path::{measured_in, set};

use numbers::Numbers;

/// A checked study of a system.
pub type SystemStudy = StudyOf<SystemSetup>;

/// The parts of a study that only a system has.
#[derive(Clone, Debug, PartialEq)]
pub struct SystemSetup {
    system: Arc<System>,
    observe: Vec<f64>,
    initial: SystemStart,
    numbers: Numbers,
    warnings: Vec<String>,
    /// Samples of the measured laws, contact by contact.
    measured: Arc<[Option<Measured>]>,
}

/// Whether a document is the study of a system.
pub(super) fn is_described(document: &Table) -> bool {
    document.has("system")
}

/// The tables of a study of a system.
pub(super) const TABLES: &[&str] =
    &["schema", "title", "system", "contact", "friction", "dither", "parameters", "sweep"];

impl StudyKind for SystemSetup {
    fn reader(_: &Table) -> Reader {
        Reader::as_written()
    }

    fn tables(_: &Table) -> &'static [&'static str] {
        TABLES
    }

    fn read(reader: &mut Reader, document: &Table, given: Given<'_, Self>) -> Option<Self> {
        read::study(reader, document, given)
    }

    fn data_files(&self) -> Vec<&Path> {
        let samples = self.measured.iter().flatten();
        samples.filter_map(|measured| measured.file.as_deref()).collect()
    }

    fn file_settings(&self) -> Vec<(String, String)> {
        let samples = self.measured.iter().enumerate();
        samples
            .filter_map(|(index, measured)| {
                let (key, value) = measured.as_ref()?.settings();
                Some((format!("contact[{index}].{key}"), value))
            })
            .collect()
    }
}

impl SystemSetup {
    /// Name of the kind.
    pub const NAME: &'static str = "system";

    /// The system in the units of the file.
    pub fn system(&self) -> &System {
        &self.system
    }

    /// The units of the bare numbers of the file.
    pub fn units(&self) -> SystemUnits {
        self.numbers.units
    }
}

impl SystemStudy {
    /// The system, its numbers in the units of the file and its frequencies angular; input `i` is `[[dither]]` `i`.
    pub fn system(&self) -> &System {
        &self.kind().system
    }

    /// The units of the bare numbers of the file.
    pub fn units(&self) -> SystemUnits {
        self.kind().numbers.units
    }

    /// What is valid but unlikely, in sentences.
    pub fn warnings(&self) -> &[String] {
        &self.kind().warnings
    }

    /// The displacement that a response measures, a row over the coordinates or states: `system.observe`, or the tangent of
    /// the first contact that has one.
    pub fn observe(&self) -> Vec<f64> {
        self.kind().observe.clone()
    }

    /// Where a run begins.
    pub fn initial(&self) -> &SystemStart {
        &self.kind().initial
    }

    /// The number at a path, such as `contact.pad.friction.coefficient`, its formula evaluated: in the units of the file, or
    /// in SI for a path that ends in a twin. `None` where the study has no such number.
    pub fn number(&self, path: &str) -> Option<f64> {
        path::number(&self.source.document, &self.kind().numbers, path)
    }

    /// The system with these numbers set in order as by `--set`: that of [`StudyOf::at`], without text or files being read.
    ///
    /// # Errors
    /// All complaints about the changed study.
    pub fn system_at(&self, numbers: &[(&str, f64)]) -> Result<System, Complaints> {
        let mut document = self.source.document.clone();
        document.remove("sweep");
        for (path, value) in numbers {
            let node = Node { value: Value::Number(*value), origin: Origin::Argument("change") };
            set(&mut document, path, &node)?;
        }
        let mut reader = Reader::as_written();
        let given = Given { folder: &self.source.folder, known: Some(self.kind()) };
        let setup = read::study(&mut reader, &document, given);
        let complaints: Vec<Complaint> = reader.into_complaints();
        match setup {
            Some(setup) if complaints.is_empty() => Ok(Arc::unwrap_or_clone(setup.system)),
            _ => Err(complaints.into()),
        }
    }
}
