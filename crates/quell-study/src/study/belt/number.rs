//! The number of a belt that a path names, in the unit of its key.

use quell_model::Belt;
use quell_model::parameter::{MASS, NATURAL_FREQUENCY, STIFFNESS, ScaleKey, SiTwin};
use quell_model::units::Scales;

use crate::study::vocabulary::size::measure_of;
use crate::study::vocabulary::{Address, Role, join, resolve};

/// The value of the key at a path, such as `dither.amplitude` or, of a study in SI, `dither.amplitude_n`; `None` where the belt has
/// no such number.
pub(in crate::study) fn number(belt: &Belt, path: &str) -> Option<f64> {
    let address = resolve(path).ok()?;
    let table = path.trim().rsplit_once('.').map_or("", |(table, _)| table);
    match (address.key.role, belt.scales()) {
        (Role::Number(parameter), Some(_)) if !parameter.si.is_empty() && !parameter.is_pure() => {
            None
        }
        (Role::Number(_) | Role::Constant, _) => belt.get(path.trim()),
        (Role::Twin(parameter, twin), Some(scales)) => {
            let number = belt.get(&join(table, parameter.key()))?;
            let peak = scales.to_si(parameter.quantity, number);
            Some(of_peak(belt, &address, twin)? * peak)
        }
        (Role::Scale(scale), Some(scales)) => scale_of(scale, &scales),
        _ => None,
    }
}

/// The size that a key in SI gives of a signal whose peak is 1; 1 for a key of another number.
fn of_peak(belt: &Belt, address: &Address, twin: SiTwin) -> Option<f64> {
    if !twin.rms {
        return Some(1.0);
    }
    let dither = belt.dithers().get(address.index.unwrap_or(0))?;
    measure_of(twin).of_unit(&dither.waveform)
}

fn scale_of(scale: ScaleKey, scales: &Scales) -> Option<f64> {
    let known = [
        (MASS, scales.mass_kg()),
        (STIFFNESS, scales.stiffness_n_per_m()),
        (NATURAL_FREQUENCY, scales.angular_frequency() / std::f64::consts::TAU),
    ];
    known.into_iter().find(|(known, _)| *known == scale).map(|(_, value)| value)
}
