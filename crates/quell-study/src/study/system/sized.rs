//! Amplitudes of a system that its actuator determines, once the structure is known.

use std::borrow::Cow;

use quell_design::actuator::Actuator;
use quell_input::complaint::{Complaint, Fault, Origin};
use quell_linear::driven_point::DrivenPoint;
use quell_linear::linearised::Linearised;
use quell_linear::steady::NoSteadySliding;
use quell_model::profile::{Profile, Wave};
use quell_model::system::{Input, InputTarget};
use quell_model::{Contact, System};

use super::dither::lifted;
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
        let point =
            about_sliding(system, dither).map_err(Into::into).and_then(|(system, linear)| {
                let target = &system.inputs[dither].target;
                Ok(DrivenPoint::of_input(&system, &linear, target, &wave.waveform, wave.frequency)?)
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
    let size = (system.contacts.len(), system.structure.size());
    for (index, contact) in system.contacts.iter().enumerate() {
        let on = |input: &Input| matches!(input.target, InputTarget::NormalLoad { contact, .. } if contact == index);
        let inputs = system.inputs.iter().enumerate().filter(|(_, input)| on(input));
        let waves = inputs.clone().flat_map(|(_, input)| input.profile.waves());
        let fall: f64 = waves.map(|wave| -wave.range().lower).sum();
        let Some(allowed) = lifted(contact, fall, size) else { continue };
        let driven = given.iter().find(|size| {
            size.key.needs_actuator() && inputs.clone().any(|(input, _)| input == size.dither)
        });
        if let Some(size) = driven {
            let (key, value) = (size.path.as_str(), size.value);
            reader.complain(Complaint::new(Fault::Value, key, Origin::Whole, value, allowed));
            return true;
        }
    }
    false
}

/// The equations about steady sliding that a dither moves, and their system. Where not every contact can slide they are those of what
/// contacts under prescribed loads leave to the structure.
fn about_sliding(
    system: &System,
    dither: usize,
) -> Result<(Cow<'_, System>, Linearised), NoSteadySliding> {
    let why = match Linearised::new(system) {
        Ok(linear) => return Ok((Cow::Borrowed(system), linear)),
        Err(why) => why,
    };
    if let InputTarget::NormalLoad { contact, .. } = system.inputs[dither].target
        && is_prescribed(&system.contacts[contact])
    {
        // The structure does not move against a load that its motion does not change.
        return Ok((Cow::Borrowed(system), Linearised::frictionless(system)?));
    }
    let rest = without_prescribed_loads(system);
    let linear = Linearised::new(&rest).map_err(|_| why)?;
    Ok((Cow::Owned(rest), linear))
}

/// Whether the motion of the structure does not change the load of a contact.
fn is_prescribed(contact: &Contact) -> bool {
    contact.normal.is_none() && contact.slope.is_none()
}

/// The system without the contacts under prescribed loads, with its inputs on the contacts that are left.
fn without_prescribed_loads(system: &System) -> System {
    let mut rest = system.clone();
    rest.contacts.retain(|contact| !is_prescribed(contact));
    for input in &mut rest.inputs {
        if let InputTarget::NormalLoad { contact, .. } | InputTarget::Friction { contact } =
            &mut input.target
        {
            let before = system.contacts.iter().take(*contact);
            *contact = before.filter(|contact| !is_prescribed(contact)).count();
        }
    }
    rest
}
