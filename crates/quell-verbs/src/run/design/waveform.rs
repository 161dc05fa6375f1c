//! Structures with another wave of one dither.

use quell_model::profile::{Profile, Wave};
use quell_model::{System, Waveform};

/// The system with another waveform of one dither.
pub(crate) fn system_with_waveform(system: System, input: usize, waveform: &Waveform) -> System {
    with_wave(system, input, |wave| Wave { waveform: waveform.clone(), ..wave.clone() })
}

/// The system in which a dither of one wave has the wave that `change` makes of it.
pub(crate) fn with_wave(
    mut system: System,
    input: usize,
    change: impl FnOnce(&Wave) -> Wave,
) -> System {
    if let Some(input) = system.inputs.get_mut(input)
        && let [wave] = input.profile.waves()
    {
        input.profile = Profile::constant(input.profile.mean()).with(change(wave));
    }
    system
}
