//! The amplitude of a dither by another size than its peak force: as a root mean square or peak to peak, or by what it takes of the
//! actuator (a voltage, a current, or per cent of the largest amplitude).
//!
//! What the actuator must give is proportional to the amplitude, so that a size is divided by that of a dither of unit amplitude, at
//! the frequency and with the waveform of the dither ([`quell_design::actuator`]). The structure must be known for it, and the amplitude
//! is zero until then.

use quell_design::actuator::{Actuator, ActuatorDemand, SignalSize};
use quell_linear::driven_point::DrivenPoint;
use quell_model::Waveform;
use quell_model::parameter::{DITHER_AMPLITUDE, Parameter};
use serde_json::Value as Json;

use super::document::{Node, Table};
use super::reader::Reader;
use super::vocabulary::join;
use super::vocabulary::size::{DITHER_SIZES, SignalMeasure, SizeKey, SizedSignal};
use crate::complaint::{Complaint, Fault, Origin};

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
}

/// The key of another size in the table of a dither: `Ok(None)` without one, `Err` where two keys give the amplitude, which has been
/// reported.
pub(super) fn key_in<'t>(
    reader: &mut Reader,
    table: &'t Table,
    prefix: &str,
) -> Result<Option<(SizeKey, &'t Node)>, ()> {
    let mut sizes = DITHER_SIZES.iter().filter_map(|size| Some((*size, table.get(size.key)?)));
    let Some((size, node)) = sizes.next() else { return Ok(None) };
    let others = sizes.map(|(size, _)| size.key);
    let twins = DITHER_AMPLITUDE.si.iter().map(|twin| twin.key).filter(|key| table.has(key));
    let plain = [DITHER_AMPLITUDE.key()].into_iter().filter(|key| table.has(key));
    let Some(other) = plain.chain(twins).chain(others).next() else {
        return Ok(Some((size, node)));
    };
    let (first, second) = (join(prefix, other), join(prefix, size.key));
    let allowed = format!("give either {first} or {second}, not both");
    reader.complain(Complaint::new(Fault::Conflict, second, node.origin, node.given(), allowed));
    Err(())
}

/// The amplitude of a size whose number has been read, in a study with or without a table `[actuator]`.
pub(super) fn sized(
    reader: &mut Reader,
    prefix: &str,
    (key, node): (SizeKey, &Node),
    value: f64,
    (waveform, has_actuator): (Option<&Waveform>, bool),
) -> Option<SizedAmplitude> {
    if key.needs_actuator() {
        if !has_actuator {
            let force = join(prefix, DITHER_AMPLITUDE.key());
            let allowed = format!(
                "a study with a table [actuator], whose equations make it a force; or {force}, the force itself"
            );
            let path = join(prefix, key.key);
            let complaint =
                Complaint::new(Fault::Missing, path, node.origin, node.given(), allowed);
            reader.complain(complaint);
            return None;
        }
        let (prefix, origin, given) = (prefix.to_owned(), node.origin, node.given());
        return Some(SizedAmplitude::Driven(DrivenSize { prefix, key, value, origin, given }));
    }
    let Some(of_unit) = key.measure.of_unit(waveform?) else {
        reader.wrong(&join(prefix, key.key), node, WITHOUT_PEAK_TO_PEAK);
        return None;
    };
    Some(SizedAmplitude::Known(value / of_unit, Some((key, value))))
}

/// Why noise has no peak-to-peak value.
pub(super) const WITHOUT_PEAK_TO_PEAK: &str =
    "a peak or a root mean square instead: the lines of noise have no peak-to-peak value";

/// A number of the registry with the bounds of an amplitude, for the key of a size.
pub(super) fn parameter_of(key: SizeKey) -> Parameter {
    Parameter { symbol: key.symbol, about: key.about, si: &[], ..DITHER_AMPLITUDE }
}

impl DrivenSize {
    /// The amplitude, with the point on which the dither acts; `None` without a valid actuator, which has been reported.
    pub(super) fn resolved(
        &self,
        reader: &mut Reader,
        actuator: Option<&Actuator>,
        point: Result<DrivenPoint<'_>, String>,
    ) -> Option<f64> {
        let path = join(&self.prefix, self.key.key);
        let mut wrong = |fault: Fault, allowed: String| {
            let given = self.given.clone();
            reader.complain(Complaint::new(fault, path.as_str(), self.origin, given, allowed));
            None
        };
        let actuator = actuator?;
        let of_unit = point.and_then(|point| self.of_unit(&actuator.demand(&point)));
        match of_unit {
            Ok(of_unit) => {
                let amplitude = self.value / of_unit;
                if amplitude.is_finite() {
                    return Some(amplitude);
                }
                let allowed = "omitted: the actuator makes no force of this frequency".to_owned();
                wrong(Fault::Conflict, allowed)
            }
            Err(why) => wrong(Fault::Conflict, format!("a dither whose demand is known: {why}")),
        }
    }

    /// The size that belongs to a dither of unit amplitude.
    fn of_unit(&self, demand: &ActuatorDemand) -> Result<f64, String> {
        let size = match self.key.signal {
            SizedSignal::Force | SizedSignal::Newtons => return Ok(1.0),
            SizedSignal::Voltage => demand.voltage.clone()?,
            SizedSignal::Current => demand.current.clone()?,
            SizedSignal::Rated => {
                let reach = demand.reach()?;
                if reach.amplitude == 0.0 {
                    return Err(format!(
                        "{} allows no dither of this frequency",
                        reach.limit.path()
                    ));
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
