//! Reads keys from the document and collects all errors.
//!
//! Every number is read in one way ([`Reader::quantity`]): bare in the units of the study, quoted with a unit, or by a key with the unit
//! as a suffix. What is read is a number of the equations ([`StudyUnits`]).

use quell_input::complaint::{Complaint, Fault, Origin};
use quell_input::document::{Node, Table, given_number};
use quell_input::files::Files;
use quell_model::InvalidValues;
use quell_model::units::{DiscScales, Scales, UnitSystem};
use serde_json::Value as Json;

use super::computed::Computed;
use super::suggest;
use super::vocabulary::{self, DocumentKind, Section, join};

mod no_number;
mod numbers;
mod parts;
mod units;
mod words;

pub(super) use numbers::{Found, Keyed, NumbersByName, Reported, WantedNumber, suffixed};
pub(super) use parts::StudyParts;
pub(super) use units::{EquationScale, StudyUnits};

/// Where and how a parameter was written.
#[derive(Clone, Debug)]
struct Written {
    /// Path of the table, with its index.
    table: Box<str>,
    /// Name of the number in the registry.
    number: &'static str,
    /// The key of the table that gave it.
    key: &'static str,
    origin: Origin,
    /// What the key gives for one number of the equations.
    factor: f64,
}

/// Reads keys and collects errors.
#[derive(Debug)]
pub struct Reader {
    kind: DocumentKind,
    units: StudyUnits,
    named: NumbersByName,
    complaints: Vec<Complaint>,
    written: Vec<Written>,
    files: Files,
    computed: Computed,
    parts: StudyParts,
}

impl Reader {
    /// A reader in these units, which holds no file.
    pub(super) fn in_units(file: UnitSystem, scale: EquationScale) -> Self {
        Self {
            kind: DocumentKind::System,
            units: StudyUnits { file, scale, natural_frequency: None },
            named: NumbersByName::default(),
            complaints: Vec::new(),
            written: Vec::new(),
            files: Files::default(),
            computed: Computed::default(),
            parts: StudyParts::default(),
        }
    }

    /// The reader with what an earlier reading left.
    pub(super) fn with(self, files: Files, computed: Computed) -> Self {
        Self { files, computed, ..self }
    }

    /// The reader with parts of the study that may stand for tables that did not change.
    pub(super) fn with_parts(self, parts: StudyParts) -> Self {
        Self { parts, ..self }
    }

    /// The reader of a document of a kind.
    pub(super) fn of_kind(self, kind: DocumentKind) -> Self {
        Self { kind, ..self }
    }

    /// The units of the study.
    pub(super) fn units(&self) -> StudyUnits {
        self.units
    }

    /// The units of bare numbers from here on.
    pub(super) fn set_file_units(&mut self, file: UnitSystem) {
        self.units.file = file;
    }

    /// The numbers of the equations from here on.
    pub(super) fn set_scale(&mut self, scale: EquationScale) {
        self.units.scale = scale;
    }

    /// The natural frequency to which a frequency ratio refers from here on.
    pub(super) fn set_natural_frequency(&mut self, frequency: Option<f64>) {
        self.units.natural_frequency = frequency;
    }

    /// The numbers that formulas use by name from here on.
    pub(super) fn set_named(&mut self, named: NumbersByName) {
        self.named = named;
    }

    /// The numbers that formulas use by name.
    pub(super) fn named(&self) -> &NumbersByName {
        &self.named
    }

    /// The files that the study names.
    pub(super) fn files(&mut self) -> &mut Files {
        &mut self.files
    }

    /// What was costly to compute.
    pub(super) fn computed(&mut self) -> &mut Computed {
        &mut self.computed
    }

    /// Sets the scales of the disc for the keys read from here on.
    pub(super) fn set_disc_scales(&mut self, scales: Option<DiscScales>) {
        self.set_scale(EquationScale::Disc(scales));
    }

    /// The scales of a belt with units, if mass and stiffness are valid.
    pub(super) fn known_scales(&self) -> Option<Scales> {
        match self.units {
            StudyUnits { scale: EquationScale::Belt(scales), file, .. } if !file.is_none() => {
                scales
            }
            _ => None,
        }
    }

    /// Adds a complaint, once: several contacts may share a law.
    pub(super) fn complain(&mut self, complaint: Complaint) {
        if !self.complaints.contains(&complaint) {
            self.complaints.push(complaint);
        }
    }

    /// Number of errors so far.
    pub(super) fn complaints_so_far(&self) -> usize {
        self.complaints.len()
    }

    /// All complaints, in the order of the text.
    pub(super) fn into_complaints(self) -> Vec<Complaint> {
        self.finish().0
    }

    /// All complaints, in the order of the text, and what a later reading need not read or compute again.
    pub(super) fn finish(mut self) -> (Vec<Complaint>, Files, Computed, StudyParts) {
        self.complaints.sort_by_key(|complaint| complaint.origin.line().unwrap_or(usize::MAX));
        // A key that is misspelt is not missing too.
        let misspelt: Vec<String> = self
            .complaints
            .iter()
            .filter(|complaint| complaint.fault == Fault::Unknown)
            .filter_map(|complaint| complaint.suggestion.clone())
            .collect();
        self.complaints.retain(|complaint| {
            complaint.fault != Fault::Missing || !misspelt.contains(&complaint.key)
        });
        (self.complaints, self.files, self.computed, self.parts)
    }

    /// Reports keys that a table does not have.
    pub(super) fn unknown_keys(&mut self, table: &Table, section: Section, prefix: &str) {
        for (name, node) in table.iter() {
            if vocabulary::key(section, name, self.kind).is_none() {
                self.unknown_key(section, prefix, name, node);
            }
        }
    }

    /// Reports one unknown key.
    pub(super) fn unknown_key(&mut self, section: Section, prefix: &str, name: &str, node: &Node) {
        let kind = self.kind;
        let there: Vec<&str> = vocabulary::keys_of(section, kind).map(|key| key.name).collect();
        let key = join(prefix, name);
        let nearest = suggest::key(kind, section, name);
        let nearest = nearest.map(|near| {
            if near.section == section { join(prefix, near.name) } else { near.path() }
        });
        // A key is never suggested for itself.
        let nearest = nearest.filter(|path| *path != key);
        let complaint =
            Complaint::new(Fault::Unknown, key, node.origin, node.given(), there.join(", "));
        self.complain(complaint.suggesting(nearest));
    }

    /// Adds the errors of a constructor of the model, under the keys of the file. A key that already
    /// has an error is not reported again.
    pub(super) fn adopt(&mut self, invalid: InvalidValues) {
        for complaint in invalid {
            let Some((table, number)) = complaint.key.rsplit_once('.') else { continue };
            let gave = |written: &&Written| &*written.table == table && written.number == number;
            let Some(written) = self.written.iter().find(gave) else { continue };
            let key = join(&written.table, written.key);
            if self.complaints.iter().any(|known| known.key == key) {
                continue;
            }
            let number = complaint.value.parse::<f64>();
            let value = number.map_or(Json::String(complaint.value), |number| {
                given_number(number * written.factor)
            });
            let origin = written.origin;
            self.complain(Complaint::new(Fault::Value, key, origin, value, complaint.allowed));
        }
    }

    /// Records where a number of the registry was written, for errors of the model.
    pub(super) fn remember(
        &mut self,
        table: &str,
        (number, key): (&'static str, &'static str),
        origin: Origin,
        factor: f64,
    ) {
        self.written.push(Written { table: table.into(), number, key, origin, factor });
    }
}
