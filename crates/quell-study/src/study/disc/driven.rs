//! `[actuator]` of a disc: what presses its loads, in SI.
//!
//! An actuator behind the spring of a load gives its normal dither, αN₀g, by the equations of a system
//! ([`Disc::system_in_si`]). The amplitude α of the disc follows from what the actuator takes.

use std::sync::Arc;

use quell_design::actuator::Actuator;
use quell_input::complaint::{Complaint, Fault, Origin};
use quell_input::document::Table;
use quell_model::disc::{Contributions, DiscDither, Load};
use quell_model::units::UnitSystem;
use quell_model::{Disc, System};
use serde_json::Value as Json;

use crate::study::actuator;
use crate::study::dither_size::{GivenSize, SizedAmplitude};
use crate::study::reader::{EquationScale, Reader};
use crate::study::system::sized;

/// The actuator of a disc, and the amplitude that the study gives by what it takes.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct DiscActuator {
    pub(super) actuator: Actuator,
    /// Its amplitude is α.
    pub(super) sizes: Arc<[GivenSize]>,
}

/// Reads `[actuator]`, whose plain numbers are in SI.
#[expect(clippy::option_option, reason = "invalid, absent, given")]
pub(super) fn read(reader: &mut Reader, document: &Table) -> Option<Option<Actuator>> {
    let units = reader.units();
    reader.set_file_units(UnitSystem::Si);
    reader.set_scale(EquationScale::OfTheFile);
    let read = actuator::read(reader, document);
    reader.set_file_units(units.file);
    reader.set_scale(units.scale);
    read
}

/// The disc with the amplitude that its actuator determines; `None` if something is wrong, which has been reported.
pub(super) fn driven(
    reader: &mut Reader,
    disc: Disc,
    parts: Contributions,
    actuator: Actuator,
    size: Option<SizedAmplitude>,
) -> Option<(Disc, DiscActuator)> {
    let mut system = pressed(reader, &disc, parts)?;
    let sizes: Vec<(String, SizedAmplitude)> =
        size.into_iter().map(|size| ("dither".to_owned(), size)).collect();
    let sizes = sized::amplitudes(reader, &mut system, Some(&actuator), sizes)?;
    let load = system.contacts.first().map_or(1.0, |contact| contact.normal_load);
    let mut disc = disc;
    let mut relative = Vec::new();
    for size in sizes {
        let amplitude = size.amplitude / load;
        match disc.with_amplitude(amplitude) {
            Ok(driven) => disc = driven,
            Err(invalid) => {
                for wrong in invalid {
                    let allowed = format!(
                        "such that dither.amplitude, here {amplitude}, is {}",
                        wrong.allowed
                    );
                    reader.complain(Complaint::new(
                        Fault::Value,
                        &size.path,
                        Origin::Whole,
                        size.value,
                        allowed,
                    ));
                }
                return None;
            }
        }
        relative.push(GivenSize { amplitude, ..size });
    }
    Some((disc, DiscActuator { actuator, sizes: relative.into() }))
}

/// The system in SI whose first input is the load that the actuator modulates; `None` without one, which is then reported.
fn pressed(reader: &mut Reader, disc: &Disc, parts: Contributions) -> Option<System> {
    let refused = |reader: &mut Reader, allowed: &str| {
        let key = "actuator";
        reader.complain(Complaint::new(Fault::Conflict, key, Origin::Whole, Json::Null, allowed));
        None
    };
    let first = disc.loads().first();
    let alike = |load: &Load| {
        let own = |load: &Load| (load.normal_load, load.stiffness, load.damping);
        load.patch.is_none() && first.is_some_and(|first| own(first) == own(load))
    };
    if !matches!(disc.dither(), DiscDither::Normal { .. }) {
        return refused(
            reader,
            "with normal dither: tangential dither of a disc is a limit, of which no actuator is described",
        );
    }
    if disc.law().is_none() {
        return refused(
            reader,
            "with [friction] and disc.load.normal_load: a friction that is given as a force does not determine the load",
        );
    }
    if !disc.loads().iter().all(alike) {
        return refused(
            reader,
            "with loads at points that have the same normal_load, stiffness and damping: each has such an actuator",
        );
    }
    let scales = "in a disc with numbers in SI: material and size, or frequencies, plate_mass_kg and outer_radius_m, with radius_ratio of its loads";
    match disc.system_in_si(parts) {
        Some(Ok(system)) => Some(system),
        Some(Err(invalid)) => {
            reader.adopt(invalid);
            None
        }
        None => refused(reader, scales),
    }
}
