//! Why dithered sliding of a system has no average.

use quell_model::digits::digits;
use quell_numerics::eigen::EigenError;

use super::error::AveragingError;
use crate::periodic_response::NoPeriodicResponse;
use crate::steady::NoSteadySliding;

/// Most incommensurate frequencies whose mean is taken: over a torus of two phases.
pub const MOST_FREQUENCIES: usize = 2;

/// Why dithered sliding has no average.
#[derive(Clone, Debug, PartialEq)]
pub enum NoAverage {
    /// There is no steady sliding, with or without dither.
    NoSteadySliding(NoSteadySliding),
    /// A dither excites an undamped resonance.
    Resonance {
        /// Angular frequency.
        frequency: f64,
    },
    /// More incommensurate frequencies than [`MOST_FREQUENCIES`].
    TooManyFrequencies {
        /// Their number.
        count: usize,
    },
    /// A wave has no periodic response in the structure.
    NoResponse(NoPeriodicResponse),
    /// A dither is a factor on the friction force of a contact.
    FrictionFactor,
    /// The mean friction has no value.
    Mean(AveragingError),
    /// The state matrix overflows.
    Eigenvalues(EigenError),
}

impl std::fmt::Display for NoAverage {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::NoSteadySliding(why) => write!(f, "no steady sliding: {why}"),
            Self::Resonance { frequency } => {
                let frequency = digits(*frequency, 6);
                write!(
                    f,
                    "the dither of angular frequency {frequency} excites an undamped resonance"
                )
            }
            Self::TooManyFrequencies { count } => write!(
                f,
                "the dithers have {count} mutually incommensurate frequencies, but averaging of a system supports at most \
                 {MOST_FREQUENCIES}"
            ),
            Self::NoResponse(why) => {
                write!(f, "the fast motion under the dither has no value: {why}")
            }
            Self::FrictionFactor => f.write_str(
                "a dither is a factor on a friction force, whose product with the fast motion of the contact no average has: exact \
                 exponents and motions have it",
            ),
            Self::Mean(why) => why.fmt(f),
            Self::Eigenvalues(why) => why.fmt(f),
        }
    }
}

impl std::error::Error for NoAverage {}

impl From<NoPeriodicResponse> for NoAverage {
    fn from(why: NoPeriodicResponse) -> Self {
        Self::NoResponse(why)
    }
}

impl From<NoSteadySliding> for NoAverage {
    fn from(why: NoSteadySliding) -> Self {
        Self::NoSteadySliding(why)
    }
}

impl From<AveragingError> for NoAverage {
    fn from(why: AveragingError) -> Self {
        Self::Mean(why)
    }
}

impl From<EigenError> for NoAverage {
    fn from(why: EigenError) -> Self {
        Self::Eigenvalues(why)
    }
}
