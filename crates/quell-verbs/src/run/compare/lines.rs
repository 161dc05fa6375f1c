//! Lines of a measured and of a computed spectrum, set against each other.

use quell_numerics::order::{ascending_by, descending_by};
use quell_numerics::spectrum::Peak;

use super::spectra::ComparedSpectrum;
use crate::reasons::reasons;

/// Lines below this share of the largest one are not listed: 60 dB.
const FLOOR: f64 = 1e-3;

/// Lines farther apart than this share of their frequency are different ones, if the resolution separates them.
const SAME: f64 = 0.03;

/// Most lines that are listed.
const MOST_LINES: usize = 16;

/// A line of the measured record, of the computed one, or of both.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ComparedLine {
    /// In the measured spectrum.
    pub measured: Option<Peak>,
    /// In the computed spectrum.
    pub computed: Option<Peak>,
}

reasons! {
    /// The spectrum that lacks a line.
    pub enum MissingLine {
        ;
        /// That of the record.
        OfRecord => "the record has no line there",
        /// That of the study.
        OfStudy => "the study has no line there",
    }
}

impl ComparedLine {
    /// Its frequency, measured if it is.
    pub fn frequency(&self) -> f64 {
        self.measured.or(self.computed).map_or(0.0, |peak| peak.frequency)
    }

    /// Measured over computed amplitude, in decibels.
    ///
    /// # Errors
    /// The spectrum that lacks the line.
    pub fn difference(&self) -> Result<f64, MissingLine> {
        let measured = self.measured.ok_or(MissingLine::OfRecord)?;
        let computed = self.computed.ok_or(MissingLine::OfStudy)?;
        Ok(decibels(measured.amplitude / computed.amplitude))
    }

    fn size(&self) -> f64 {
        let size = |peak: Option<Peak>| peak.map_or(0.0, |peak| peak.amplitude);
        size(self.measured).max(size(self.computed))
    }
}

/// 20 log₁₀ of a ratio of amplitudes.
pub fn decibels(ratio: f64) -> f64 {
    20.0 * libm::log10(ratio)
}

/// The largest lines of both spectra, by frequency; `resolution` is the distance that a spectrum separates.
pub(super) fn compared(
    measured: &ComparedSpectrum,
    computed: &ComparedSpectrum,
    resolution: f64,
) -> Vec<ComparedLine> {
    let mut theirs = computed.peaks(FLOOR);
    let mut lines: Vec<ComparedLine> = Vec::new();
    let mut by_size = measured.peaks(FLOOR);
    descending_by(&mut by_size, |a| a.amplitude);
    for peak in by_size {
        let near = resolution.max(SAME * peak.frequency);
        let away = |other: &Peak| (other.frequency - peak.frequency).abs();
        let nearest =
            (0..theirs.len()).min_by(|a, b| away(&theirs[*a]).total_cmp(&away(&theirs[*b])));
        let computed = nearest.filter(|place| away(&theirs[*place]) <= near);
        let computed = computed.map(|place| theirs.remove(place));
        lines.push(ComparedLine { measured: Some(peak), computed });
    }
    lines.extend(
        theirs.into_iter().map(|peak| ComparedLine { measured: None, computed: Some(peak) }),
    );
    descending_by(&mut lines, ComparedLine::size);
    lines.truncate(MOST_LINES);
    ascending_by(&mut lines, ComparedLine::frequency);
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_paired_once_and_the_rest_is_listed_alone() {
        let of = |peaks: &[(f64, f64)]| {
            let grid: Vec<f64> = (0..2000).map(|k| 0.01 * f64::from(k)).collect();
            let value = |f: &f64| {
                peaks.iter().find(|(at, _)| (f - at).abs() < 1e-9).map_or(0.0, |(_, a)| *a)
            };
            let amplitudes = grid.iter().map(value).collect();
            ComparedSpectrum::OnGrid { frequencies: grid, amplitudes }
        };
        let measured = of(&[(1.0, 2.0), (3.0, 0.5), (10.0, 0.1)]);
        let computed = of(&[(1.01, 1.0), (3.3, 0.5), (10.0, 0.1)]);
        let found = compared(&measured, &computed, 0.02);
        let differences: Vec<Option<f64>> =
            found.iter().map(|line| line.difference().ok()).collect();
        assert_eq!(found.len(), 4);
        assert!((differences[0].expect("paired") - 6.020_599_913_279_624).abs() < 1e-12);
        assert_eq!(&differences[1..3], &[None, None]);
        assert_eq!(differences[3], Some(0.0));
    }
}
