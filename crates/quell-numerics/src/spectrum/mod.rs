//! Amplitude spectrum of a sampled record.
//!
//! For n samples x_k at the step h: weighted mean removed, x̃ = x − Σw x/Σw; window w_k = ½(1 − cos 2πk/n)
//! (periodic Hann); zeros appended to M = 4n; X_j = Σ w_k x̃_k e^{−2πi jk/M}. The results are the angular
//! frequencies ω_j = 2πj/(Mh) and the spectral amplitudes A_j = 2|X_j|/Σw: a pure tone a·cos ωt far from
//! 0 and from the Nyquist frequency gives a peak of height a. Because the mean is removed with the window's own weights,
//! the line at ω = 0 vanishes identically and is set to exactly zero.
//!
//! Peaks are interpolated with the window's own transform W(δ) ∝ sin πδ / (πδ(1 − δ²)), δ in bins of the unpadded
//! record: δ is determined from the ratio of the two largest neighbouring lines, which is exact for a single tone in a long
//! record (a parabola is not). The remaining error is the leakage of other tones, which decreases with the third power of
//! their distance in bins.
//!
//! Limits: tones closer than two bins 2π/(nh) form one peak.
//!
//! Reference: F. J. Harris, *Proc. IEEE* 66 (1978) 51–83; T. Grandke, *IEEE Trans. Instrum. Meas.* 32 (1983) 350.

pub mod low_band;
mod transform;

use core::f64::consts::PI;

use crate::roots::{Closeness, find_root};

/// Factor by which the record is lengthened with zeros; the lines are closer than the resolution of the record by this factor.
pub const ZERO_PADDING: usize = 4;

/// Noise bandwidth of the Hann window, in bins of the unpadded record (Harris 1978, table 1).
const HANN_NOISE_BANDWIDTH: f64 = 1.5;

/// Amplitude spectrum: lines at equal steps of angular frequency from 0 to the Nyquist frequency.
#[derive(Debug, Clone, PartialEq)]
pub struct Spectrum {
    /// Step between lines, in radians per unit of time.
    spacing: f64,
    /// Spectral amplitude of each line, in the unit of the samples.
    amplitudes: Vec<f64>,
}

/// A peak of a spectrum.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Peak {
    /// Angular frequency ω (radians per unit of time).
    pub frequency: f64,
    /// Spectral amplitude, in the unit of the samples (half of peak-to-peak for a pure tone).
    pub amplitude: f64,
}

/// The reason why a record has no spectrum.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SpectrumError {
    /// Fewer than [`MINIMUM_SAMPLES`] samples.
    TooShort {
        /// Number of samples.
        samples: usize,
    },
    /// The step is not a positive finite number.
    Step {
        /// The step.
        step: f64,
    },
    /// A sample is not finite.
    NotFinite {
        /// Its index in the record.
        index: usize,
    },
}

/// Minimum number of samples for a meaningful Hann window.
pub const MINIMUM_SAMPLES: usize = 8;

impl core::fmt::Display for SpectrumError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::TooShort { samples } => {
                write!(f, "a spectrum needs at least {MINIMUM_SAMPLES} samples, not {samples}")
            }
            Self::Step { step } => write!(f, "the sampling step must be positive, not {step}"),
            Self::NotFinite { index } => write!(f, "sample {index} is not finite"),
        }
    }
}

impl core::error::Error for SpectrumError {}

impl Spectrum {
    /// Spectrum of `samples` taken at equal time steps `step`.
    ///
    /// # Errors
    /// [`SpectrumError`] for a record that is too short or not finite, or an invalid step.
    pub fn of(samples: &[f64], step: f64) -> Result<Self, SpectrumError> {
        let n = samples.len();
        if n < MINIMUM_SAMPLES {
            return Err(SpectrumError::TooShort { samples: n });
        }
        if !(step > 0.0 && step.is_finite()) {
            return Err(SpectrumError::Step { step });
        }
        if let Some(index) = samples.iter().position(|x| !x.is_finite()) {
            return Err(SpectrumError::NotFinite { index });
        }
        let window: Vec<f64> = (0..n)
            .map(|k| {
                let s = libm::sin(PI * (k as f64 / n as f64));
                s * s
            })
            .collect();
        // Records of length scales 10⁻³⁰⁰ or 10³⁰⁰ must not lose their square.
        let scale = samples.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        let scale = if scale > 0.0 { scale } else { 1.0 };
        let weight: f64 = window.iter().sum();
        let mean = window.iter().zip(samples).map(|(w, x)| w * (x / scale)).sum::<f64>() / weight;
        let padded = ZERO_PADDING * n;
        let mut input = vec![0.0; padded];
        for ((slot, w), x) in input.iter_mut().zip(&window).zip(samples) {
            *slot = w * (x / scale - mean);
        }
        let lines = transform::real_lines(&input);
        let factor = 2.0 / weight;
        let mut amplitudes: Vec<f64> =
            lines.iter().map(|line| scale * (factor * libm::hypot(line.re, line.im))).collect();
        amplitudes[0] = 0.0;
        Ok(Self { spacing: 2.0 * PI / (padded as f64 * step), amplitudes })
    }

