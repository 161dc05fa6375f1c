//! A settled record: samples at equal steps over an integral number of slow periods.

use std::f64::consts::TAU;

use quell_model::Belt;
use quell_numerics::spectrum::Spectrum;

use super::cost::Meter;
use super::{BAND_END, HALVES_AGREE, HALVES_NEGLIGIBLE, Solver};
use crate::simulation::{Sample, Sampler, Stalled, Start, simulate};

/// Samples per period of the fastest dither, at least: its seventh harmonic stays below
/// the Nyquist frequency.
const SAMPLES_PER_DITHER_PERIOD: f64 = 16.0;

/// Samples per slow period, at least.
const SAMPLES_PER_SLOW_PERIOD: f64 = 128.0;

/// A settled record of a run.
#[derive(Clone, Debug)]
pub struct Record {
    /// Samples at equal steps; the first at the end of the settling time.
    pub samples: Vec<Sample>,
    /// Step between samples.
    pub step: f64,
    /// Spectrum of the displacement.
    pub spectrum: Spectrum,
    /// Stick, release and reversal events inside.
    pub events: u64,
    /// F, the scale of lengths.
    pub(super) load: f64,
}

impl Record {
    /// M: the largest spectral amplitude at 0 < ω ≤ 1.9.
    pub fn amplitude(&self) -> f64 {
        largest(&self.spectrum)
    }

    /// When it starts.
    pub fn first_time(&self) -> f64 {
        self.samples[0].time
    }

    /// How long it is.
    pub fn length(&self) -> f64 {
        self.samples.len() as f64 * self.step
    }

    /// M of the first and of the second half.
    pub fn half_amplitudes(&self) -> (f64, f64) {
        let (first, second) = self.samples.split_at(self.samples.len() / 2);
        (largest(&spectrum_of(first, self.step)), largest(&spectrum_of(second, self.step)))
    }

    /// Whether M of the halves agree, relatively or against `reference`.
    pub(super) fn is_settled(&self, reference: f64) -> bool {
        let (first, second) = self.half_amplitudes();
        let difference = (first - second).abs();
        difference <= HALVES_AGREE * first.max(second)
            || difference <= HALVES_NEGLIGIBLE * reference
    }
}

/// The record of a run, with what was metered on it.
pub(super) fn take(belt: &Belt, start: Start, solver: &Solver) -> Result<(Record, Meter), Stalled> {
    let fastest = belt
        .dithers()
        .iter()
        .filter(|dither| dither.amplitude > 0.0)
        .fold(0.0_f64, |rate, dither| rate.max(dither.frequency_ratio));
    let wanted = SAMPLES_PER_SLOW_PERIOD.max(SAMPLES_PER_DITHER_PERIOD * fastest);
    // Multiples of 32 keep the factors of the transform small.
    let per_period = (wanted / 32.0).ceil() * 32.0;
    take_at(belt, start, solver, TAU / per_period)
}

/// The record of another run, sampled as `like`.
pub(super) fn take_like(
    belt: &Belt,
    start: Start,
    solver: &Solver,
    like: &Record,
) -> Result<(Record, Meter), Stalled> {
    take_at(belt, start, solver, like.step)
}

fn take_at(
    belt: &Belt,
    start: Start,
    solver: &Solver,
    step: f64,
) -> Result<(Record, Meter), Stalled> {
    let from = start.time + solver.settle;
    let length = f64::from(solver.record_periods) * TAU;
    let settled = simulate(belt, start, from, solver.tolerance, &mut ())?;
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "an integral number of samples by construction"
    )]
    let count = (length / step).round() as usize;
    let mut watch = (Sampler::new(from, step, count), Meter::new(belt, &settled));
    let end = simulate(belt, settled.restart(), from + length, solver.tolerance, &mut watch)?;
    let (sampler, mut meter) = watch;
    meter.finish(belt, &settled, &end);
    let samples = sampler.samples;
    Ok((
        Record {
            spectrum: spectrum_of(&samples, step),
            samples,
            step,
            events: end.events,
            load: belt.normal_load(),
        },
        meter,
    ))
}

fn largest(spectrum: &Spectrum) -> f64 {
    spectrum.largest_line(0.0, BAND_END).map_or(0.0, |peak| peak.amplitude)
}

fn spectrum_of(samples: &[Sample], step: f64) -> Spectrum {
    let displacement: Vec<f64> = samples.iter().map(|sample| sample.displacement).collect();
    // UNWRAP: a record has at least two slow periods of 128 samples, the step is positive,
    // and a run whose state is not finite stops before it is sampled.
    Spectrum::of(&displacement, step).expect("a record of finite samples")
}
