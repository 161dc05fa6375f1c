//! Reads keys from the document, converts SI to dimensionless numbers, and collects
//! all errors.
//!
//! A study uses one unit system. It is in SI if `belt.mass_kg` or
//! `belt.stiffness_n_per_m` is given, or if all its quantities are in SI; then a dimensionless
//! key that has an SI twin is rejected, and vice versa.

use std::mem;

use quell_model::InvalidValues;
use quell_model::units::{DiscScales, Quantity, Scales};
use serde_json::Value as Json;

use super::computed::Computed;
use super::document::{Node, Table, Value, given_number};
use super::files::Files;
use super::suggest;
use super::vocabulary::{self, Key, Role, Section, join};
use crate::complaint::{Complaint, Fault, Origin};

mod numbers;
mod words;

pub(super) use numbers::Found;

/// The unit system of a study.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Units {
    /// Dimensionless.
    Scaled,
    /// SI; without scales if mass or stiffness is invalid.
    Si(Option<Scales>),
    /// A disc, for which each key may be in SI or not; without scales if neither material nor frequencies in hertz
    /// are known.
    Disc(Option<DiscScales>),
}

/// Where and how a parameter was written.
#[derive(Clone, Debug)]
struct Written {
    /// Path in the registry, with index.
    path: String,
    /// Path of the key that gave it.
    key: String,
    origin: Origin,
    /// The dimensionless unit in the unit of that key.
    factor: f64,
}

/// Reads keys and collects errors.
#[derive(Debug)]
pub struct Reader {
    units: Units,
    complaints: Vec<Complaint>,
    written: Vec<Written>,
    files: Files,
    computed: Computed,
}

impl Reader {
    /// A reader in these units, which holds no file.
    fn in_units(units: Units) -> Self {
        Self {
            units,
            complaints: Vec::new(),
            written: Vec::new(),
            files: Files::default(),
            computed: Computed::default(),
        }
    }

    /// Determines the unit system of a study and reads its scales.
    pub(super) fn new(root: &Table) -> Self {
        let mut reader = Self::in_units(Units::Scaled);
        if is_si(root) {
            reader.units = Units::Si(None);
            if let Some(belt) = root.get("belt") {
                reader.units = Units::Si(reader.scales(belt));
            }
        }
        reader
    }

    /// A reader for a study of a disc, whose scales are not known yet.
    pub(super) fn of_a_disc() -> Self {
        Self::in_units(Units::Disc(None))
    }

    /// A reader whose numbers are those of the file.
    pub(super) fn as_written() -> Self {
        Self::in_units(Units::Scaled)
    }

    /// A reader of keys in SI with these scales.
    pub(super) fn in_si(scales: Option<Scales>) -> Self {
        Self::in_units(Units::Si(scales))
    }

    /// The reader with what an earlier reading left.
    pub(super) fn with(self, files: Files, computed: Computed) -> Self {
        Self { files, computed, ..self }
    }

    /// Reads with `inner` in place of this reader, which lends it the files and results. Its keys below `table` are those below `path`
    /// here; its complaints stay its own.
    pub(super) fn lend<T>(
        &mut self,
        inner: &mut Self,
        (table, path): (&str, &str),
        read: impl FnOnce(&mut Self) -> T,
    ) -> T {
        let swap = |one: &mut Self, other: &mut Self| {
            mem::swap(&mut one.files, &mut other.files);
            mem::swap(&mut one.computed, &mut other.computed);
        };
        let earlier = self.files.named().len();
        swap(self, inner);
        let read = read(inner);
        swap(self, inner);
        self.files.rename(earlier, table, path);
        read
    }

    /// The files that the study names.
    pub(super) fn files(&mut self) -> &mut Files {
        &mut self.files
    }

    /// What was costly to compute.
    pub(super) fn computed(&mut self) -> &mut Computed {
        &mut self.computed
    }

    /// Whether a key has been complained about.
    pub(super) fn has_complaint_about(&self, key: &str) -> bool {
        self.complaints.iter().any(|complaint| complaint.key == key)
    }

    /// Sets the scales of the disc for the keys read from here on.
    pub(super) fn set_disc_scales(&mut self, scales: Option<DiscScales>) {
        self.units = Units::Disc(scales);
    }

    /// SI value of one unit of a quantity, if known.
    pub(super) fn si_per_unit(&self, quantity: Quantity) -> Option<f64> {
        match self.units {
            Units::Scaled => None,
            Units::Si(scales) => scales.map(|scales| scales.si_per_unit(quantity)),
            Units::Disc(scales) => scales?.si_per_unit(quantity),
        }
    }

    /// Whether the study is of a disc.
    pub(super) fn is_of_a_disc(&self) -> bool {
        matches!(self.units, Units::Disc(_))
    }

    /// The scales of a study in SI, if mass and stiffness are valid.
    pub(super) fn known_scales(&self) -> Option<Scales> {
        match self.units {
            Units::Si(scales) => scales,
            Units::Scaled | Units::Disc(_) => None,
        }
    }

    /// Whether the study is in SI.
    pub(super) fn is_si(&self) -> bool {
        matches!(self.units, Units::Si(_))
    }

    /// Adds a complaint.
    pub(super) fn complain(&mut self, complaint: Complaint) {
        self.complaints.push(complaint);
    }

