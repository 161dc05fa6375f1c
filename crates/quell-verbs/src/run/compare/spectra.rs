//! Spectra of a measured and of a computed record.

use quell_numerics::spectrum::{Peak, Spectrum};

/// A spectrum in the units of the record.
#[derive(Clone, Debug, PartialEq)]
pub enum ComparedSpectrum {
    /// Of samples at equal steps. Frequencies are angular ones over 2π.
    OfRecord {
        /// The spectrum.
        spectrum: Spectrum,
    },
    /// As a file gives it.
    OnGrid {
        /// Frequencies.
        frequencies: Vec<f64>,
        /// Amplitudes.
        amplitudes: Vec<f64>,
    },
}

impl ComparedSpectrum {
    /// Peaks of at least `floor` of the largest line.
    pub(super) fn peaks(&self, floor: f64) -> Vec<Peak> {
        match self {
            Self::OfRecord { spectrum } => {
                let peaks = spectrum.peaks(floor).into_iter();
                peaks.map(|peak| Peak { frequency: cycles(peak.frequency), ..peak }).collect()
            }
            Self::OnGrid { frequencies, amplitudes } => peaks_on(frequencies, amplitudes, floor),
        }
    }

    /// Frequencies and amplitudes of its lines.
    pub fn lines(&self) -> Vec<(f64, f64)> {
        match self {
            Self::OfRecord { spectrum } => spectrum
                .frequencies()
                .map(cycles)
                .zip(spectrum.amplitudes().iter().copied())
                .collect(),
            Self::OnGrid { frequencies, amplitudes } => {
                frequencies.iter().copied().zip(amplitudes.iter().copied()).collect()
            }
        }
    }

    /// Root mean square between two frequencies: of a record of everything there, of a spectrum from a file of its peaks, because its window
    /// is unknown.
    pub(super) fn root_mean_square(&self, low: f64, high: f64) -> f64 {
        match self {
            Self::OfRecord { spectrum } => {
                let last = spectrum.frequency(spectrum.amplitudes().len() - 1);
                let high = (std::f64::consts::TAU * high).min(last);
                let found = spectrum.root_mean_square(std::f64::consts::TAU * low, high);
                found.map_or(0.0, |[value, _]| value)
            }
            Self::OnGrid { .. } => self.by_peaks(low, high),
        }
    }

    /// Root mean square of the peaks between two frequencies.
    pub(super) fn by_peaks(&self, low: f64, high: f64) -> f64 {
        let peaks = self.peaks(0.0).into_iter();
        let inside = peaks.filter(|peak| (low..=high).contains(&peak.frequency));
        inside.map(|peak| 0.5 * peak.amplitude * peak.amplitude).sum::<f64>().sqrt()
    }
}

/// Cycles per unit of time.
pub(super) fn cycles(angular: f64) -> f64 {
    angular / std::f64::consts::TAU
}

/// Peaks of a spectrum on any grid: the values above both neighbours, at least `floor` of the largest one.
fn peaks_on(frequencies: &[f64], amplitudes: &[f64], floor: f64) -> Vec<Peak> {
    let largest = amplitudes.iter().copied().fold(0.0, f64::max);
    (1..amplitudes.len().saturating_sub(1))
        .filter(|place| {
            let own = amplitudes[*place];
            own > amplitudes[place - 1] && own >= amplitudes[place + 1] && own >= floor * largest
        })
        .map(|place| Peak { frequency: frequencies[place], amplitude: amplitudes[place] })
        .collect()
}
