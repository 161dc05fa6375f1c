//! What an answer says about its sound.

use quell_model::units::Quantity;

use super::recorder::SHORTEST_SPECTRUM;
use super::{HIGHEST_FREQUENCY, LOWEST_FREQUENCY, SAMPLE_RATE, Sound, is_too_high};
use crate::fields::Fields;
use crate::words::digits;

/// Why a motion without velocity has no gain.
const AT_REST: &str = "nothing moves";

impl Sound {
    /// Adds the fields of the sound to an object, which converts the gain.
    pub fn state(&self, fields: &mut Fields) {
        fields
            .measured("sample_rate", "Hz", SAMPLE_RATE)
            .measured("duration_s", "s", self.duration())
            .plain("transposition", self.transposition);
        match self.natural_frequency {
            Some(hertz) => fields.measured("natural_frequency_hz", "Hz", hertz),
            None => fields.plain("time_per_second", self.time_per_second),
        };
        match self.strongest {
            Some(hertz) => fields.measured("strongest_frequency_hz", "Hz", hertz),
            None if self.samples.len() < SHORTEST_SPECTRUM => {
                fields.unknown("strongest_frequency_hz", "the sound is shorter than 0.2 s")
            }
            None => fields.unknown("strongest_frequency_hz", AT_REST),
        };
        fields
            .known("gain", Quantity::PerVelocity, self.gain.ok_or_else(|| AT_REST.to_owned()))
            .plain("clipped", self.clipped);
    }

    /// The sound in one sentence. `in_real_time`: whether a second of the study is a second of sound; `words`: a quantity with
    /// its unit.
    pub fn sentence(&self, in_real_time: bool, words: impl Fn(Quantity, f64) -> String) -> String {
        let seconds = digits(self.duration());
        let real = if in_real_time { " in real time" } else { "" };
        let pitch = match self.natural_frequency {
            Some(hertz) => format!(", lowest natural frequency at {} Hz", digits(hertz)),
            None if in_real_time => String::new(),
            None => format!(", {} units of time per second", digits(self.time_per_second)),
        };
        let transposition = format!("transposition {}{pitch}", digits(self.transposition));
        let level = self.gain.map_or_else(
            || AT_REST.to_owned(),
            |gain| {
                let full_scale = words(Quantity::Velocity, 1.0 / gain);
                let gain = words(Quantity::PerVelocity, gain);
                format!("full scale is a velocity of {full_scale} (gain {gain})")
            },
        );
        format!("The sound lasts {seconds} s{real} ({transposition}), and {level}.")
    }

    /// Warnings about the sound; `words` as in [`Sound::sentence`].
    pub fn warnings(&self, words: impl Fn(Quantity, f64) -> String) -> Vec<String> {
        let mut warnings = Vec::new();
        if self.clipped > 0 {
            let (clipped, samples) = (self.clipped, self.samples.len());
            warnings.push(format!(
                "{clipped} of {samples} samples of the sound {} beyond full scale and clipped; a gain below {} avoids that",
                if clipped == 1 { "is" } else { "are" },
                words(Quantity::PerVelocity, 1.0 / self.peak)
            ));
        }
        if let Some(hertz) = self.strongest.filter(|hertz| *hertz < LOWEST_FREQUENCY) {
            warnings.push(format!(
                "the strongest vibration is at {} Hz in the sound, below the audible range; a larger transposition raises it",
                digits(hertz)
            ));
        }
        if self.mostly_inaudible {
            warnings.push(format!(
                "most of the vibration is above {HIGHEST_FREQUENCY} Hz, where the sound ends; a smaller transposition lowers it"
            ));
        }
        if let Some(hertz) = self.fastest_forcing.filter(|hertz| is_too_high(*hertz)) {
            warnings.push(format!(
                "the sound ends at {HIGHEST_FREQUENCY} Hz, and a dither at {} Hz is not in it",
                digits(hertz)
            ));
        }
        warnings
    }
}
