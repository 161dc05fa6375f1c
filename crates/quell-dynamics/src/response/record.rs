//! A settled record: samples at equal steps over an integral number of slow periods.

use quell_numerics::spectrum::Spectrum;

use crate::simulation::Sample;

/// A settled record of a run.
#[derive(Clone, Debug)]
pub struct SettledRecord {
    /// Samples at equal steps; the first at the end of the settling time.
    pub samples: Vec<Sample>,
    /// Step τ between samples.
    pub step: f64,
    /// Spectrum of the displacement.
    pub spectrum: Spectrum,
}

impl SettledRecord {
    /// Length of the record, τ.
    pub fn length(&self) -> f64 {
        self.samples.len() as f64 * self.step
    }

    /// The record of samples at equal steps.
    pub(super) fn of(samples: Vec<Sample>, step: f64) -> Self {
        let displacement: Vec<f64> = samples.iter().map(|sample| sample.displacement).collect();
        // UNWRAP: a record has at least two slow periods of 128 samples, the step is positive,
        // and a run whose state is not finite stops before it is sampled.
        let spectrum = Spectrum::of(&displacement, step).expect("a record of finite samples");
        Self { samples, step, spectrum }
    }
}