    /// Number of errors so far.
    pub(super) fn complaints_so_far(&self) -> usize {
        self.complaints.len()
    }

    /// All complaints, in the order of the text.
    pub(super) fn into_complaints(self) -> Vec<Complaint> {
        self.into_parts().0
    }

    /// All complaints, in the order of the text, and what a later reading need not read or compute again.
    pub(super) fn into_parts(mut self) -> (Vec<Complaint>, Files, Computed) {
        self.complaints.sort_by_key(|complaint| complaint.origin.line().unwrap_or(usize::MAX));
        (self.complaints, self.files, self.computed)
    }

    /// Reports keys that a table does not have.
    pub(super) fn unknown_keys(
        &mut self,
        table: &Table,
        section: Section,
        prefix: &str,
        also: &[&str],
    ) {
        for (name, node) in table.iter() {
            if vocabulary::key(section, name).is_some() || also.contains(&name) {
                continue;
            }
            self.unknown_key(section, prefix, name, node);
        }
    }

    /// Reports one unknown key.
    pub(super) fn unknown_key(&mut self, section: Section, prefix: &str, name: &str, node: &Node) {
        let index =
            prefix.split_once('[').and_then(|(_, rest)| rest.trim_end_matches(']').parse().ok());
        let there: Vec<&str> = self.keys_there(section).map(|key| key.name).collect();
        let key = join(prefix, name);
        let nearest = suggest::path(section.path(), name, index).map(|path| self.in_system(&path));
        // A key is never suggested for itself.
        let nearest = nearest.filter(|path| *path != key);
        let complaint =
            Complaint::new(Fault::Unknown, key, node.origin, node.given(), there.join(", "));
        self.complain(complaint.suggesting(nearest));
    }

    /// The keys of a table in the system of this study.
    pub(super) fn keys_there(&self, section: Section) -> impl Iterator<Item = &'static Key> {
        let si = self.is_si();
        let disc = self.is_of_a_disc();
        vocabulary::keys_of(section).filter(move |key| match key.role {
            _ if disc => true,
            Role::Number(parameter) => !si || parameter.si.is_empty() || parameter.is_pure(),
            Role::Twin(..) | Role::Scale(_) | Role::FrictionForce(..) => si,
            Role::Size(_, size) => size.belongs(si),
            Role::Speeds { si: in_si } => in_si == si,
            Role::Band { hertz } => !hertz || si,
            Role::Course(course) => course.si().is_none_or(|in_si| in_si == si),
            _ => true,
        })
    }

    /// The path that gives the same number in the system of this study.
    pub(super) fn in_system(&self, path: &str) -> String {
        if self.is_of_a_disc() {
            return path.to_owned();
        }
        vocabulary::in_system(path, self.is_si())
    }

    /// Adds the errors of a constructor of the model, under the keys of the file. A key that already
    /// has an error is not reported again.
    pub(super) fn adopt(&mut self, invalid: InvalidValues) {
        for complaint in invalid {
            let written = self.written.iter().find(|written| written.path == complaint.key);
            let Some(written) = written else { continue };
            let key = written.key.clone();
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
    pub(super) fn remember(&mut self, path: &str, key: &str, origin: Origin, factor: f64) {
        self.written.push(Written { path: path.to_owned(), key: key.to_owned(), origin, factor });
    }
}

/// Whether a study is in SI.
pub(super) fn is_si(root: &Table) -> bool {
    let (mut plain, mut twins) = (false, false);
    for section in Section::ALL {
        for table in tables(root, *section) {
            for (name, _) in table.iter() {
                match vocabulary::key(*section, name).map(|key| key.role) {
                    Some(Role::Scale(_)) => return true,
                    Some(
                        Role::Twin(..)
                        | Role::Speeds { si: true }
                        | Role::Band { hertz: true }
                        | Role::FrictionForce(..),
                    ) => {
                        twins = true;
                    }
                    Some(Role::Speeds { si: false }) => plain = true,
                    Some(Role::Size(_, size)) if !size.belongs(true) => plain = true,
                    Some(Role::Size(_, size)) if !size.belongs(false) => twins = true,
                    Some(Role::Number(parameter))
                        if !parameter.si.is_empty() && !parameter.is_pure() =>
                    {
                        plain = true;
                    }
                    _ => {}
                }
            }
        }
    }
    twins && !plain
}

/// The tables of a section.
fn tables(root: &Table, section: Section) -> Vec<&Table> {
    let node = match section {
        // An envelope is within its dither or load, of which there may be several.
        Section::Root | Section::Sweep | Section::Envelope | Section::LoadEnvelope => None,
        Section::DiscDrive => {
            root.get("disc").and_then(Node::table).and_then(|disc| disc.get("drive"))
        }
        Section::Constants => {
            root.get("friction").and_then(Node::table).and_then(|table| table.get("constants"))
        }
        Section::DesignLimits => {
            root.get("design").and_then(Node::table).and_then(|design| design.get("limits"))
        }
        Section::Initial | Section::Drive | Section::Load => {
            let name = section.path().trim_start_matches("belt.");
            root.get("belt").and_then(Node::table).and_then(|belt| belt.get(name))
        }
        _ => root.get(section.path()),
    };
    match node.map(|node| &node.value) {
        Some(Value::Table(table)) => vec![table],
        Some(Value::List(list)) => list.iter().filter_map(Node::table).collect(),
        _ => Vec::new(),
    }
}
