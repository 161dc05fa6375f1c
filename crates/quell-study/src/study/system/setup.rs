//! What the tables of a system give.

use std::sync::Arc;

use quell_model::System;

use super::frequency_response::FrequencyResponse;
use super::initial::SystemStart;
use super::modes_file::ModeList;
use super::numbers::Numbers;
use super::units::SystemUnits;
use crate::study::belt::friction::Measured;

/// The parts of a study that only a system has.
#[derive(Clone, Debug, PartialEq)]
pub struct SystemSetup {
    pub(super) system: Arc<System>,
    pub(super) observe: Vec<f64>,
    pub(super) initial: SystemStart,
    pub(super) numbers: Numbers,
    pub(super) warnings: Vec<String>,
    /// Samples of the measured laws, contact by contact.
    pub(super) measured: Arc<[Option<Measured>]>,
    /// Files of modes.
    pub(super) modes: Arc<[Arc<ModeList>]>,
    pub(super) response: Option<Arc<FrequencyResponse>>,
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
