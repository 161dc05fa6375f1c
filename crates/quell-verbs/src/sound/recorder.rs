//! From velocities to the samples of a sound.

use std::f64::consts::TAU;

use quell_numerics::spectrum::Spectrum;

use super::decimator::Decimator;
use super::{DEFAULT_PEAK_DB, SAMPLE_RATE, Sound, SoundPlan, is_too_high};

/// Longest part at the end of a sound whose spectrum is computed, in samples: 3 s resolve 0.3 Hz.
const SPECTRUM_SAMPLES: usize = 1 << 17;

/// Shortest sound whose strongest frequency is determined, in samples: 0.2 s, four periods of the lowest audible frequency.
pub(super) const SHORTEST_SPECTRUM: usize = SAMPLE_RATE as usize / 5;

/// Receives velocities at equal intervals.
#[derive(Clone, Debug)]
pub struct SoundRecorder {
    plan: SoundPlan,
    filter: Decimator,
    /// Sum of the squares of the velocities.
    power: f64,
    received: usize,
}

impl SoundRecorder {
    pub(super) fn new(plan: SoundPlan) -> Self {
        let filter = Decimator::new(plan.oversampling, plan.samples);
        Self { plan, filter, power: 0.0, received: 0 }
    }

    /// Takes the mean velocity over the next interval, or its value in the middle.
    pub fn push(&mut self, velocity: f64) {
        self.power += velocity * velocity;
        self.received += 1;
        self.filter.push(velocity);
    }

    /// Number of velocities received.
    pub fn received(&self) -> usize {
        self.received
    }

    /// The sound. Velocities that are missing are zero.
    pub fn finish(self) -> Sound {
        let Self { plan, filter, power, received } = self;
        let velocities = filter.finish(plan.samples);
        let peak = velocities.iter().fold(0.0_f64, |most, velocity| most.max(velocity.abs()));
        let largest = libm::pow(10.0, -DEFAULT_PEAK_DB / 20.0);
        let own_gain = (peak > 0.0).then(|| (largest / peak).min(f64::MAX));
        let gain = plan.options.gain.or(own_gain);
        let (samples, clipped) = quantised(&velocities, gain.unwrap_or(0.0));
        let written = velocities.iter().map(|velocity| velocity * velocity).sum::<f64>();
        let written = written / plan.samples as f64;
        // The power of a fast forcing is expected to be missing, and says nothing about the vibration.
        let too_high = |frequency: Option<f64>| frequency.is_some_and(is_too_high);
        let missing = 2.0 * written < power / received.max(1) as f64;
        let mostly_inaudible =
            too_high(plan.natural_frequency) || missing && !too_high(plan.fastest_forcing);
        Sound {
            samples,
            transposition: plan.options.transposition,
            time_per_second: plan.time_per_second,
            natural_frequency: plan.natural_frequency,
            fastest_forcing: plan.fastest_forcing,
            strongest: strongest(&velocities),
            gain,
            peak,
            clipped,
            mostly_inaudible,
        }
    }
}

/// The samples, and how many are clipped.
fn quantised(velocities: &[f64], gain: f64) -> (Vec<i16>, usize) {
    let full = f64::from(i16::MAX);
    let mut clipped = 0;
    let sample = |velocity: &f64| {
        let value = (gain * velocity * full).round();
        clipped += usize::from(value.abs() > full);
        #[expect(clippy::cast_possible_truncation, reason = "a whole number within the range")]
        let sample = value.clamp(-full, full) as i16;
        sample
    };
    let samples = velocities.iter().map(sample).collect();
    (samples, clipped)
}

/// Frequency of the largest line at the end of a sound, Hz.
fn strongest(velocities: &[f64]) -> Option<f64> {
    if velocities.len() < SHORTEST_SPECTRUM {
        return None;
    }
    let end = &velocities[velocities.len().saturating_sub(SPECTRUM_SAMPLES)..];
    let spectrum = Spectrum::of(end, 1.0 / f64::from(SAMPLE_RATE)).ok()?;
    let line = spectrum.largest_line(0.0, f64::INFINITY)?;
    (line.amplitude > 0.0).then_some(line.frequency / TAU)
}
