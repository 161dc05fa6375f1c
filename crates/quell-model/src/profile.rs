//! Quantities that vary in time: a constant plus periodic waves.

use crate::waveform::Waveform;

/// One wave: A g(ωt + φ).
#[derive(Clone, Debug, PartialEq)]
pub struct Wave {
    /// Waveform g.
    pub waveform: Waveform,
    /// Peak amplitude A.
    pub amplitude: f64,
    /// Angular frequency ω > 0, per unit of time.
    pub frequency: f64,
    /// Phase φ at t = 0, radians.
    pub phase: f64,
}

impl Wave {
    /// Angular frequency at which the wave repeats itself: ω, of a burst ω over its cycles of the carrier.
    pub fn repetition(&self) -> f64 {
        self.frequency / f64::from(self.waveform.cycles())
    }

    /// The highest angular frequency of the wave: ω, of a sum of harmonics that of the highest one.
    pub fn highest(&self) -> f64 {
        self.frequency * f64::from(self.waveform.highest_order())
    }

    /// Largest magnitude of the wave.
    pub fn peak(&self) -> f64 {
        self.amplitude.abs() * self.waveform.peak()
    }

    /// A g(ωt + φ) at the time t.
    pub fn value(&self, time: f64) -> f64 {
        self.amplitude * self.waveform.value(f64::mul_add(self.frequency, time, self.phase))
    }
}

/// A quantity over time: its mean and the waves added to it. Drives, loads and inputs take one.
///
/// ```
/// use quell_model::profile::{Profile, Wave};
/// use quell_model::Waveform;
///
/// let wave = Wave { waveform: Waveform::Sine, amplitude: 0.5, frequency: 10.0, phase: 0.0 };
/// let load = Profile::constant(2.0).with(wave);
/// assert_eq!(load.mean(), 2.0);
/// assert_eq!(load.value(0.0), 2.0);
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Profile {
    mean: f64,
    waves: Vec<Wave>,
}

impl Profile {
    /// The same value at all times.
    pub fn constant(value: f64) -> Self {
        Self { mean: value, waves: Vec::new() }
    }

    /// The same profile with a further wave.
    #[must_use]
    pub fn with(mut self, wave: Wave) -> Self {
        self.waves.push(wave);
        self
    }

    /// The mean over time.
    pub fn mean(&self) -> f64 {
        self.mean
    }

    /// The waves, each of zero mean.
    pub fn waves(&self) -> &[Wave] {
        &self.waves
    }

    /// The value at the time t.
    pub fn value(&self, time: f64) -> f64 {
        self.mean + self.waves.iter().map(|wave| wave.value(time)).sum::<f64>()
    }
}
