//! Fast motion with one period: the slip and the load of dithers of commensurate frequencies.

use core::f64::consts::TAU;
use quell_model::Waveform;
use quell_model::waveform::Piece;
use quell_numerics::quadrature::{QuadratureOptions, integrate};

use super::error::{AveragingError, settled};
use super::wave::FastWave;

/// Slope of a sine over the steepest one below which its quarters are no breaks.
const FLAT: f64 = 1e-3;

/// One dither's part of the fast slip velocity: amplitude·wave(harmonic·θ + phase).
#[derive(Clone, Debug, PartialEq)]
pub struct SlipTerm {
    /// Shape for unit amplitude.
    pub wave: FastWave,
    /// Amplitude: α for tangential dither, α_N μ for normal dither (a velocity of either sign).
    pub amplitude: f64,
    /// Frequency as a multiple of the group's.
    pub harmonic: u32,
    /// Phase, radians.
    pub phase: f64,
}

/// One normal dither's part of the load: amplitude·waveform(harmonic·θ + phase).
#[derive(Clone, Debug, PartialEq)]
pub struct LoadTerm {
    /// Waveform g.
    pub waveform: Waveform,
    /// D_N/F.
    pub amplitude: f64,
    /// Frequency as a multiple of the group's.
    pub harmonic: u32,
    /// Phase, radians.
    pub phase: f64,
}

/// Fast motion with one period: dithers of commensurate frequencies.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PeriodicMotion {
    /// Slip due to tangential dithers.
    pub tangential: Vec<SlipTerm>,
    /// Slip due to normal dithers, to first order.
    pub normal: Vec<SlipTerm>,
    /// Factor of the added term S² − ⟨S²⟩, where S is the sum of `normal`: −μ′/(2μ) for the second order of normal dither, else
    /// 0.
    pub distortion: f64,
    /// Fast part of the normal load divided by F.
    pub load: Vec<LoadTerm>,
}

impl PeriodicMotion {
    /// The wave and its amplitude where the motion reduces to a single undistorted wave that is known from a quarter.
    pub(super) fn single_term(&self) -> Option<(&FastWave, f64)> {
        let only = match (self.tangential.as_slice(), self.normal.as_slice()) {
            ([term], []) if self.load.is_empty() => Some(term),
            // The load of a single normal dither is the derivative of its slip: they are uncorrelated.
            ([], [term]) if self.distortion == 0.0 => Some(term),
            _ => None,
        };
        only.filter(|term| term.wave.is_symmetric()).map(|term| (&term.wave, term.amplitude))
    }

    /// The waveform and its amplitude where the motion reduces to a single undistorted wave by samples.
    pub(super) fn single_sampled(&self) -> Option<(&Waveform, f64)> {
        let only = match (self.tangential.as_slice(), self.normal.as_slice()) {
            ([term], []) if self.load.is_empty() => term,
            ([], [term]) if self.distortion == 0.0 => term,
            _ => return None,
        };
        match &only.wave {
            FastWave::Integral(waveform @ Waveform::Samples(_)) => Some((waveform, only.amplitude)),
            _ => None,
        }
    }

    /// Whether load and slip of the group can be correlated.
    ///
    /// Without tangential dither they cannot: the load is dS/dθ up to a factor, and ⟨f(S) dS/dθ⟩ = 0.
    pub(super) fn has_correlated_load(&self) -> bool {
        !self.load.is_empty() && !self.tangential.is_empty()
    }

    /// ν(θ).
    pub(super) fn load_at(&self, theta: f64) -> f64 {
        self.load
            .iter()
            .map(|t| t.amplitude * t.waveform.value(f64::from(t.harmonic) * theta + t.phase))
            .sum()
    }

    /// Sum of `terms` and its derivative at θ.
    pub(super) fn sum(terms: &[SlipTerm], theta: f64) -> (f64, f64) {
        terms.iter().fold((0.0, 0.0), |(value, slope), t| {
            let harmonic = f64::from(t.harmonic);
            let (s, d) = t.wave.value_and_slope(harmonic * theta + t.phase);
            (value + t.amplitude * s, slope + t.amplitude * harmonic * d)
        })
    }

    /// Phases in (0, 2π) at which the formula of a term changes, and quarters of the waves that shape s.
    ///
    /// A sine has no change of formula: its quarters only help to find the extrema of s, to which a sine of small slope adds
    /// nothing. High harmonics of a structure's response would otherwise divide the period into thousands of intervals.
    pub(super) fn breaks(&self) -> Vec<f64> {
        let slips = || self.tangential.iter().chain(&self.normal);
        let steep = |t: &&SlipTerm| t.amplitude.abs() * f64::from(t.harmonic);
        let steepest = slips().map(|t| steep(&t)).fold(0.0, f64::max);
        let matters = |t: &&SlipTerm| {
            t.wave != FastWave::Integral(Waveform::Sine) || steep(t) > FLAT * steepest
        };
        let terms = slips().filter(matters).map(|t| (t.wave.waveform(), t.harmonic, t.phase));
        let largest = self.load.iter().map(|t| t.amplitude.abs()).fold(0.0, f64::max);
        let matters =
            |t: &&LoadTerm| t.waveform != Waveform::Sine || t.amplitude.abs() > FLAT * largest;
        let loads = self.load.iter().filter(matters).map(|t| (&t.waveform, t.harmonic, t.phase));
        let mut breaks = Vec::new();
        for (waveform, harmonic, phase) in terms.chain(loads) {
            let own = ends_of_monotone_parts(waveform);
            for period in 0..harmonic / waveform.cycles() {
                let start = f64::from(period).mul_add(waveform.period(), -phase);
                let locations = own.iter().map(|end| (start + end) / f64::from(harmonic));
                breaks.extend(locations.map(|location| location.rem_euclid(TAU)));
            }
        }
        breaks.sort_unstable_by(f64::total_cmp);
        breaks.dedup_by(|a, b| (*a - *b).abs() < 1e-13);
        breaks
    }

    /// ⟨S²⟩ of the normal dithers' slip.
    pub(super) fn normal_mean_square(&self) -> Result<f64, AveragingError> {
        let square = |theta: f64| {
            let (s, _) = Self::sum(&self.normal, theta);
            s * s
        };
        let options = QuadratureOptions::default();
        Ok(settled(integrate(square, 0.0, TAU, &self.breaks(), &options))?.value / TAU)
    }

    pub(super) fn is_still(&self) -> bool {
        self.tangential.iter().chain(&self.normal).all(|t| t.amplitude == 0.0)
    }
}

/// Phases within the period between which neither g nor G changes its formula or direction: the quarters of a symmetric
/// waveform; the breaks and the zeros of g of another one.
fn ends_of_monotone_parts(waveform: &Waveform) -> Vec<f64> {
    if waveform.is_symmetric() {
        return (0..4).map(|quarter| 0.25 * TAU * f64::from(quarter)).collect();
    }
    let breaks = waveform.breaks();
    let mut ends = breaks.to_vec();
    for (place, piece) in waveform.pieces().iter().enumerate() {
        let start = breaks[place];
        let end = breaks.get(place + 1).copied().unwrap_or_else(|| waveform.period());
        match *piece {
            Piece::Harmonic => {
                let mut quarter = start + 0.25 * TAU;
                while quarter < end {
                    ends.push(quarter);
                    quarter += 0.25 * TAU;
                }
            }
            Piece::Affine { value, slope } => {
                let zero = start - value / slope;
                if zero > start && zero < end {
                    ends.push(zero);
                }
            }
        }
    }
    ends
}
