//! What the tables of a system give.

use std::sync::Arc;

use quell_design::actuator::Actuator;
use quell_input::document::Table;
use quell_input::frequency_response::FrequencyResponse;
use quell_model::parameter::DITHER_AMPLITUDE;
use quell_model::units::UnitSystem;
use quell_model::{Contact, System};

use super::initial::SystemStart;
use super::rows::RowBasis;
use crate::study::design::Design;
use crate::study::dither_size::GivenSize;
use crate::study::path;
use crate::study::reader::{EquationScale, NumbersByName, Reader};
use crate::study::vocabulary::size::{DITHER_SIZES, SignalMeasure, SizeKey, SizedSignal};

/// The parts of a study that only a system has.
#[derive(Clone, Debug, PartialEq)]
pub struct SystemSetup {
    pub(in crate::study) system: Arc<System>,
    /// The names over which its rows are written.
    pub(in crate::study) basis: Arc<RowBasis>,
    pub(in crate::study) observe: Vec<f64>,
    pub(in crate::study) initial: SystemStart,
    pub(in crate::study) units: UnitSystem,
    pub(in crate::study) named: NumbersByName,
    pub(in crate::study) warnings: Vec<String>,
    pub(in crate::study) response: Option<Arc<FrequencyResponse>>,
    /// The design that is requested.
    pub(in crate::study) design: Option<Design>,
    /// The actuator that gives a dither.
    pub(in crate::study) actuator: Option<Actuator>,
    /// Amplitudes that are given by another size than a peak force.
    pub(in crate::study) sizes: Arc<[GivenSize]>,
    pub(in crate::study) tolerance: Option<f64>,
    pub(in crate::study) record: RecordSettings,
    /// Time of numbers without units in seconds; `None` where the study does not determine it.
    pub(in crate::study) time: Option<ScaledTime>,
}

/// The unit of time of a study whose other numbers have no units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScaledTime {
    /// Units of time in one second.
    pub per_second: f64,
    /// Whether plain times of options are in seconds.
    pub plain_in_seconds: bool,
}

/// How a steady response is recorded, where a study says so; in the units of the system.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RecordSettings {
    /// Time discarded before the record.
    pub settle: Option<f64>,
    /// Length of the record.
    pub length: Option<f64>,
    /// Band of angular frequencies in which levels are reported.
    pub band: Option<[f64; 2]>,
}

impl SystemSetup {
    /// Name of the kind.
    pub const NAME: &'static str = "system";

    /// A system in these units, observed by a row over its coordinates, whose runs begin at rest.
    pub(in crate::study) fn of(system: System, units: UnitSystem, observe: Vec<f64>) -> Self {
        let names = system.structure.names().to_vec();
        Self {
            system: Arc::new(system),
            basis: Arc::new(RowBasis::of(names, "coordinate")),
            observe,
            initial: SystemStart::Rest,
            units,
            named: NumbersByName::default(),
            warnings: Vec::new(),
            response: None,
            design: None,
            actuator: None,
            sizes: Arc::default(),
            tolerance: None,
            record: RecordSettings::default(),
            time: None,
        }
    }

    /// The system in the units of the file.
    pub fn system(&self) -> &System {
        &self.system
    }

    /// The units of the bare numbers of the file.
    pub fn units(&self) -> UnitSystem {
        self.units
    }

    /// Where a run begins.
    pub fn initial(&self) -> &SystemStart {
        &self.initial
    }

    /// The actuator that gives the dither.
    pub fn actuator(&self) -> Option<&Actuator> {
        self.actuator.as_ref()
    }

    /// A reader of numbers as those of this study.
    pub(super) fn reader(&self) -> Reader {
        let mut reader = Reader::in_units(self.units, EquationScale::OfTheFile);
        reader.set_named(self.named.clone());
        reader.set_natural_frequency(self.system.structure.natural_frequency());
        reader
    }

    /// The amplitude of a dither by a key that need not be the one in the file; `None` for other numbers, and for what an actuator takes.
    pub(super) fn amplitude_at(&self, document: &Table, path: &str) -> Option<f64> {
        let (dither, key) = path::amplitude_key(document, path)?;
        let wave = self.system.inputs.get(dither)?.profile.waves().first()?;
        let size = DITHER_SIZES.iter().find(|size| size.key == key);
        if size.is_some_and(SizeKey::needs_actuator) {
            return None;
        }
        let measure = size.map_or(SignalMeasure::Peak, |size| size.measure);
        let of_unit = measure.of_unit(&wave.waveform)?;
        let in_si = DITHER_AMPLITUDE.si.iter().any(|other| other.key == key)
            || size.is_some_and(|size| size.signal == SizedSignal::Newtons);
        let factor = if in_si { self.units.si_per_unit(DITHER_AMPLITUDE.quantity)? } else { 1.0 };
        Some(wave.amplitude * of_unit * factor)
    }
}

/// The rows of a contact with their names.
pub(super) fn rows_of(contact: &Contact) -> impl Iterator<Item = (String, &Vec<f64>)> {
    let rows = [("tangent", &contact.tangent), ("normal", &contact.normal)];
    rows.into_iter()
        .filter_map(|(name, row)| Some((format!("{}.{name}", contact.name), row.as_ref()?)))
}
