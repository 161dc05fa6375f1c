//! `[system]`: the study of any linear structure with friction contacts.
//!
//! A structure is given by matrices over named coordinates, by first-order equations, by modes, or by a measured frequency
//! response; `[[contact]]` and `[[dither]]` name its coordinates in their rows. Numbers are in the units of the file
//! ([`UnitSystem`]), and any of them may be a formula of `[parameters]`.

mod contact;
mod dither;
mod frequency_response;
mod initial;
mod mass;
mod matrices;
mod modes;
mod names;
mod parameters;
mod read;
mod rows;
mod setup;
pub(in crate::study) mod sized;
mod structure;
mod template;
mod unused;

use quell_design::actuator::Actuator;
use quell_input::complaint::{Complaints, Origin};
use quell_input::document::{Node, Table, Value};
use quell_model::System;
use quell_model::units::UnitSystem;

use super::StudyOf;
use super::design::{Design, DitherPlace};
use super::dither_size::GivenSize;
use super::reader::{EquationScale, Reader};
use super::study_kind::StudyKind;

pub(in crate::study) use dither::PLACES;
pub use initial::SystemStart;
pub use quell_input::frequency_response::FrequencyResponse;
pub(in crate::study) use read::assemble;
pub use setup::{RecordSettings, ScaledTime, SystemSetup};

use crate::study::path::{self, set};

/// A checked study of a system.
pub type SystemStudy = StudyOf<SystemSetup>;

impl StudyKind for SystemSetup {
    fn reader(_: &Table) -> Reader {
        Reader::in_units(UnitSystem::None, EquationScale::OfTheFile)
    }

    fn read(reader: &mut Reader, document: &Table) -> Option<Self> {
        read::study(reader, document).map(|setup| read::with_warnings(setup, document))
    }
}

impl SystemStudy {
    /// The system, its numbers in the units of the file and its frequencies angular; input `i` is `[[dither]]` `i`.
    pub fn system(&self) -> &System {
        &self.kind().system
    }

    /// The units of the bare numbers of the file.
    pub fn units(&self) -> UnitSystem {
        self.kind().units
    }

    /// The unit of time in seconds, where the study determines it although its numbers have no units.
    pub fn scaled_time(&self) -> Option<ScaledTime> {
        self.kind().time
    }

    /// Units of time in one second; `None` for a study without seconds.
    pub fn time_per_second(&self) -> Option<f64> {
        match self.units() {
            UnitSystem::None => self.kind().time.map(|time| time.per_second),
            // Both systems of units have the second.
            UnitSystem::Si | UnitSystem::MmTonneSecond => Some(1.0),
        }
    }

    /// The measured receptance of a study with `frequency_response`.
    ///
    /// The [`SystemStudy::system`] of such a study has no matrices: its structure only names the measured points, over which
    /// the rows of contacts and inputs are, with unit masses and without damping and stiffness.
    pub fn frequency_response(&self) -> Option<&FrequencyResponse> {
        self.kind().response.as_deref()
    }

    /// What is valid but unlikely, in sentences.
    pub fn warnings(&self) -> &[String] {
        &self.kind().warnings
    }

    /// The names of rows over the coordinates: `CONTACT.tangent` and `CONTACT.normal` of the contacts, then points and coordinates.
    pub fn row_names(&self) -> Vec<String> {
        let others = self.kind().basis.candidates().into_iter().map(str::to_owned);
        self.contact_row_names().chain(others).collect()
    }

    /// The names of the rows of the contacts.
    pub fn contact_row_names(&self) -> impl Iterator<Item = String> {
        self.system().contacts.iter().flat_map(setup::rows_of).map(|(name, _)| name)
    }

    /// The row of one of [`SystemStudy::row_names`]; a point before the row of a contact, if they have one name.
    pub fn row_named(&self, name: &str) -> Option<Vec<f64>> {
        let of_contacts = || {
            let mut rows = self.system().contacts.iter().flat_map(setup::rows_of);
            rows.find(|(known, _)| known == name).map(|(_, row)| row.clone())
        };
        self.kind().basis.named(name).or_else(of_contacts)
    }

    /// The displacement that a response measures, a row over the coordinates or states: `system.observe`, or the tangent of
    /// the first contact that has one.
    pub fn observe(&self) -> Vec<f64> {
        self.kind().observe.clone()
    }

    /// The same without a copy.
    pub fn observed_row(&self) -> &[f64] {
        &self.kind().observe
    }

    /// The design that the study requests.
    pub fn design(&self) -> Option<&Design> {
        self.kind().design.as_ref()
    }

    /// The actuator that gives the dither.
    pub fn actuator(&self) -> Option<&Actuator> {
        self.kind().actuator.as_ref()
    }

    /// The dither, counted from 0, whose amplitude a path names; `None` for any other number.
    pub fn dither_of(&self, path: &str) -> Option<usize> {
        path::amplitude_of(&self.source.document, path)
    }

    /// Bound on the last retained terms of a step of a run, relative to the load; `None` for that of the engine.
    pub fn tolerance(&self) -> Option<f64> {
        self.kind().tolerance
    }

    /// How a steady response is recorded, where the study says so.
    pub fn record(&self) -> RecordSettings {
        self.kind().record
    }

    /// Where a run begins.
    pub fn initial(&self) -> &SystemStart {
        &self.kind().initial
    }

    /// The amplitudes that the study gives by another size than a peak force.
    pub fn given_sizes(&self) -> &[GivenSize] {
        &self.kind().sizes
    }

    /// The study with a dither, counted from 0, at one of the places of its design, which is its only one, with this amplitude: its own may be
    /// too large for the place.
    ///
    /// # Errors
    /// All complaints about the changed study.
    pub fn at_place(
        &self,
        dither: usize,
        place: &DitherPlace,
        (path, amplitude): (&str, f64),
    ) -> Result<Self, Complaints> {
        let mut document = self.source.document.clone();
        if let Some(design) = document.get_mut("design").and_then(Node::table_mut) {
            design.remove(PLACES);
        }
        if let Some(table) = dither::table_mut(&mut document, dither) {
            dither::put_at(table, place);
        }
        let node = Node { value: Value::Number(amplitude), origin: Origin::Whole };
        set(&mut document, path, &node)?;
        let mut changes = self.source.changes.clone();
        changes.push(format!("dither at {}", place.name));
        self.check_again(document, changes)
    }
}
