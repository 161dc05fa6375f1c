//! Dither of the friction of a disc's loads.

use crate::Invalid;
use crate::parameter::DITHER_FREQUENCY_RATIO;
use crate::parameter::disc::DISC_DITHER_AMPLITUDE;

/// Dither of the friction force f(τ) of every load.
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

    pub(super) fn complaints(self) -> Vec<Invalid> {
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
        if matches!(self, Self::Normal { .. }) && amplitude > 1.0 {
            complaints.push(Invalid::new(
                DISC_DITHER_AMPLITUDE.path,
                amplitude,
                "at most 1: more normal dither would pull the contact apart, which this model \
                 does not describe",
            ));
        }
        complaints
    }
}
