//! The largest line of a spectrum as the dissertation probably read it: of one record of length 75π, without a window.
//!
//! The dissertation does not specify its record. Lines of such a record are 2/75 apart, and several of its numbers are such
//! lines: 25 · 2/75 = 0.6667 and 28 · 2/75 = 0.7467, printed without rounding as 0.666 and 0.746.

use std::f64::consts::{PI, TAU};

use quell_dynamics::response::{BAND_END, Solver};
use quell_dynamics::simulation::{Sampler, Start, simulate};
use quell_model::Belt;

use super::super::failure::failed;
use quell::complaint::Failure;

/// Length of the record, τ.
pub(super) const LENGTH: f64 = 75.0 * PI;
/// Number of samples; twice as many change no line by 10⁻⁴ of the largest.
const SAMPLES: u32 = 16_384;

/// A line of the spectrum.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct RecordLine {
    /// ω, a multiple of 2π/LENGTH.
    pub(super) frequency: f64,
    /// Amplitude of x.
    pub(super) amplitude: f64,
}

/// The largest line at 0 < ω ≤ 1.9 of the run from rest, after it has settled for as long as the record.
pub(super) fn largest_line(belt: &Belt) -> Result<RecordLine, Failure> {
    let step = LENGTH / f64::from(SAMPLES);
    let mut sampler = Sampler::new(LENGTH, step, SAMPLES as usize);
    simulate(belt, Start::REST, 2.0 * LENGTH, Solver::default().tolerance, &mut sampler)
        .map_err(|error| failed("claims", &error))?;
    let displacements: Vec<f64> =
        sampler.samples.iter().map(|sample| sample.displacement).collect();
    let lines = (1u32..).map(|k| f64::from(k) * TAU / LENGTH).take_while(|ω| *ω <= BAND_END);
    let largest = lines
        .map(|frequency| RecordLine {
            frequency,
            amplitude: amplitude(&displacements, frequency * step),
        })
        .max_by(|a, b| a.amplitude.total_cmp(&b.amplitude));
    largest.ok_or_else(|| failed("claims", &"the record has no line"))
}

/// 2/n |Σ x_j e^{−ijθ}|.
fn amplitude(values: &[f64], angle: f64) -> f64 {
    let (mut real, mut imaginary) = (0.0, 0.0);
    for (index, value) in values.iter().enumerate() {
        let phase = angle * index as f64;
        real += value * libm::cos(phase);
        imaginary += value * libm::sin(phase);
    }
    2.0 * libm::hypot(real, imaginary) / values.len() as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A tone of the record's own frequencies is one line of its amplitude; the others vanish.
    #[test]
    fn a_tone_is_a_line() {
        let angle = |line: f64| TAU * line / 1000.0;
        let tone: Vec<f64> =
            (0..1000).map(|k| 0.7 + 0.3 * (angle(7.0) * f64::from(k) + 0.4).cos()).collect();
        assert!((amplitude(&tone, angle(7.0)) - 0.3).abs() < 1e-12);
        assert!(amplitude(&tone, angle(8.0)) < 1e-12);
    }
}
