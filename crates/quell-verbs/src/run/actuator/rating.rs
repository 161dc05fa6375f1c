//! Whether a dither is within what the actuator of its study can give, for every verb.

use quell_design::actuator::Actuator;
use quell_linear::driven_point::DrivenPoint;
use quell_linear::linearised::Linearised;
use quell_model::System;

use crate::study::{DiscStudy, SystemStudy};
use crate::words::{digits, quantity_at};

/// The warning about the dither of a study that demands more than its actuator can give: the dither that `actuator` judges. `None` where
/// the demand is unknown.
pub(crate) fn beyond_actuator(study: &SystemStudy) -> Option<String> {
    demands_too_much(study.system(), study.actuator()?, designed(study))
}

/// The same of a disc: every load has its actuator, and all of them give the same.
pub(crate) fn beyond_actuators_at_loads(study: &DiscStudy) -> Option<String> {
    let actuator = study.actuator()?;
    let system = study.disc().system_in_si(study.parts())?.ok()?;
    demands_too_much(&system, actuator, 0)
}

fn demands_too_much(system: &System, actuator: &Actuator, dither: usize) -> Option<String> {
    let input = system.inputs.get(dither)?;
    let wave = input.profile.waves().first()?;
    let linear = Linearised::new(system).ok()?;
    let (waveform, frequency) = (&wave.waveform, wave.frequency);
    let point = DrivenPoint::of_input(system, &linear, &input.target, waveform, frequency).ok()?;
    let demand = actuator.demand(&point).ok()?.at(wave.amplitude);
    let (limit, used) = demand.tightest().ok().filter(|(_, used)| *used > 1.0)?;
    Some(format!(
        "the dither of this study demands {} times what the actuator can give, by the {}",
        digits(used),
        quantity_at(limit.path())
    ))
}

/// The dither whose amplitude the study designs, or the first.
pub(in crate::run) fn designed(study: &SystemStudy) -> usize {
    let varied = study.design().map_or(&[][..], |design| &design.vary);
    varied.iter().find_map(|range| study.dither_of(&range.path)).unwrap_or(0)
}
