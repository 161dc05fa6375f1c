//! Structures with another waveform of the dither that is designed.

use quell_model::profile::{Profile, Wave};
use quell_model::{System, Waveform};

/// The system with another waveform of one dither.
pub(crate) fn system_with_waveform(
    mut system: System,
    input: usize,
    waveform: &Waveform,
) -> System {
    if let Some(input) = system.inputs.get_mut(input)
        && let [wave] = input.profile.waves()
        && wave.waveform != *waveform
    {
        let wave = Wave { waveform: waveform.clone(), ..wave.clone() };
        input.profile = Profile::constant(input.profile.mean()).with(wave);
    }
    system
}
