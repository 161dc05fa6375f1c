//! Low-pass filter and decimation: from samples at a multiple of the output rate to samples at the output rate.
//!
//! y_j = Σ h_i x_{jM + i − N/2}, i = 0 … N − 1, with M input samples per output sample, N = 60 M and
//! h_i ∝ sinc(u) B(u), u = (i + ½ − N/2)/M in output samples. B is the Blackman window over −30 ≤ u ≤ 30, and Σ h_i = 1.
//! The filter is symmetric, so that output j belongs to the time between inputs jM − 1 and jM.
//!
//! Assumptions: equally spaced samples; before the first and after the last the signal is zero.
//!
//! Accuracy: the response falls from 1 to 10⁻³·⁷ (−74 dB) between 0.454 and 0.546 of the output rate; ripple below 0.454
//! is less than 0.002 dB.
//!
//! Reference: A. V. Oppenheim and R. W. Schafer, *Discrete-Time Signal Processing*, windows for filter design.

use std::f64::consts::{PI, TAU};

/// Half of the length of the filter, in output samples: its transition band is 2.75/30 of the output rate.
const HALF_LENGTH: usize = 30;

/// Partial sums of the inner product, so that the compiler can use vector instructions.
const SUMS: usize = 8;

/// A filter with the samples that it has not used up.
#[derive(Clone, Debug)]
pub(super) struct Decimator {
    taps: Vec<f64>,
    factor: usize,
    pending: Vec<f64>,
    /// Index in `pending` of the first sample that the next output needs.
    next: usize,
    outputs: Vec<f64>,
}

impl Decimator {
    /// A filter with `factor` input samples per output sample, for `count` output samples.
    pub(super) fn new(factor: usize, count: usize) -> Self {
        let length = 2 * HALF_LENGTH * factor;
        let taps: Vec<f64> = (0..length).map(|index| tap(index, factor)).collect();
        let sum: f64 = taps.iter().sum();
        let taps = taps.into_iter().map(|tap| tap / sum).collect();
        let pending = vec![0.0; length / 2];
        Self { taps, factor, pending, next: 0, outputs: Vec::with_capacity(count) }
    }

    /// Adds an input sample.
    pub(super) fn push(&mut self, sample: f64) {
        self.pending.push(sample);
        if self.pending.len() - self.next < self.taps.len() {
            return;
        }
        self.outputs.push(product(&self.taps, &self.pending[self.next..]));
        self.next += self.factor;
        // Moving the rest to the front only now and then costs one copy per sample on average.
        if self.next >= self.taps.len() {
            self.pending.drain(..self.next);
            self.next = 0;
        }
    }

    /// The first `count` output samples; input samples that are missing are zero.
    pub(super) fn finish(mut self, count: usize) -> Vec<f64> {
        while self.outputs.len() < count {
            self.push(0.0);
        }
        self.outputs.truncate(count);
        self.outputs
    }
}

/// h_i before its normalisation.
fn tap(index: usize, factor: usize) -> f64 {
    let half = HALF_LENGTH as f64;
    let u = (index as f64 + 0.5) / factor as f64 - half;
    let angle = u / half * PI;
    let window = 0.42 + 0.5 * libm::cos(angle) + 0.08 * libm::cos(2.0 * angle);
    // u is never 0, because the length is even.
    window * libm::sin(0.5 * TAU * u) / (PI * u)
}

/// The inner product of the filter with the samples at the beginning of a slice.
fn product(taps: &[f64], samples: &[f64]) -> f64 {
    let mut sums = [0.0; SUMS];
    let parts = taps.chunks_exact(SUMS);
    let (rest, done) = (parts.remainder(), taps.len() - parts.remainder().len());
    for (taps, samples) in parts.zip(samples.chunks_exact(SUMS)) {
        for lane in 0..SUMS {
            sums[lane] += taps[lane] * samples[lane];
        }
    }
    let rest: f64 = rest.iter().zip(&samples[done..]).map(|(tap, sample)| tap * sample).sum();
    sums.iter().sum::<f64>() + rest
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The largest output for a tone of `frequency`, in cycles per output sample, away from the ends.
    fn passed(frequency: f64, factor: usize) -> f64 {
        let count = 400;
        let mut filter = Decimator::new(factor, count);
        for index in 0..count * factor {
            filter.push(libm::sin(TAU * frequency * (index as f64 + 0.5) / factor as f64));
        }
        let outputs = filter.finish(count);
        assert_eq!(outputs.len(), count);
        outputs[40..360].iter().fold(0.0, |most, output| output.abs().max(most))
    }

    #[test]
    fn tones_below_the_limit_pass_and_tones_above_do_not() {
        for factor in [4, 5, 32] {
            for frequency in [0.01, 0.1 + 1e-3, 0.3 + 1e-3, 0.45] {
                let passed = passed(frequency, factor);
                // Of 320 samples the largest is within 2 % of the amplitude.
                assert!((0.98..1.0005).contains(&passed), "{factor} {frequency}: {passed}");
            }
            // −74 dB is 2.0·10⁻⁴.
            for frequency in [0.547, 0.7, 1.0 + 1e-3, 1.4] {
                let passed = passed(frequency, factor);
                assert!(passed < 2.0e-4, "{factor} {frequency}: {passed}");
            }
        }
    }

    #[test]
    fn outputs_keep_their_time() {
        // A slow ramp passes unchanged, and output j is the signal at the time j.
        let (factor, count) = (4, 200);
        let mut filter = Decimator::new(factor, count);
        for index in 0..count * factor {
            filter.push((index as f64 + 0.5) / factor as f64);
        }
        let outputs = filter.finish(count);
        for (index, output) in outputs.iter().enumerate().take(150).skip(50) {
            // The taps are symmetric up to rounding, so that a ramp is reproduced to rounding.
            assert!((output - index as f64).abs() < 1e-11, "{index}: {output}");
        }
    }

    #[test]
    fn a_short_signal_has_its_outputs() {
        let mut filter = Decimator::new(4, 2);
        filter.push(1.0);
        assert_eq!(filter.finish(2).len(), 2);
    }
}
