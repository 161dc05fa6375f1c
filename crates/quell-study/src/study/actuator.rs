//! `[actuator]`: what gives the dither, by the numbers of its data sheet or a measured frequency response.

use quell_design::actuator::{Actuator, ActuatorKind, CoilActuator, MeasuredActuator, PiezoStack};
use quell_input::actuator_file::{ActuatorFile, COLUMNS, GivenColumn};
use quell_input::complaint::{Complaint, Fault, Origin};
use quell_input::document::{Node, Table};
use quell_input::said::Said;
use quell_model::digits::digits;
use quell_model::parameter::Parameter;
use quell_model::parameter::actuator::{
    ACTUATOR, ACTUATOR_MASS, ACTUATOR_STIFFNESS, BLOCKED_FORCE, CAPACITANCE, FORCE_PER_AMPERE,
    FREE_STROKE, INDUCTANCE, MAXIMUM_CURRENT, MAXIMUM_VOLTAGE, RESISTANCE, RMS_CURRENT,
    SAMPLE_RATE,
};
use quell_model::units::Quantity;
use serde_json::Value as Json;

use super::reader::Reader;
use super::vocabulary::{Choice, KeyUnit, Section, join};
use super::without_units::WithoutUnits;

/// Path of the table.
const PATH: &str = "actuator";

/// Share by which the stiffness of a piezo stack may differ from its blocked force over its free stroke.
const AGREES: f64 = 0.1;

const OF_A_PIEZO: &[Parameter] = &[
    BLOCKED_FORCE,
    FREE_STROKE,
    ACTUATOR_STIFFNESS,
    ACTUATOR_MASS,
    CAPACITANCE,
    MAXIMUM_VOLTAGE,
    MAXIMUM_CURRENT,
];

const OF_A_COIL: &[Parameter] = &[
    FORCE_PER_AMPERE,
    FREE_STROKE,
    ACTUATOR_STIFFNESS,
    ACTUATOR_MASS,
    MAXIMUM_VOLTAGE,
    MAXIMUM_CURRENT,
    RMS_CURRENT,
    RESISTANCE,
    INDUCTANCE,
    SAMPLE_RATE,
];

const OF_A_MEASUREMENT: &[Parameter] = &[MAXIMUM_VOLTAGE, MAXIMUM_CURRENT, RMS_CURRENT];

/// Reads `[actuator]`: `Some(None)` without it, `None` if it is invalid.
#[expect(clippy::option_option, reason = "invalid, absent, given")]
pub(super) fn read(reader: &mut Reader, root: &Table) -> Option<Option<Actuator>> {
    let Some(node) = root.get(PATH) else { return Some(None) };
    let table = reader.table(PATH, node)?;
    let before = reader.complaints_so_far();
    reader.unknown_keys(table, Section::Actuator, PATH);
    let name = reader.needed_choice(table, PATH, node.origin, "kind", Choice::ActuatorKind)?;
    let kind = ActuatorKind::ALL.into_iter().find(|kind| kind.name() == name)?;
    let mut given = GivenNumbers { reader, table, header: node.origin, kind };
    given.refuse_others();
    let actuator = match kind {
        ActuatorKind::Piezo => given.piezo().map(Actuator::Piezo),
        ActuatorKind::VoiceCoil => given.coil().map(Actuator::VoiceCoil),
        ActuatorKind::Motor => given.coil().map(Actuator::Motor),
        ActuatorKind::FrequencyResponse => given.measured(),
    };
    actuator.filter(|_| reader.complaints_so_far() == before).map(Some)
}

/// The numbers of the table.
struct GivenNumbers<'r, 'a> {
    reader: &'r mut Reader,
    table: &'a Table,
    header: Origin,
    kind: ActuatorKind,
}

impl GivenNumbers<'_, '_> {
    /// The node of a parameter, by any of its keys.
    fn node(&self, parameter: Parameter) -> Option<(&'static str, &Node)> {
        parameter.keys().find_map(|key| Some((key, self.table.get(key)?)))
    }

    /// A number, if it is given and right.
    fn number(&mut self, parameter: Parameter) -> Option<f64> {
        self.reader.optional(self.table, PATH, parameter).if_given().flatten()
    }

