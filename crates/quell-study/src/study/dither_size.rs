//! The amplitude of a dither by another size than its peak force: as a root mean square or peak to peak, or by what it takes of the
//! actuator (a voltage, a current, or per cent of the largest amplitude).
//!
//! What the actuator must give is proportional to the amplitude, so that a size is divided by that of a dither of unit amplitude, at
//! the frequency and with the waveform of the dither ([`quell_design::actuator`]). The structure must be known for it, and the amplitude
//! is zero until then.

use quell_design::NoAnswer;
use quell_design::actuator::{Actuator, ActuatorDemand, SignalSize, UnknownDemand};
use quell_input::complaint::{Complaint, Fault, Origin};
use quell_input::document::{Node, Table, Value};
use quell_linear::driven_point::DrivenPoint;
use quell_model::Waveform;
use quell_model::parameter::DITHER_AMPLITUDE;
use quell_model::units::Quantity;
use quell_model::units::measure;
use serde_json::Value as Json;

use super::reader::{Reader, WantedNumber};
use super::vocabulary::size::{DITHER_SIZES, SignalMeasure, SizeKey, SizedSignal};
use super::vocabulary::{KeyUnit, join};

/// An amplitude as the study gives it.
#[derive(Clone, Debug, PartialEq)]
pub struct GivenSize {
    /// The dither, counted from 0.
    pub dither: usize,
    /// The path of the key, such as `dither.amplitude_v`.
    pub path: String,
    /// The key.
    pub key: SizeKey,
    /// Its number.
    pub value: f64,
    /// The amplitude that follows, in numbers of the equations.
    pub amplitude: f64,
}

/// A size that an actuator makes an amplitude.
#[derive(Clone, Debug)]
pub(super) struct DrivenSize {
    prefix: String,
    key: SizeKey,
    value: f64,
    origin: Origin,
    given: Json,
}

/// An amplitude that is known, or one that the actuator determines.
#[derive(Clone, Debug)]
pub(super) enum SizedAmplitude {
    /// In numbers of the equations, with the key that gave it if it is not a peak force.
    Known(f64, Option<(SizeKey, f64)>),
    /// By the actuator.
    Driven(DrivenSize),
}

impl SizedAmplitude {
    /// The amplitude, zero while it is not known.
    pub(super) fn so_far(&self) -> f64 {
        match self {
            Self::Known(amplitude, _) => *amplitude,
            Self::Driven(_) => 0.0,
        }
    }

    /// Whether an actuator determines it.
    pub(super) fn is_driven(&self) -> bool {
        matches!(self, Self::Driven(_))
    }

    /// The same in other units, of which one number of the equations has `one`.
    pub(super) fn times(self, one: f64) -> Self {
        match self {
            Self::Known(amplitude, given) => Self::Known(one * amplitude, given),
            driven @ Self::Driven(_) => driven,
        }
    }
}

/// Reads the amplitude of a dither by any of its keys, in a study with or without a table `[actuator]`; the waveform converts a root mean
/// square and a peak-to-peak value, an actuator what it takes. `None` if it is wrong, which has been reported.
pub(super) fn read(
    reader: &mut Reader,
    table: &Table,
    (prefix, header): (&str, Origin),
    (waveform, has_actuator): (Option<&Waveform>, bool),
) -> Option<SizedAmplitude> {
    let mut sizes = DITHER_SIZES.iter().filter_map(|size| Some((*size, table.get(size.key)?)));
    let Some((key, node)) = sizes.next() else {
        let amplitude = reader.number(table, prefix, header, DITHER_AMPLITUDE)?;
        return Some(SizedAmplitude::Known(amplitude, None));
    };
    let path = join(prefix, key.key);
    let plain = DITHER_AMPLITUDE.keys().filter(|name| table.has(name));
    if let Some(other) = plain.chain(sizes.map(|(size, _)| size.key)).next() {
        reader.not_both(&join(prefix, other), &path, node);
        return None;
    }
    let (value, size) = number(reader, &path, node, key)?;
    if key.needs_actuator() {
        if !has_actuator {
            let force = join(prefix, DITHER_AMPLITUDE.key());
            let allowed = format!(
                "a study with a table [actuator], whose equations make it a force; or {force}, the force itself"
            );
            let given = node.given();
            reader.complain(Complaint::new(Fault::Missing, path, node.origin, given, allowed));
            return None;
        }
        let (prefix, origin, given) = (prefix.to_owned(), node.origin, node.given());
        return Some(SizedAmplitude::Driven(DrivenSize { prefix, key, value, origin, given }));
    }
    let Some(of_unit) = key.measure.of_unit(waveform?) else {
        reader.wrong(&path, node, WITHOUT_PEAK_TO_PEAK);
        return None;
    };
    let amplitude = value / of_unit;
    let of_one = if amplitude == 0.0 { 1.0 } else { size / amplitude };
    reader.remember(prefix, (DITHER_AMPLITUDE.key(), key.key), node.origin, of_one);
    Some(SizedAmplitude::Known(amplitude, Some((key, size))))
}