    /// Angular frequency of line `index`.
    #[must_use]
    pub fn frequency(&self, index: usize) -> f64 {
        index as f64 * self.spacing
    }

    /// Angular frequencies of all lines, from 0 to the Nyquist frequency.
    pub fn frequencies(&self) -> impl ExactSizeIterator<Item = f64> + '_ {
        (0..self.amplitudes.len()).map(|j| self.frequency(j))
    }

    /// Root mean square of the record between two angular frequencies, and of its rate of change: sums over the
    /// lines between them, where a tone is weighted with the noise bandwidth of the window, 3/2 bins of the unpadded record.
    /// `None` if the spectrum ends below `high`.
    #[must_use]
    pub fn root_mean_square(&self, low: f64, high: f64) -> Option<[f64; 2]> {
        // Lines at the ends of the band count as inside, regardless of the rounding of the ends.
        let (low, high) = (low * (1.0 - 1e-9), high * (1.0 + 1e-9));
        let last = self.frequency(self.amplitudes.len() - 1);
        if high > last * (1.0 + 2e-9) {
            return None;
        }
        // Records of length scales 10⁻³⁰⁰ or 10³⁰⁰ must not lose their square.
        let scale = self.amplitudes.iter().fold(f64::MIN_POSITIVE, |m, a| m.max(*a));
        let inside = |line: &(f64, f64)| (low..=high).contains(&line.0);
        let lines = self.frequencies().zip(self.amplitudes.iter().copied()).filter(inside);
        let sums = lines.fold([0.0; 2], |[square, of_rate], (frequency, amplitude)| {
            let power = (amplitude / scale) * (amplitude / scale);
            [square + power, frequency.mul_add(frequency * power, of_rate)]
        });
        let tones = 0.5 / (HANN_NOISE_BANDWIDTH * ZERO_PADDING as f64);
        Some(sums.map(|sum| scale * libm::sqrt(sum * tones)))
    }

    /// Spectral amplitudes of all lines, in the unit of the samples.
    #[must_use]
    pub fn amplitudes(&self) -> &[f64] {
        &self.amplitudes
    }

    /// The largest line with `low < ω ≤ high`, on the frequency grid (without interpolation), as compared in the
    /// residual vibration E = M₁/M₀ of (2.27). `None` if no line lies there.
    #[must_use]
    pub fn largest_line(&self, low: f64, high: f64) -> Option<Peak> {
        let mut best: Option<Peak> = None;
        for (frequency, &amplitude) in self.frequencies().zip(&self.amplitudes) {
            let inside = frequency > low && frequency <= high;
            if inside && best.is_none_or(|b| amplitude > b.amplitude) {
                best = Some(Peak { frequency, amplitude });
            }
        }
        best
    }

    /// Peaks whose amplitude is at least `floor` times the largest line, in order of frequency, with interpolated
    /// frequency and amplitude.
    ///
    /// A line is a peak if it is the largest within one half-width of the window's main lobe (two bins of the unpadded record)
    /// on either side, so that side lobes of the window are not peaks.
    #[must_use]
    pub fn peaks(&self, floor: f64) -> Vec<Peak> {
        let a = &self.amplitudes;
        let reach = 2 * ZERO_PADDING;
        let largest = a.iter().fold(0.0_f64, |m, x| m.max(*x));
        let mut peaks = Vec::new();
        for j in 1..a.len() - 1 {
            if a[j] <= 0.0 || a[j] < floor * largest {
                continue;
            }
            let from = j.saturating_sub(reach);
            let to = (j + reach).min(a.len() - 1);
            let highest =
                a[from..j].iter().all(|x| *x < a[j]) && a[j + 1..=to].iter().all(|x| *x <= a[j]);
            if highest {
                peaks.push(self.interpolate(j));
            }
        }
        peaks
    }

    /// Tone whose window transform passes through line `j` and its larger neighbour.
    fn interpolate(&self, j: usize) -> Peak {
        let a = &self.amplitudes;
        let (side, neighbour) =
            if a[j + 1] >= a[j - 1] { (1.0, a[j + 1]) } else { (-1.0, a[j - 1]) };
        let bin = 1.0 / ZERO_PADDING as f64;
        // δ: distance of the tone from line j towards the neighbour, in unpadded bins, 0 … bin/2.
        let excess = |delta: f64| neighbour * hann_lobe(delta) - a[j] * hann_lobe(bin - delta);
        // Leakage of other tones can push the ratio out of the range of the window: then the nearer end is the best estimate.
        let delta = if excess(0.0) <= 0.0 {
            0.0
        } else if excess(0.5 * bin) >= 0.0 {
            0.5 * bin
        } else {
            let closeness = Closeness { absolute: 1e-15, relative: 0.0 };
            find_root(excess, 0.0, 0.5 * bin, closeness).map_or(0.0, |root| root.location)
        };
        Peak {
            frequency: (j as f64 + side * delta / bin) * self.spacing,
            amplitude: a[j] / hann_lobe(delta),
        }
    }
}