    fn needed(&mut self, parameter: Parameter, why: &str) -> Option<f64> {
        if self.node(parameter).is_none() {
            self.missing(parameter.key(), format!("given ({}): {why}", parameter.about));
        }
        self.number(parameter)
    }

    fn missing(&mut self, key: &str, allowed: impl Into<Said>) {
        let key = join(PATH, key);
        self.reader.complain(Complaint::new(Fault::Missing, key, self.header, Json::Null, allowed));
    }

    fn conflict(&mut self, key: &str, origin: Origin, allowed: impl Into<Said>) {
        let key = join(PATH, key);
        self.reader.complain(Complaint::new(Fault::Conflict, key, origin, Json::Null, allowed));
    }

    /// Reports keys of other kinds.
    fn refuse_others(&mut self) {
        let own = match self.kind {
            ActuatorKind::Piezo => OF_A_PIEZO,
            ActuatorKind::VoiceCoil | ActuatorKind::Motor => OF_A_COIL,
            ActuatorKind::FrequencyResponse => OF_A_MEASUREMENT,
        };
        let file = (self.kind == ActuatorKind::FrequencyResponse).then_some("file");
        let names: Vec<&str> = own.iter().map(Parameter::key).chain(file).collect();
        let is_own = |parameter: &Parameter| own.iter().any(|known| known.path == parameter.path);
        let others = ACTUATOR.iter().filter(|parameter| !is_own(parameter));
        let mut others: Vec<(&str, Origin)> = others
            .filter_map(|parameter| self.node(*parameter))
            .map(|(key, node)| (key, node.origin))
            .collect();
        if file.is_none() {
            others.extend(self.table.get("file").map(|node| ("file", node.origin)));
        }
        for (key, origin) in others {
            let allowed = format!(
                "omitted: an actuator of kind \"{}\" has {}",
                self.kind.name(),
                names.join(", ")
            );
            self.conflict(key, origin, allowed);
        }
    }

    fn piezo(&mut self) -> Option<PiezoStack> {
        let blocked = self.needed(BLOCKED_FORCE, "it limits the dither");
        let (stroke, stiffness) = (self.number(FREE_STROKE), self.number(ACTUATOR_STIFFNESS));
        let (mass, capacitance) = (self.number(ACTUATOR_MASS), self.number(CAPACITANCE));
        let (voltage, current) = (self.number(MAXIMUM_VOLTAGE), self.number(MAXIMUM_CURRENT));
        if self.node(MAXIMUM_CURRENT).is_some() {
            for parameter in [MAXIMUM_VOLTAGE, CAPACITANCE] {
                if self.node(parameter).is_none() {
                    self.missing(parameter.key(), "given: maximum_current limits C dU/dt");
                }
            }
        }
        let blocked = blocked?;
        if let (Some(stroke), Some(stiffness), Some((key, node))) =
            (stroke, stiffness, self.node(ACTUATOR_STIFFNESS))
        {
            let origin = node.origin;
            let follows = blocked / stroke;
            if (stiffness / follows - 1.0).abs() > AGREES {
                let allowed = format!(
                    "blocked_force/free_stroke to within {} %, or omitted; it is {} times that",
                    digits(100.0 * AGREES, 3),
                    digits(stiffness / follows, 4)
                );
                self.conflict(key, origin, allowed);
            }
        }
        Some(PiezoStack {
            blocked_force: blocked,
            stiffness: stiffness.or(stroke.map(|stroke| blocked / stroke)).unwrap_or(0.0),
            mass: mass.unwrap_or(0.0),
            capacitance,
            maximum_voltage: voltage,
            maximum_current: current,
        })
    }

