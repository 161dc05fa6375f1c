//! `actuator` of a system: where over frequency its actuator can give one of its dithers.

use quell_design::least_dither::{DesignStart, OperatingPoint, SystemPlant};
use quell_linear::linearised::Linearised;
use quell_linear::spectrum::{MotionSpectrum, SmallMotion, spectrum};
use quell_model::System;
use quell_model::profile::{Profile, Wave};

use super::{failed, has_equations};
use crate::complaint::Failure;
use crate::contact_state::refused_where_averaged;
use crate::run::actuator::{ActuatorFound, ActuatorQuestion, asked};
use crate::study::SystemStudy;

/// The actuator of a system over a range of angular frequencies.
///
/// # Errors
/// A complaint about a study without `[actuator]`, dither or equations, about the range, and about a contact with a state; a dither whose
/// demand is unknown at every frequency.
pub fn run(study: &SystemStudy, range: Option<(f64, f64)>) -> Result<ActuatorFound, Failure> {
    has_equations(study, "actuator")?;
    let system = study.system();
    refused_where_averaged(system, "actuator")?;
    let actuator = asked(study, system.is_dithered())?;
    let input = designed(study);
    let wave = system.inputs.get(input).and_then(|input| input.profile.waves().first());
    let Some(wave) = wave else {
        return Err(failed("actuator", "the dither that the actuator gives does not act"));
    };
    let linear = Linearised::new(system).map_err(|why| failed("actuator", why))?;
    let found = spectrum(&linear, &linear.friction()).map_err(|why| failed("actuator", why))?;
    let at = |place: OperatingPoint<'_>, amplitude: f64| -> Result<System, String> {
        Ok(with_dither(system, input, amplitude, place.others.first().copied()))
    };
    let plant = SystemPlant { at: &at, input, observe: &[], start: DesignStart::Local };
    let speed = |contact: &quell_model::Contact| contact.surface_velocity.mean().abs();
    let contacts = system.contacts.iter();
    let question = ActuatorQuestion {
        actuator,
        plant: &plant,
        waveform: wave.waveform.clone(),
        dither: table_of(input, system.inputs.len()),
        own: (wave.frequency, wave.amplitude),
        slow: slowest_to_decay(&found),
        resonances: oscillating(&found).map(SmallMotion::frequency).collect(),
        contacts: contacts.map(|contact| (contact.name.clone(), speed(contact))).collect(),
    };
    question.answer(range, f64::INFINITY)
}

/// The dither whose amplitude the study designs, or the first.
pub(in crate::run) fn designed(study: &SystemStudy) -> usize {
    let varied = study.design().map_or(&[][..], |design| &design.vary);
    varied.iter().find_map(|range| study.dither_of(&range.path)).unwrap_or(0)
}

/// The table of a dither.
fn table_of(input: usize, count: usize) -> String {
    if count > 1 { format!("dither[{input}]") } else { "dither".to_owned() }
}

/// The system with an amplitude and a frequency of one dither.
fn with_dither(system: &System, input: usize, amplitude: f64, frequency: Option<f64>) -> System {
    let mut system = system.clone();
    if let Some(input) = system.inputs.get_mut(input)
        && let [wave] = input.profile.waves()
    {
        let frequency = frequency.unwrap_or(wave.frequency);
        let wave = Wave { amplitude, frequency, ..wave.clone() };
        input.profile = Profile::constant(input.profile.mean()).with(wave);
    }
    system
}

/// The small motions that oscillate.
fn oscillating(found: &MotionSpectrum) -> impl Iterator<Item = &SmallMotion> {
    found.motions.iter().filter(|motion| motion.eigenvalue.im > 0.0)
}

/// The frequency of the motion that grows fastest, or decays most slowly.
fn slowest_to_decay(found: &MotionSpectrum) -> Option<f64> {
    let motions = oscillating(found);
    let worst = motions.max_by(|a, b| a.eigenvalue.re.total_cmp(&b.eigenvalue.re))?;
    Some(worst.frequency())
}
