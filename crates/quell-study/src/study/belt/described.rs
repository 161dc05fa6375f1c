//! A belt as its system, which answers what is said of belts and systems alike. Its numbers keep their paths.

use std::f64::consts::TAU;

use quell_design::actuator::Actuator;
use quell_input::complaint::{Complaint, Fault, Origin};
use quell_model::units::{Quantity, UnitSystem};
use quell_model::{Belt, Invalid, InvalidValues, System};
use serde_json::Value as Json;

use crate::study::Solver;
use crate::study::design::Design;
use crate::study::dither_size::SizedAmplitude;
use crate::study::reader::Reader;
use crate::study::system::{RecordSettings, SystemSetup, SystemStart, sized};

/// What a run of a belt needs, in numbers of the equations but for what is asked for.
pub(super) struct BeltRun {
    pub(super) initial: SystemStart,
    pub(super) solver: Solver,
    pub(super) band: Option<[f64; 2]>,
    /// The design that is asked for, in the units of the system.
    pub(super) design: Option<Design>,
    /// The actuator that gives the dither, in the units of the system.
    pub(super) actuator: Option<Actuator>,
    /// The amplitudes of the dithers, in order, with their paths.
    pub(super) sizes: Vec<(String, SizedAmplitude)>,
}

/// A belt with the amplitudes that an actuator determines, and its system in the units of a study that has units, otherwise in the numbers
/// of the equations; `None` if something is wrong, which has then been reported.
pub(super) fn system(reader: &mut Reader, belt: Belt, run: BeltRun) -> Option<(Belt, SystemSetup)> {
    let BeltRun { initial, solver, band, design, actuator, sizes } = run;
    let units = belt.scales().map_or(UnitSystem::None, |scales| scales.units());
    let scales = belt.scales();
    let one = |quantity| scales.map_or(1.0, |scales| scales.to_units(quantity, 1.0));
    let force = one(Quantity::Force);
    let is_driven = sizes.iter().any(|(_, size)| size.is_driven());
    let sizes = sizes.into_iter().map(|(path, size)| (path, size.times(force))).collect();
    let mut system = in_units(reader, &belt)?;
    let sizes = sized::amplitudes(reader, &mut system, actuator.as_ref(), sizes)?;
    let mut belt = belt;
    if is_driven {
        for size in &sizes {
            belt = belt
                .with_amplitude(size.dither, size.amplitude / force)
                .map_err(|invalid| reader.adopt(invalid))
                .ok()?;
        }
        system = in_units(reader, &belt)?;
    }
    let time = one(Quantity::Time);
    let record = RecordSettings {
        settle: Some(time * solver.settle),
        length: Some(time * TAU * f64::from(solver.record_periods)),
        band: band.map(|ends| ends.map(|end| end / time)),
    };
    let setup = SystemSetup {
        initial: start(initial, one(Quantity::Velocity)),
        design,
        actuator,
        sizes: sizes.into(),
        tolerance: Some(solver.tolerance),
        record,
        ..SystemSetup::of(system, units, vec![1.0])
    };
    Some((belt, setup))
}

/// The system of a belt in the units of answers.
fn in_units(reader: &mut Reader, belt: &Belt) -> Option<System> {
    let refused = |invalid: InvalidValues| {
        for Invalid { key, value, allowed } in invalid {
            let value = Json::String(value);
            reader.complain(Complaint::new(Fault::Value, key, Origin::Whole, value, allowed));
        }
    };
    belt.system_in_units().unwrap_or_else(|| Ok(belt.system())).map_err(refused).ok()
}

/// Where runs begin; displacements are lengths in both, velocities have this unit.
fn start(mut initial: SystemStart, velocity_unit: f64) -> SystemStart {
    if let SystemStart::Values(values) = &mut initial {
        values[1] *= velocity_unit;
    }
    initial
}