    fn coil(&mut self) -> Option<CoilActuator> {
        let force_per_ampere = self.needed(FORCE_PER_AMPERE, "it gives the current of a force");
        let limits = [RMS_CURRENT, MAXIMUM_CURRENT, MAXIMUM_VOLTAGE, FREE_STROKE];
        if limits.iter().all(|limit| self.node(*limit).is_none()) {
            self.missing(
                RMS_CURRENT.key(),
                "given, or maximum_current, maximum_voltage or free_stroke: an actuator without a limit gives any dither",
            );
        }
        for parameter in [MAXIMUM_VOLTAGE, INDUCTANCE] {
            if self.node(parameter).is_some() && self.node(RESISTANCE).is_none() {
                self.missing(
                    RESISTANCE.key(),
                    format!(
                        "given: {} needs it, as U = R I + L dI/dt + K_f dx/dt",
                        parameter.key()
                    ),
                );
                break;
            }
        }
        let watts = self.reader.units().of_si(Quantity::Power).map_or(1.0, f64::recip);
        let coil = CoilActuator {
            force_per_ampere: 1.0,
            stiffness: self.number(ACTUATOR_STIFFNESS).unwrap_or(0.0),
            mass: self.number(ACTUATOR_MASS).unwrap_or(0.0),
            free_stroke: self.number(FREE_STROKE),
            rms_current: self.number(RMS_CURRENT),
            maximum_current: self.number(MAXIMUM_CURRENT),
            maximum_voltage: self.number(MAXIMUM_VOLTAGE),
            resistance: self.number(RESISTANCE),
            inductance: self.number(INDUCTANCE),
            watts,
            sample_rate: self.number(SAMPLE_RATE),
        };
        Some(CoilActuator { force_per_ampere: force_per_ampere?, ..coil })
    }

    fn measured(&mut self) -> Option<Actuator> {
        let [maximum_voltage, maximum_current, rms_current] =
            [MAXIMUM_VOLTAGE, MAXIMUM_CURRENT, RMS_CURRENT].map(|limit| self.number(limit));
        let Some(node) = self.table.get("file") else {
            self.missing("file", "a CSV file with columns frequency and force_per_volt, force_per_ampere or maximum_force");
            return None;
        };
        let name = self.reader.text("actuator.file", node)?;
        let key = "actuator.file";
        let file = ActuatorFile::read(self.reader.files(), key, &name);
        let file = self.reader.in_file((key, node), &name, file)?;
        let series = self.series(&file);
        let [frequencies, per_volt, per_ampere, most] =
            self.reader.in_file((key, node), &name, series)?;
        let needs = [
            (MAXIMUM_VOLTAGE, per_volt.is_some(), COLUMNS[1].0),
            (MAXIMUM_CURRENT, per_ampere.is_some(), COLUMNS[2].0),
            (RMS_CURRENT, per_ampere.is_some(), COLUMNS[2].0),
        ];
        for (limit, has, column) in needs {
            let origin = self.node(limit).map(|(_, node)| node.origin);
            if let (Some(origin), false) = (origin, has) {
                self.conflict(
                    limit.key(),
                    origin,
                    format!("omitted, or a file with a column {column}"),
                );
            }
        }
        let limited = [maximum_voltage, maximum_current, rms_current].iter().any(Option::is_some);
        if !limited && most.is_none() {
            let allowed = "given, or maximum_current, rms_current, or a file with a column maximum_force: an actuator \
                           without a limit gives any dither";
            self.missing(MAXIMUM_VOLTAGE.key(), allowed);
        }
        Some(Actuator::Measured(MeasuredActuator {
            frequencies: frequencies?,
            force_per_volt: per_volt,
            force_per_ampere: per_ampere,
            maximum_force: most,
            maximum_voltage,
            maximum_current,
            rms_current,
        }))
    }

    /// The columns of a file in numbers of the equations.
    fn series(&self, file: &ActuatorFile) -> Result<[Option<Vec<f64>>; 4], WithoutUnits> {
        let mut series = [const { None }; 4];
        for (place, column) in file.columns.iter().enumerate() {
            let Some(GivenColumn { si, values }) = column else { continue };
            let quantity = if place == 0 { Quantity::FrequencyRatio } else { Quantity::Force };
            let (_, si_name) = COLUMNS[place];
            let units = self.reader.units();
            if *si && !units.take_suffixes() {
                let (plain, _) = COLUMNS[place];
                return Err(WithoutUnits::Si { plain, si: si_name });
            }
            let unit = match quantity.si_unit() {
                Some((unit, _)) if *si => KeyUnit::Suffix(unit),
                _ => KeyUnit::Study,
            };
            let factor = units.in_equations(1.0, quantity, unit).unwrap_or(1.0);
            series[place] = Some(values.iter().map(|value| value * factor).collect());
        }
        Ok(series)
    }
}
