//! Amplitudes of a system that its actuator determines, once the structure is known.

use quell_design::actuator::Actuator;
use quell_input::complaint::{Complaint, Fault, Origin};
use quell_linear::driven_point::DrivenPoint;
use quell_linear::linearised::Linearised;
use quell_model::System;
use quell_model::digits::digits;
use quell_model::profile::{Profile, Wave};
use quell_model::system::{Input, InputTarget};

use crate::study::dither_size::{GivenSize, SizedAmplitude};
use crate::study::reader::Reader;
use crate::study::vocabulary::join;

/// Sets the amplitudes that the actuator determines. Returns every amplitude that is given by another size than a peak force; `None`
/// if one is wrong.
pub(in crate::study) fn amplitudes(
    reader: &mut Reader,
    system: &mut System,
    actuator: Option<&Actuator>,
    sizes: Vec<(String, SizedAmplitude)>,
) -> Option<Vec<GivenSize>> {
    let mut given = Vec::new();
    let mut whole = true;
    for (dither, (prefix, size)) in sizes.into_iter().enumerate() {
        let driven = match size {
            SizedAmplitude::Known(_, None) => continue,
            SizedAmplitude::Known(amplitude, Some((key, value))) => {
                let path = join(&prefix, key.key);
                given.push(GivenSize { dither, path, key, value, amplitude });
                continue;
            }
            SizedAmplitude::Driven(driven) => driven,
        };
        let wave = system.inputs[dither].profile.waves().first().cloned()?;
        let sliding = Linearised::new(system).or_else(|why| {
            // Where nothing slides, contacts under prescribed loads still leave the motion of the dither to the structure.
            Linearised::new(&without_prescribed_loads(system)).map_err(|_| why)
        });
        let point = sliding.as_ref().map_err(|why| why.clone().into()).and_then(|sliding| {
            let target = &system.inputs[dither].target;
            let (waveform, frequency) = (&wave.waveform, wave.frequency);
            Ok(DrivenPoint::of_input(system, sliding, target, waveform, frequency)?)
        });
        let Some(amplitude) = driven.resolved(reader, actuator, point) else {
            whole = false;
            continue;
        };
        let input = &mut system.inputs[dither];
        let wave = Wave { amplitude, ..wave };
        input.profile = Profile::constant(input.profile.mean()).with(wave);
        given.push(driven.into_given(dither, amplitude));
    }
    if whole && opens(reader, system, &given) {
        return None;
    }
    whole.then_some(given)
}

/// Reports an actuator that would lift a contact whose load is prescribed, once it is known what it gives.
fn opens(reader: &mut Reader, system: &System, given: &[GivenSize]) -> bool {
    let may_touch = system.contacts.len() == 1 && system.structure.size() == 1;
    for (index, contact) in system.contacts.iter().enumerate() {
        let on = |input: &Input| matches!(input.target, InputTarget::NormalLoad { contact, .. } if contact == index);
        let inputs = system.inputs.iter().enumerate().filter(|(_, input)| on(input));
        let peaks: f64 =
            inputs.clone().flat_map(|(_, input)| input.profile.waves()).map(Wave::peak).sum();
        let least = contact.load().bounds().0;
        let is_too_much = peaks > least || (peaks == least && !may_touch);
        if contact.normal.is_some() || !is_too_much {
            continue;
        }
        let driven = given.iter().find(|size| {
            size.key.needs_actuator() && inputs.clone().any(|(input, _)| input == size.dither)
        });
        if let Some(size) = driven {
            let few = if may_touch { "at most" } else { "less than" };
            let allowed = format!(
                "such that the peaks on contact {} sum to {few} its load {}: they sum to {}, and a prescribed load must stay positive",
                contact.name,
                digits(least, 6),
                digits(peaks, 6)
            );
            let (key, value) = (size.path.as_str(), size.value);
            reader.complain(Complaint::new(Fault::Value, key, Origin::Whole, value, allowed));
            return true;
        }
    }
    false
}

/// The system without the contacts whose load its motion does not change.
fn without_prescribed_loads(system: &System) -> System {
    let mut system = system.clone();
    system.contacts.retain(|contact| contact.normal.is_some() || contact.slope.is_some());
    system
}
