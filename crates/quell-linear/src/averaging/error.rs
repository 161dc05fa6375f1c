//! Why an average has no value.

use quell_model::digits::digits;
use quell_numerics::eigen::EigenError;
use quell_numerics::quadrature::{Integral, QuadratureError};

use crate::periodic_response::NoPeriodicResponse;
use crate::steady::NoSteadySliding;

/// Why an average is not a number.
#[derive(Clone, Debug, PartialEq)]
pub enum AveragingError {
    /// No slip and no fast motion: friction takes any value in [−μ_s, μ_s].
    SetValued {
        /// Static coefficient μ_s.
        static_coefficient: f64,
    },
    /// More groups of incommensurate dithers than nested quadrature supports.
    TooManyGroups {
        /// Number of groups with mutually incommensurate frequencies.
        groups: usize,
        /// Largest number supported.
        largest: usize,
    },
    /// The response of a belt was requested to a dither that is not faster than the mass itself.
    NotFast {
        /// Frequency ratio R ≤ 1.
        frequency_ratio: f64,
    },
    /// A dither excites an undamped resonance.
    Resonance {
        /// Angular frequency.
        frequency: f64,
    },
    /// A wave has no periodic response in the structure.
    NoResponse(NoPeriodicResponse),
    /// No steady sliding exists.
    NoSteadySliding(NoSteadySliding),
    /// A dither is a factor on the friction force of a contact.
    FrictionFactor,
    /// The state matrix overflows.
    Eigenvalues(EigenError),
    /// A quadrature did not reach its tolerance.
    Quadrature(QuadratureError),
}

impl From<NoPeriodicResponse> for AveragingError {
    fn from(why: NoPeriodicResponse) -> Self {
        Self::NoResponse(why)
    }
}

impl From<NoSteadySliding> for AveragingError {
    fn from(why: NoSteadySliding) -> Self {
        Self::NoSteadySliding(why)
    }
}

impl From<EigenError> for AveragingError {
    fn from(why: EigenError) -> Self {
        Self::Eigenvalues(why)
    }
}

impl From<QuadratureError> for AveragingError {
    fn from(error: QuadratureError) -> Self {
        Self::Quadrature(error)
    }
}

impl core::fmt::Display for AveragingError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::SetValued { static_coefficient } => write!(
                f,
                "without slip and fast motion, the friction coefficient can take any value up to ±{}",
                digits(*static_coefficient, 6)
            ),
            Self::TooManyGroups { groups, largest } => write!(
                f,
                "the dithers have {groups} mutually incommensurate frequencies, but averaging supports at most {largest}"
            ),
            Self::NotFast { frequency_ratio } => write!(
                f,
                "averaging at finite R requires a frequency ratio above 1, not {}",
                digits(*frequency_ratio, 6)
            ),
            Self::Resonance { frequency } => write!(
                f,
                "the dither of angular frequency {} excites an undamped resonance",
                digits(*frequency, 6)
            ),
            Self::NoResponse(why) => {
                write!(f, "the fast motion under the dither has no value: {why}")
            }
            Self::NoSteadySliding(why) => write!(f, "no steady sliding: {why}"),
            Self::FrictionFactor => f.write_str(
                "a dither is a factor on a friction force, whose product with the fast motion of the contact no average has: exact \
                 exponents and motions have it",
            ),
            Self::Eigenvalues(why) => why.fmt(f),
            Self::Quadrature(error) => write!(f, "averaging: {error}"),
        }
    }
}

impl core::error::Error for AveragingError {}

/// Relative error of an integral that is accepted where a sliver of the integrand, between two crossings within rounding of an
/// extremum, cannot be resolved.
const SLIVER: f64 = 1e-8;

/// Accepts an integral whose tolerance was missed because of the rounding of its integrand, or by a sliver, with the error that
/// it has.
pub(super) fn settled(
    integral: Result<Integral, QuadratureError>,
) -> Result<Integral, AveragingError> {
    match integral {
        Ok(integral) | Err(QuadratureError::Rounding { best: integral }) => Ok(integral),
        Err(QuadratureError::Evaluations { best }) if best.error <= SLIVER * best.value.abs() => {
            Ok(best)
        }
        Err(error) => Err(error.into()),
    }
}