/// The number of a size in the numbers of the equations, and as it is written.
fn number(reader: &mut Reader, path: &str, node: &Node, key: SizeKey) -> Option<(f64, f64)> {
    let of_share = key.quantity().is_none()
        && matches!(&node.value, Value::Text(text) if measure::has_unit(text));
    let unit = match key.unit {
        "" | "%" => KeyUnit::Study,
        unit => KeyUnit::Suffix(unit),
    };
    // A text such as "80 %" is a share.
    let quantity = key.quantity().or(of_share.then_some(Quantity::Ratio));
    let wanted = WantedNumber { quantity, bounds: DITHER_AMPLITUDE.bounds, unit };
    if key.signal == SizedSignal::Newtons && !reader.units().take_suffixes() {
        let plain = path.replace("amplitude_n", DITHER_AMPLITUDE.key());
        reader.without_units(path, node, Some(plain));
        return None;
    }
    let value = reader.quantity(|| path.to_owned(), node, wanted)?;
    let value = if of_share { 100.0 * value } else { value };
    let written = match node.value {
        Value::Number(number) => number,
        _ => value,
    };
    Some((value, written))
}

/// Why noise has no peak-to-peak value.
pub(super) const WITHOUT_PEAK_TO_PEAK: &str =
    "a peak or a root mean square instead: the lines of noise have no peak-to-peak value";

impl DrivenSize {
    /// The amplitude, with the point on which the dither acts; `None` without a valid actuator, which has been reported.
    pub(super) fn resolved(
        &self,
        reader: &mut Reader,
        actuator: Option<&Actuator>,
        point: Result<DrivenPoint<'_>, NoAnswer>,
    ) -> Option<f64> {
        let path = join(&self.prefix, self.key.key);
        let mut wrong = |fault: Fault, allowed: String| {
            let given = self.given.clone();
            reader.complain(Complaint::new(fault, path.as_str(), self.origin, given, allowed));
            None
        };
        let actuator = actuator?;
        let of_unit = point.and_then(|point| Ok(self.of_unit(&actuator.demand(&point)?)?));
        match of_unit {
            Ok(of_unit) => {
                let amplitude = self.value / of_unit;
                if amplitude.is_finite() {
                    return Some(amplitude);
                }
                let allowed = "omitted: the actuator makes no force of this frequency".to_owned();
                wrong(Fault::Conflict, allowed)
            }
            Err(why) => wrong(
                Fault::Conflict,
                format!(
                    "a force in its place: what the actuator must give for a force is unknown, because {why}"
                ),
            ),
        }
    }

    /// The size that belongs to a dither of unit amplitude.
    fn of_unit(&self, demand: &ActuatorDemand) -> Result<f64, UnknownDemand> {
        let size = match self.key.signal {
            SizedSignal::Force | SizedSignal::Newtons => return Ok(1.0),
            SizedSignal::Voltage => demand.voltage.clone()?,
            SizedSignal::Current => demand.current.clone()?,
            SizedSignal::Rated => {
                let reach = demand.reach()?;
                if reach.amplitude == 0.0 {
                    return Err(UnknownDemand::NoDither(reach.limit));
                }
                return Ok(100.0 / reach.amplitude);
            }
        };
        let SignalSize { peak, root_mean_square, peak_to_peak } = size;
        Ok(match self.key.measure {
            SignalMeasure::Peak => peak,
            SignalMeasure::RootMeanSquare => root_mean_square,
            SignalMeasure::PeakToPeak => peak_to_peak,
        })
    }

    /// What the study gave, with the amplitude that follows.
    pub(super) fn into_given(self, dither: usize, amplitude: f64) -> GivenSize {
        let path = join(&self.prefix, self.key.key);
        GivenSize { dither, path, key: self.key, value: self.value, amplitude }
    }
}
