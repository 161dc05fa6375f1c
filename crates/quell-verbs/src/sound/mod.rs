//! The velocity of a motion as sound.
//!
//! A vibrating surface radiates with its velocity, so the samples of a sound are velocities. A [`SoundPlan`] decides from the
//! length of a run and the [`SoundOptions`] at which times the run is sampled, before anything is computed; a [`SoundRecorder`]
//! receives the velocities one by one and becomes a [`Sound`], which has the samples of the file and says how they were made.
//! Nothing here depends on a kind of study.
//!
//! **Time.** A sound has [`SAMPLE_RATE`] samples per second. At transposition 1 a study with units sounds in real time. A study
//! without units has no seconds: there the angular frequency 1 sounds at [`REFERENCE_PITCH`]
//! ([`RecordedMotion::AUDIBLE`]). A transposition multiplies every frequency.
//!
//! **Above the limit of the file.** Velocities are taken at a multiple of the sample rate: at least four times, and at least
//! eight times per period of the fastest forcing. A filter (`decimator.rs`) passes what is below [`HIGHEST_FREQUENCY`] and removes
//! what would otherwise be folded into the audible range. The velocities shall be means over the intervals between samples,
//! which are differences of the displacement: that suppresses frequencies near the multiples of the inner rate.
//!
//! **Level.** A gain is the fraction of full scale per unit of velocity. By default the largest sample is [`DEFAULT_PEAK_DB`]
//! below full scale. The gain is part of the answer, so that a second sound can have the same.

mod decimator;
mod recorder;
mod statement;
mod tap;
mod wave;

use std::f64::consts::TAU;

use quell_model::units::Quantity;

use crate::complaint::{Complaint, Fault, Origin};
use crate::quantity;
use crate::study::UnitSystem;
use crate::words::digits;

pub use recorder::SoundRecorder;
pub(crate) use tap::VelocityTap;

/// Samples per second of a sound, Hz: that of compact discs, which every player accepts.
pub const SAMPLE_RATE: u32 = 44_100;

/// Frequency up to which a file has the vibration, Hz: the limit of hearing, and the edge of the filter.
pub const HIGHEST_FREQUENCY: f64 = 20_000.0;

/// Lowest audible frequency, Hz.
const LOWEST_FREQUENCY: f64 = 20.0;

/// Longest sound, s: 53 MB. Its samples are kept in memory until the largest is known.
pub const MOST_SECONDS: f64 = 600.0;

/// Frequency at which the angular frequency 1 of a study without units sounds, Hz: in the range of voices, so that the
/// harmonics of stick-slip and a dither at up to 180 times this frequency are audible.
pub const REFERENCE_PITCH: f64 = 110.0;

/// Level of the largest sample below full scale, dB, where no gain is given.
pub const DEFAULT_PEAK_DB: f64 = 3.0;

/// Part of a sample by which a sound may end after its run, so that 0.3 s have 13230 samples however they are rounded.
const SAMPLE_ROUNDING: f64 = 1e-6;

/// Fewest velocities per sample.
const LEAST_OVERSAMPLING: usize = 4;

/// Velocities per period of the fastest forcing, so that its harmonics fold into the audible range only from the seventh on.
const PER_FORCING_PERIOD: f64 = 8.0;

/// Most velocities per sample: forcing above 22 MHz in the sound is only suppressed by the means.
const MOST_OVERSAMPLING: usize = 4096;

/// What the user chooses about a sound.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SoundOptions {
    /// Factor of every frequency; 1 by default.
    pub transposition: f64,
    /// Fraction of full scale per unit of velocity, in the units of the equations; by default the largest sample is
    /// [`DEFAULT_PEAK_DB`] below full scale.
    pub gain: Option<f64>,
}

impl Default for SoundOptions {
    fn default() -> Self {
        Self { transposition: 1.0, gain: None }
    }
}

impl SoundOptions {
    /// Reads a transposition, as `--transpose` gives it.
    ///
    /// # Errors
    /// A complaint about `--transpose`.
    pub fn transposition(text: &str) -> Result<f64, Box<Complaint>> {
        let found = text.trim().parse::<f64>();
        positive("--transpose", text, found.ok(), "a factor above 0, such as 0.5")
    }

    /// Reads a gain, as `--gain` gives it, per unit of velocity of a study in these units.
    ///
    /// # Errors
    /// A complaint about `--gain`.
    pub fn gain(text: &str, units: UnitSystem) -> Result<f64, Box<Complaint>> {
        let found = quantity::number(text, Some(Quantity::PerVelocity), units, "--gain")?;
        let allowed = "a fraction of full scale per unit of velocity above 0, such as 2.5";
        positive("--gain", text, Some(found), allowed)
    }
}

/// A finite number above 0.
fn positive(
    option: &'static str,
    text: &str,
    found: Option<f64>,
    allowed: &str,
) -> Result<f64, Box<Complaint>> {
    let found = found.filter(|value| value.is_finite() && *value > 0.0);
    found.ok_or_else(|| Box::new(Complaint::option(option, text, allowed)))
}

/// Whether a frequency in the sound, in Hz, is beyond the file. A forcing at 20 kHz may be rounded to just above.
fn is_too_high(hertz: f64) -> bool {
    hertz > HIGHEST_FREQUENCY * (1.0 + 1e-9)
}

