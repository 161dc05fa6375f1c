//! Why there is no verdict on a measured structure.

use quell_model::digits::digits;

use crate::averaging::AveragingError;
use crate::steady::NoSteadySliding;

/// Why there is no verdict on a measured structure.
#[derive(Clone, Debug, PartialEq)]
pub enum NoMeasuredVerdict {
    /// No steady sliding, or no average.
    NoAverage(AveragingError),
    /// The determinant does not decide.
    NoTurns(NoTurns),
    /// A dither is not a sine, whose harmonics would have to be measured.
    NotASine,
    /// The dither frequency is outside the band.
    OutsideBand {
        /// The angular frequency.
        frequency: f64,
    },
}

impl std::fmt::Display for NoMeasuredVerdict {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::NoAverage(why) => why.fmt(f),
            Self::NoTurns(why) => why.fmt(f),
            Self::NotASine => {
                f.write_str("with a measured frequency response every dither must be a sine")
            }
            Self::OutsideBand { frequency } => {
                let frequency = digits(*frequency, 6);
                write!(
                    f,
                    "the dither of angular frequency {frequency} is outside the measured band"
                )
            }
        }
    }
}

impl std::error::Error for NoMeasuredVerdict {}

impl From<AveragingError> for NoMeasuredVerdict {
    fn from(why: AveragingError) -> Self {
        Self::NoAverage(why)
    }
}

impl From<NoSteadySliding> for NoMeasuredVerdict {
    fn from(why: NoSteadySliding) -> Self {
        Self::NoAverage(why.into())
    }
}

impl From<NoTurns> for NoMeasuredVerdict {
    fn from(why: NoTurns) -> Self {
        Self::NoTurns(why)
    }
}

/// Why the turns of the determinant do not decide.
#[derive(Clone, Debug, PartialEq)]
pub enum NoTurns {
    /// The determinant turns too far between two measured frequencies.
    TooCoarse {
        /// The lower of them, angular.
        frequency: f64,
    },
    /// The determinant has not come to rest at the end of the band.
    BandTooShort {
        /// Half turns up to there.
        half_turns: f64,
    },
}

impl std::fmt::Display for NoTurns {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::TooCoarse { frequency } => write!(
                f,
                "the measured frequencies are too far apart near the angular frequency {}: the determinant turns too far \
                 between two of them, or sliding is marginal there",
                digits(*frequency, 6)
            ),
            Self::BandTooShort { half_turns } => write!(
                f,
                "the measured band ends too early: at its end the determinant has made {half_turns:.2} half turns, which is not close \
                 to a whole number"
            ),
        }
    }
}

impl std::error::Error for NoTurns {}
