//! The number of a belt that a path names, in the unit of its key.

use quell_input::document::Table;
use quell_model::Belt;
use quell_model::parameter::{MASS, NATURAL_FREQUENCY, NORMAL_LOAD, Parameter, STIFFNESS, SiTwin};
use quell_model::units::{Quantity, Scales, UnitSystem, measure};

use super::units;
use crate::study::path::{self, Address, key_at};
use crate::study::vocabulary::size::{SizeKey, SizedSignal};
use crate::study::vocabulary::{DocumentKind, Role, join};

/// The value of the key at a path, such as `dither.amplitude` or `dither.amplitude_n`, in the unit of the key; `None` where the
/// belt has no such number.
pub(super) fn number(belt: &Belt, document: &Table, path: &str) -> Option<f64> {
    let address = key_at(path, DocumentKind::Belt).ok()?;
    if let Some(scale) = address.key.parameter().filter(|known| is_scale(*known)) {
        let scales = belt.scales()?;
        let own = scale_of(scale, &scales)?;
        return match address.key.role {
            Role::Twin(_, other) => in_unit(scale.quantity, own, scales.units(), other.unit),
            _ => Some(own),
        };
    }
    if let Some((dither, _)) = path::amplitude_key(document, path) {
        return Some(per_one(belt, path)? * belt.dithers().get(dither)?.amplitude);
    }
    // A number of the law may be left out, and the load where friction is given as forces.
    let left_out = || match number_of_the_equations(path, &address) {
        number if number == NORMAL_LOAD.path && belt.load().is_none() => Some(belt.normal_load()),
        number => belt.friction().get(&number),
    };
    path::number(document, &mut units::reader(document), path)
        .or_else(|| Some(per_one(belt, path)? * left_out()?))
}

/// The path of the number of the equations that a key gives.
pub(in crate::study) fn number_of_the_equations(path: &str, address: &Address) -> String {
    let table = path.trim().rsplit_once('.').map_or("", |(table, _)| table);
    match (address.key.role, address.key.parameter()) {
        (Role::Constant, _) | (_, None) => path.trim().to_owned(),
        (_, Some(parameter)) => join(table, parameter.key()),
    }
}

/// What the key at a path gives for one number of the equations; `None` for keys that give several numbers or none.
pub(in crate::study) fn per_one(belt: &Belt, path: &str) -> Option<f64> {
    let address = key_at(path, DocumentKind::Belt).ok()?;
    let scales = belt.scales();
    let own = |quantity| scales.map_or(1.0, |scales| own_units(&scales, quantity, 1.0));
    match address.key.role {
        Role::Constant | Role::Coefficient => Some(1.0),
        Role::Number(parameter) | Role::Twin(parameter, _) if is_scale(parameter) => None,
        Role::Number(parameter) if parameter.is_pure() => Some(1.0),
        Role::Number(parameter) => Some(own(parameter.quantity)),
        Role::Twin(parameter, SiTwin { unit: "", .. }) => match scales {
            None if parameter.quantity == Quantity::DampingRatio => Some(2.0),
            _ => Some(own(parameter.quantity)),
        },
        Role::Twin(parameter, other) => {
            in_unit(parameter.quantity, own(parameter.quantity), scales?.units(), other.unit)
        }
        Role::Size(parameter, size) => {
            let of_peak = of_peak(belt, &address, size)?;
            let has_units = size.signal == SizedSignal::Force || scales.is_some();
            has_units.then(|| of_peak * own(parameter.quantity))
        }
        _ => None,
    }
}

fn is_scale(parameter: Parameter) -> bool {
    quell_model::parameter::SCALES.iter().any(|scale| scale.path == parameter.path)
}

/// A number of the equations in the units of the study, angular of a frequency.
fn own_units(scales: &Scales, quantity: Quantity, number: f64) -> f64 {
    match quantity {
        Quantity::FrequencyRatio => scales.angular_frequency() * number,
        quantity => scales.to_units(quantity, number),
    }
}

/// A number in the units of a study in another unit, hertz of a frequency.
fn in_unit(quantity: Quantity, number: f64, units: UnitSystem, unit: &str) -> Option<f64> {
    let (si_unit, _) = quantity.si_unit()?;
    measure::convert(number * units.si_per_unit(quantity)?, si_unit, unit)
}

/// The size that a key gives of a force whose peak is 1; `None` for what an actuator takes.
fn of_peak(belt: &Belt, address: &Address, size: SizeKey) -> Option<f64> {
    let dither = belt.dithers().get(address.index.unwrap_or(0))?;
    size.measure.of_unit(&dither.waveform).filter(|_| !size.needs_actuator())
}

fn scale_of(scale: Parameter, scales: &Scales) -> Option<f64> {
    let known = [
        (MASS, scales.mass()),
        (STIFFNESS, scales.stiffness()),
        (NATURAL_FREQUENCY, scales.angular_frequency()),
    ];
    known.into_iter().find(|(known, _)| known.path == scale.path).map(|(_, value)| value)
}