/// A motion that shall become sound, in the time of its equations.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RecordedMotion {
    /// Length of the run.
    pub duration: f64,
    /// Units of time in one second of sound at transposition 1: those of one second, or [`RecordedMotion::AUDIBLE`] in a study
    /// without units.
    pub time_per_second: f64,
    /// Angular frequency of a characteristic vibration, whose pitch is stated.
    pub natural_frequency: Option<f64>,
    /// Angular frequency of the fastest forcing.
    pub fastest_forcing: Option<f64>,
}

impl RecordedMotion {
    /// [`RecordedMotion::time_per_second`] of a study without units: the angular frequency 1 is at [`REFERENCE_PITCH`].
    pub const AUDIBLE: f64 = TAU * REFERENCE_PITCH;
}

/// The times at which a motion is sampled, and how its samples become a sound.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SoundPlan {
    options: SoundOptions,
    /// Units of time in one second of sound.
    time_per_second: f64,
    /// Samples of the sound.
    samples: usize,
    /// Velocities per sample.
    oversampling: usize,
    /// Hz in the sound.
    natural_frequency: Option<f64>,
    /// Hz in the sound.
    fastest_forcing: Option<f64>,
}

impl SoundPlan {
    /// The plan for a motion.
    ///
    /// # Errors
    /// A complaint about the length of the run if the sound is longer than [`MOST_SECONDS`] or has no sample.
    pub fn new(motion: &RecordedMotion, options: SoundOptions) -> Result<Self, Box<Complaint>> {
        let time_per_second = motion.time_per_second * options.transposition;
        let seconds = motion.duration / time_per_second;
        let least = 1.0 / f64::from(SAMPLE_RATE);
        let advice = if seconds > MOST_SECONDS || seconds.is_nan() {
            "shorten the run, or raise --transpose"
        } else if seconds < least * (1.0 - SAMPLE_ROUNDING) {
            "lengthen the run, or lower --transpose"
        } else {
            return Ok(Self::with(motion, options, time_per_second, seconds));
        };
        let allowed = format!(
            "the sound would last {} s at transposition {}; between {} s and {MOST_SECONDS} s are possible: {advice}",
            digits(seconds),
            digits(options.transposition),
            digits(least),
        );
        let origin = Origin::Argument("--until");
        Err(Box::new(Complaint::new(Fault::Conflict, "--until", origin, seconds, allowed)))
    }

    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "whole numbers between 0 and MOST_SECONDS·SAMPLE_RATE, and up to MOST_OVERSAMPLING"
    )]
    fn with(
        motion: &RecordedMotion,
        options: SoundOptions,
        time_per_second: f64,
        seconds: f64,
    ) -> Self {
        let hertz = |frequency: f64| frequency * time_per_second / TAU;
        let rate = f64::from(SAMPLE_RATE);
        let fastest_forcing = motion.fastest_forcing.map(hertz);
        let wanted = fastest_forcing.map_or(0.0, |forcing| PER_FORCING_PERIOD * forcing / rate);
        let wanted = wanted.ceil().min(MOST_OVERSAMPLING as f64) as usize;
        Self {
            options,
            time_per_second,
            samples: (seconds * rate + SAMPLE_ROUNDING) as usize,
            oversampling: wanted.max(LEAST_OVERSAMPLING),
            natural_frequency: motion.natural_frequency.map(hertz),
            fastest_forcing,
        }
    }

    /// Number of velocities that the recorder takes.
    pub fn intervals(&self) -> usize {
        self.samples * self.oversampling
    }

    /// Time between two of them.
    pub fn interval(&self) -> f64 {
        self.time_per_second / (f64::from(SAMPLE_RATE) * self.oversampling as f64)
    }

    /// A recorder of these velocities.
    pub fn recorder(&self) -> SoundRecorder {
        SoundRecorder::new(*self)
    }
}

/// A finished sound.
#[derive(Clone, Debug, PartialEq)]
pub struct Sound {
    /// The samples of the file; full scale is 32767.
    pub samples: Vec<i16>,
    /// Factor of every frequency.
    pub transposition: f64,
    /// Units of time of the equations in one second of sound.
    pub time_per_second: f64,
    /// Frequency at which the natural frequency sounds, Hz.
    pub natural_frequency: Option<f64>,
    /// Frequency at which the fastest forcing sounds, Hz.
    pub fastest_forcing: Option<f64>,
    /// Frequency of the largest line in the spectrum of the sound, Hz; `None` if it is too short or silent.
    pub strongest: Option<f64>,
    /// Fraction of full scale per unit of velocity; `None` for a motion without velocity and no given gain.
    pub gain: Option<f64>,
    /// Largest velocity of the filtered motion.
    pub peak: f64,
    /// Samples beyond full scale, which are clipped.
    pub clipped: usize,
    /// Whether most of the power of the motion is above [`HIGHEST_FREQUENCY`].
    pub mostly_inaudible: bool,
}

impl Sound {
    /// The sound of a series of velocities: as many as [`SoundPlan::intervals`], and as far apart as [`SoundPlan::interval`].
    pub fn of(velocities: impl IntoIterator<Item = f64>, plan: &SoundPlan) -> Self {
        let mut recorder = plan.recorder();
        for velocity in velocities {
            recorder.push(velocity);
        }
        recorder.finish()
    }

    /// Length, s.
    pub fn duration(&self) -> f64 {
        self.samples.len() as f64 / f64::from(SAMPLE_RATE)
    }

    /// The sound as a WAV file with a comment.
    pub fn wav(&self, comment: &str) -> Vec<u8> {
        wave::bytes(&self.samples, SAMPLE_RATE, comment)
    }
}

#[cfg(test)]
mod tests;
