//! Fast motion with one period: the slip and the load of dithers of commensurate frequencies.

use core::f64::consts::TAU;
use std::sync::Arc;

use quell_model::Waveform;
use quell_numerics::order::ascending;
use quell_numerics::periodic_polynomial::PeriodicPolynomial;
use quell_numerics::quadrature::{QuadratureOptions, integrate};

use super::error::{AveragingError, settled};
use super::wave::{FastWave, cycles_of, ends_of_monotone_parts, ends_of_response};

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

/// Shape of a fast load for unit amplitude.
#[derive(Clone, Debug, PartialEq)]
pub enum LoadWave {
    /// A prescribed load: the waveform g itself.
    Waveform(Waveform),
    /// The load of a structure, by polynomials of the phase of the carrier.
    Response(Arc<PeriodicPolynomial>),
}

impl LoadWave {
    fn value(&self, phase: f64) -> f64 {
        match self {
            Self::Waveform(waveform) => waveform.value(phase),
            Self::Response(response) => response.value_and_slope(phase).0,
        }
    }

    /// The largest magnitude.
    pub fn peak(&self) -> f64 {
        match self {
            Self::Waveform(waveform) => waveform.peak(),
            Self::Response(response) => {
                let [least, largest] = response.range();
                largest.max(-least)
            }
        }
    }

    fn cycles(&self) -> u32 {
        match self {
            Self::Waveform(waveform) => waveform.cycles(),
            Self::Response(response) => cycles_of(response),
        }
    }

    fn ends_of_monotone_parts(&self) -> Vec<f64> {
        match self {
            Self::Waveform(waveform) => ends_of_monotone_parts(waveform),
            Self::Response(response) => ends_of_response(response),
        }
    }
}

/// One normal dither's part of the load: amplitude·wave(harmonic·θ + phase).
#[derive(Clone, Debug, PartialEq)]
pub struct LoadTerm {
    /// Shape for unit amplitude.
    pub wave: LoadWave,
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
    /// Whether the load is the derivative of the slip `normal` up to a factor, as it is without damping and stiffness: the two are
    /// then uncorrelated.
    pub load_is_slope: bool,
}

impl PeriodicMotion {
    /// The motion under dithers of that many times the amplitude.
    pub(super) fn times(&self, factor: f64) -> Self {
        let mut found = self.clone();
        let slips = found.tangential.iter_mut().chain(&mut found.normal);
        let amplitudes = slips.map(|term| &mut term.amplitude);
        let loads = found.load.iter_mut().map(|term| &mut term.amplitude);
        amplitudes.chain(loads).for_each(|amplitude| *amplitude *= factor);
        found
    }

    /// The same slip under a steady load.
    pub(super) fn without_load(&self) -> Self {
        let Self { tangential, normal, distortion, .. } = self;
        let (tangential, normal) = (tangential.clone(), normal.clone());
        Self { tangential, normal, distortion: *distortion, load: Vec::new(), load_is_slope: false }
    }

    /// The wave and its amplitude where the motion reduces to a single undistorted wave that is known from a quarter.
    pub(super) fn single_term(&self) -> Option<(&FastWave, f64)> {
        let only = match (self.tangential.as_slice(), self.normal.as_slice()) {
            ([term], []) if self.load.is_empty() => Some(term),
            ([], [term]) if self.distortion == 0.0 && !self.has_correlated_load() => Some(term),
            _ => None,
        };
        only.filter(|term| term.wave.is_symmetric()).map(|term| (&term.wave, term.amplitude))
    }

    /// The wave and its amplitude where the motion reduces to a single undistorted wave by polynomials: by samples, or a response.
    pub(super) fn single_polynomial(&self) -> Option<(&FastWave, f64)> {
        let only = match (self.tangential.as_slice(), self.normal.as_slice()) {
            ([term], []) if self.load.is_empty() => term,
            ([], [term]) if self.distortion == 0.0 && !self.has_correlated_load() => term,
            _ => return None,
        };
        match &only.wave {
            FastWave::Integral(Waveform::Samples(_)) | FastWave::Response(_) => {
                Some((&only.wave, only.amplitude))
            }
            _ => None,
        }
    }

    /// Whether load and slip of the group can be correlated.
    ///
    /// Where the load is dS/dθ up to a factor they cannot without tangential dither: ⟨f(S) dS/dθ⟩ = 0.
    pub(super) fn has_correlated_load(&self) -> bool {
        !(self.load.is_empty() || self.load_is_slope && self.tangential.is_empty())
    }

    /// ν(θ).
    pub(super) fn load_at(&self, theta: f64) -> f64 {
        self.load
            .iter()
            .map(|t| t.amplitude * t.wave.value(f64::from(t.harmonic) * theta + t.phase))
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
        let matters = |t: &&SlipTerm| !t.wave.is_sine() || steep(t) > FLAT * steepest;
        let terms = slips()
            .filter(matters)
            .map(|t| (t.wave.ends_of_monotone_parts(), t.wave.cycles(), t.harmonic, t.phase));
        let largest = self.load.iter().map(|t| t.amplitude.abs()).fold(0.0, f64::max);
        let is_sine = |t: &LoadTerm| t.wave == LoadWave::Waveform(Waveform::Sine);
        let matters = |t: &&LoadTerm| !is_sine(t) || t.amplitude.abs() > FLAT * largest;
        let loads = self
            .load
            .iter()
            .filter(matters)
            .map(|t| (t.wave.ends_of_monotone_parts(), t.wave.cycles(), t.harmonic, t.phase));
        let mut breaks = Vec::new();
        for (own, cycles, harmonic, phase) in terms.chain(loads) {
            for period in 0..harmonic / cycles {
                let start = (TAU * f64::from(cycles)).mul_add(f64::from(period), -phase);
                let locations = own.iter().map(|end| (start + end) / f64::from(harmonic));
                breaks.extend(locations.map(|location| location.rem_euclid(TAU)));
            }
        }
        ascending(&mut breaks);
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