/// Transform of the Hann window relative to its peak, sin πδ / (πδ(1 − δ²)), for |δ| < 1 in bins.
fn hann_lobe(delta: f64) -> f64 {
    if delta == 0.0 { 1.0 } else { libm::sin(PI * delta) / (PI * delta * (1.0 - delta * delta)) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tone(n: usize, step: f64, f: impl Fn(f64) -> f64) -> Vec<f64> {
        (0..n).map(|k| f(k as f64 * step)).collect()
    }

    /// A tone on a bin is exact for any offset, and DC is exactly zero.
    #[test]
    fn a_tone_on_a_bin_is_exact() {
        let (n, step) = (1000, 0.1);
        let omega = 2.0 * PI * 17.0 / (n as f64 * step);
        let x = tone(n, step, |t| 0.37 * libm::cos(omega * t + 0.4) + 12.5);
        let s = Spectrum::of(&x, step).expect("valid");
        assert_eq!(s.amplitudes()[0], 0.0);
        let top = s.largest_line(0.0, 2.0).expect("a line");
        assert!((top.amplitude - 0.37).abs() < 1e-13, "{top:?}");
        assert!((top.frequency - omega).abs() < 1e-13);
        let peaks = s.peaks(1e-6);
        assert_eq!(peaks.len(), 1, "{peaks:?}");
        assert!((peaks[0].amplitude - 0.37).abs() < 1e-9);
    }

    /// Between the lines, the grid maximum is too low by up to 1.0 %, but the interpolated peak is accurate.
    #[test]
    fn tones_between_bins_are_interpolated() {
        let (n, step) = (4096, 0.05);
        for k in 0..40 {
            let omega = 1.0 + 0.00173 * f64::from(k);
            let x = tone(n, step, |t| 2.0 * libm::sin(omega * t + 0.1 * f64::from(k)));
            let s = Spectrum::of(&x, step).expect("valid");
            let line = s.largest_line(0.0, 1.9).expect("a line");
            assert!(line.amplitude <= 2.0 + 1e-5 && line.amplitude > 2.0 * 0.989, "{line:?}");
            let peaks = s.peaks(0.01);
            assert_eq!(peaks.len(), 1);
            // The mirror image at −ω is 33 bins away: leakage of at most 1/33³.
            assert!((peaks[0].frequency - omega).abs() < 2e-6, "{k}: {peaks:?} {omega}");
            assert!((peaks[0].amplitude - 2.0).abs() < 1e-4, "{k}: {peaks:?}");
        }
    }

    /// Two tones 60 dB apart are resolved, without spurious peaks from the window.
    #[test]
    fn a_weak_tone_next_to_a_strong_one_is_resolved() {
        let (n, step) = (20000, 0.05);
        let x = tone(n, step, |t| libm::cos(0.91 * t) + 1e-3 * libm::cos(2.73 * t + 1.0));
        let s = Spectrum::of(&x, step).expect("valid");
        let peaks = s.peaks(1e-4);
        assert_eq!(peaks.len(), 2, "{peaks:?}");
        assert!((peaks[0].frequency - 0.91).abs() < 1e-8);
        assert!((peaks[1].frequency - 2.73).abs() < 1e-6);
        assert!((peaks[1].amplitude - 1e-3).abs() < 1e-7);
    }

    /// The sum of A² over the lines is the energy of the windowed record (Parseval).
    #[test]
    fn parseval_holds_for_the_windowed_record() {
        let n = 501;
        let x = tone(n, 1.0, |t| libm::sin(t * t * 0.01) + 0.2 * libm::cos(0.7 * t));
        let s = Spectrum::of(&x, 1.0).expect("valid");
        let w = |k: usize| 0.5 * (1.0 - libm::cos(2.0 * PI * k as f64 / n as f64));
        let weight: f64 = (0..n).map(w).sum();
        let mean = (0..n).map(|k| w(k) * x[k]).sum::<f64>() / weight;
        let energy: f64 = (0..n).map(|k| (w(k) * (x[k] - mean)) * (w(k) * (x[k] - mean))).sum();
        let a = s.amplitudes();
        let m = (ZERO_PADDING * n) as f64;
        let last = a.len() - 1;
        let lines: f64 = 2.0 * a[1..last].iter().map(|y| y * y).sum::<f64>() + a[last] * a[last];
        let from_lines = lines * (weight / 2.0) * (weight / 2.0) / m;
        assert!((from_lines - energy).abs() < 1e-12 * energy, "{from_lines} {energy}");
    }

    #[test]
    fn spectra_scale_linearly_and_invalid_records_are_rejected() {
        let x = tone(256, 0.1, |t| libm::sin(3.0 * t) + 0.3);
        let s = Spectrum::of(&x, 0.1).expect("valid");
        let small: Vec<f64> = x.iter().map(|y| y * 2.0_f64.powi(-400)).collect();
        let t = Spectrum::of(&small, 0.1).expect("valid");
        for (a, b) in s.amplitudes().iter().zip(t.amplitudes()) {
            assert!((a - b * 2.0_f64.powi(400)).abs() <= 1e-15);
        }
        let flat = Spectrum::of(&[3.0; 64], 1.0).expect("valid");
        assert!(flat.amplitudes().iter().all(|a| *a < 1e-14));
        assert!(flat.largest_line(0.0, 1e-9).is_none());
        assert_eq!(Spectrum::of(&[1.0; 3], 1.0), Err(SpectrumError::TooShort { samples: 3 }));
        assert_eq!(Spectrum::of(&x, 0.0), Err(SpectrumError::Step { step: 0.0 }));
        let mut broken = x;
        broken[5] = f64::NAN;
        assert_eq!(Spectrum::of(&broken, 1.0), Err(SpectrumError::NotFinite { index: 5 }));
    }

    /// For two tones with a band about each: √½ of its amplitude, regardless of the other tone, and that times its frequency.
    #[test]
    fn a_band_has_the_root_mean_square_of_its_tones() {
        let (step, count) = (0.05, 4000);
        let x: Vec<f64> = (0..count)
            .map(|k| {
                let t = step * f64::from(k);
                3.0 * libm::cos(1.037 * t) + 0.02 * libm::sin(7.3 * t + 0.4) - 5.0
            })
            .collect();
        let spectrum = Spectrum::of(&x, step).expect("a record");
        let half = core::f64::consts::FRAC_1_SQRT_2;
        for (low, high, amplitude, frequency) in [(0.5, 1.5, 3.0, 1.037), (6.0, 9.0, 0.02, 7.3)] {
            let [found, rate] = spectrum.root_mean_square(low, high).expect("inside");
            assert!((found / (amplitude * half) - 1.0).abs() < 1e-3, "{found}");
            assert!((rate / (amplitude * half * frequency) - 1.0).abs() < 2e-3, "{rate}");
        }
        assert!(spectrum.root_mean_square(1.0, 63.0).is_none());
    }
}
