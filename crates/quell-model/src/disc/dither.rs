//! Dither of the friction of a disc's loads: f(τ) = f (1 + α e g) in the normal direction, f α g in the tangential one, with
//! g = g(Rτ + φ_l + π/2) and an envelope e of τ.
//!
//! The dissertation's dither is cos Rτ. A waveform g is defined once, for every kind of study, and the sine is sin θ; a disc's dither
//! therefore leads by a quarter of a cycle of the waveform, of a burst by that of its carrier. At τ = 0 a square wave has just
//! begun the second half of its positive part, and samples are at a quarter of their list.

use crate::Invalid;
use crate::parameter::DITHER_FREQUENCY_RATIO;
use crate::parameter::disc::DISC_DITHER_AMPLITUDE;
use crate::profile::Knots;
use crate::waveform::Waveform;
use quell_numerics::interval::RealInterval;

/// Waveform of a dither, and the share of its amplitude over time.
#[derive(Clone, Debug, PartialEq)]
pub struct DitherShape {
    /// Waveform g.
    pub waveform: Waveform,
    /// Share e of the amplitude over time; `None` for the whole amplitude at all times.
    pub envelope: Option<Knots>,
}

impl Default for DitherShape {
    /// A sine of constant amplitude.
    fn default() -> Self {
        Self { waveform: Waveform::Sine, envelope: None }
    }
}

impl DitherShape {
    /// The most negative value of e g.
    fn least(&self) -> f64 {
        let RealInterval { lower: low, upper: high } = self.waveform.range();
        let RealInterval { lower: from, upper: to } =
            self.envelope.as_ref().map_or(RealInterval::point(1.0), Knots::range);
        let products = [from * low, from * high, to * low, to * high];
        products.into_iter().fold(f64::INFINITY, f64::min)
    }
}

/// Dither of the friction force f(τ) of every load, here with a cosine; [`DitherShape`] has other waves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum DiscDither {
    /// f(τ) = f.
    None,
    /// f(τ) = f (1 + α cos Rτ), (5.22): the normal load varies.
    Normal {
        /// Amplitude ratio α, 0 ≤ α ≤ 1: beyond 1 the pad would separate from the disc.
        amplitude: f64,
        /// Frequency ratio R > 0.
        frequency_ratio: f64,
    },
    /// f(τ) = f α cos Rτ, (5.31): the direction of sliding alternates, the mean friction vanishes.
    Tangential {
        /// Amplitude ratio α ≥ 0; 1 in the dissertation.
        amplitude: f64,
        /// Frequency ratio R > 0.
        frequency_ratio: f64,
    },
}

impl DiscDither {
    /// Mean of f(τ)/f and amplitude of its cosine.
    pub fn mean_and_amplitude(self) -> (f64, f64) {
        match self {
            Self::None => (1.0, 0.0),
            Self::Normal { amplitude, .. } => (1.0, amplitude),
            Self::Tangential { amplitude, .. } => (0.0, amplitude),
        }
    }

    /// Frequency ratio R; `None` without dither.
    pub fn frequency_ratio(self) -> Option<f64> {
        match self {
            Self::None => None,
            Self::Normal { frequency_ratio, .. } | Self::Tangential { frequency_ratio, .. } => {
                Some(frequency_ratio)
            }
        }
    }

    /// The same dither with its amplitude times a factor.
    pub(super) fn with_amplitude_times(self, factor: f64) -> Self {
        match self {
            Self::None => Self::None,
            Self::Normal { amplitude, frequency_ratio } => {
                Self::Normal { amplitude: factor * amplitude, frequency_ratio }
            }
            Self::Tangential { amplitude, frequency_ratio } => {
                Self::Tangential { amplitude: factor * amplitude, frequency_ratio }
            }
        }
    }

    pub(super) fn complaints(self, shape: &DitherShape) -> Vec<Invalid> {
        let (Self::Normal { amplitude, frequency_ratio }
        | Self::Tangential { amplitude, frequency_ratio }) = self
        else {
            return Vec::new();
        };
        let mut complaints: Vec<Invalid> =
            [(DISC_DITHER_AMPLITUDE, amplitude), (DITHER_FREQUENCY_RATIO, frequency_ratio)]
                .iter()
                .filter_map(|(parameter, value)| parameter.check(*value).err())
                .collect();
        if !shape.waveform.is_periodic() {
            let allowed = "periodic: the exponents of a disc, its resonances and tongues exist under periodic dither only";
            complaints.push(Invalid::new("dither.waveform", shape.waveform.name(), allowed));
            return complaints;
        }
        let least = shape.least();
        if matches!(self, Self::Normal { .. }) && amplitude * -least > 1.0 {
            let most = if least == -1.0 { "1".to_owned() } else { (-least).recip().to_string() };
            let why = "more normal dither would pull the contact apart, which this model does not describe";
            let allowed = format!("at most {most}: {why}");
            complaints.push(Invalid::new(DISC_DITHER_AMPLITUDE.path, amplitude, allowed));
        }
        if let Some(envelope) = &shape.envelope
            && matches!(self, Self::Tangential { .. })
        {
            let allowed = "left out: tangential dither is the limit in which the mean friction vanishes, so that a smaller share \
                           of it would be no weaker dither";
            complaints.push(Invalid::new("dither.envelope", envelope.values()[0], allowed));
        }
        complaints
    }
}
