//! What the tables of a system give.

use std::sync::Arc;

use quell_design::actuator::Actuator;
use quell_input::document::Table;
use quell_input::frequency_response::FrequencyResponse;
use quell_model::System;
use quell_model::parameter::DITHER_AMPLITUDE;
use quell_model::system::Structure;
use quell_model::units::UnitSystem;

use super::initial::SystemStart;
use crate::study::design::Design;
use crate::study::dither_size::GivenSize;
use crate::study::passivity;
use crate::study::path;
use crate::study::reader::{EquationScale, NumbersByName, Reader};
use crate::study::vocabulary::size::{DITHER_SIZES, SignalMeasure, SizeKey, SizedSignal};

/// The parts of a study that only a system has.
#[derive(Clone, Debug, PartialEq)]
pub struct SystemSetup {
    pub(super) system: Arc<System>,
    pub(super) observe: Vec<f64>,
    pub(super) initial: SystemStart,
    pub(super) units: UnitSystem,
    pub(super) named: NumbersByName,
    pub(super) warnings: Vec<String>,
    pub(super) response: Option<Arc<FrequencyResponse>>,
    /// The design that is requested.
    pub(super) design: Option<Design>,
    /// The actuator that gives a dither.
    pub(super) actuator: Option<Actuator>,
    /// Amplitudes that are given by another size than a peak force.
    pub(super) sizes: Arc<[GivenSize]>,
    pub(super) tolerance: Option<f64>,
    pub(super) record: RecordSettings,
    /// Time of numbers without units in seconds; `None` where the study does not determine it.
    pub(super) time: Option<ScaledTime>,
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

/// A system that a study of another kind describes, with what a run of it needs.
#[derive(Clone, Debug)]
pub struct DescribedSystem {
    /// The system, in these units.
    pub system: System,
    /// The units of its numbers.
    pub units: UnitSystem,
    /// The row that is observed, over the coordinates.
    pub observe: Vec<f64>,
    /// Where a run begins.
    pub initial: SystemStart,
    /// What is valid but unlikely, in sentences.
    pub warnings: Vec<String>,
    /// Amplitudes that are given by another size than a peak force.
    pub sizes: Vec<GivenSize>,
    /// The actuator that gives the first dither, in these units.
    pub actuator: Option<Actuator>,
    /// The design that is requested, in these units.
    pub design: Option<Design>,
    /// Bound on the last retained terms of a step of a run, relative to the load; `None` for that of the engine.
    pub tolerance: Option<f64>,
    /// How a steady response is recorded.
    pub record: RecordSettings,
    /// Its unit of time, if it is known.
    pub time: Option<ScaledTime>,
}

impl From<DescribedSystem> for SystemSetup {
    fn from(described: DescribedSystem) -> Self {
        let DescribedSystem {
            system,
            units,
            observe,
            initial,
            mut warnings,
            sizes,
            actuator,
            design,
            tolerance,
            record,
            time,
        } = described;
        warnings.extend(passivity::warnings(&system.contacts, units));
        Self {
            system: Arc::new(system),
            observe,
            initial,
            units,
            named: NumbersByName::default(),
            warnings,
            response: None,
            design,
            actuator,
            sizes: sizes.into(),
            tolerance,
            record,
            time,
        }
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
    pub fn units(&self) -> UnitSystem {
        self.units
    }
}

impl SystemSetup {
    /// The same parts with another system.
    pub(in crate::study) fn with_system(&self, system: System) -> Self {
        Self { system: system.into(), ..self.clone() }
    }

    /// A reader of numbers as those of this study.
    pub(super) fn reader(&self) -> Reader {
        let mut reader = Reader::in_units(self.units, EquationScale::OfTheFile);
        reader.set_named(self.named.clone());
        reader.set_natural_frequency(natural_frequency(&self.system.structure));
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

/// The natural frequency √(k/m) of one coordinate with a spring.
pub(super) fn natural_frequency(structure: &Structure) -> Option<f64> {
    let mechanical = structure.mechanical().filter(|mechanical| mechanical.size() == 1)?;
    let ratio = mechanical.stiffness()[(0, 0)] / mechanical.mass().matrix()[(0, 0)];
    (ratio > 0.0).then(|| ratio.sqrt())
}
