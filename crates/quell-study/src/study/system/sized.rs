//! Amplitudes of a system that its actuator determines, once the structure is known.

use quell_design::actuator::Actuator;
use quell_linear::driven_point::DrivenPoint;
use quell_linear::linearised::Linearised;
use quell_model::System;
use quell_model::profile::{Profile, Wave};

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
    whole.then_some(given)
}

/// The system without the contacts whose load its motion does not change.
fn without_prescribed_loads(system: &System) -> System {
    let mut system = system.clone();
    system.contacts.retain(|contact| contact.normal.is_some() || contact.slope.is_some());
    system
}
