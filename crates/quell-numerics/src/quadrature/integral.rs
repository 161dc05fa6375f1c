//! The result of a quadrature, and the reasons why it failed.

/// Value of an integral, the bound on its error that was reached, and what it cost.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Integral {
    /// ∫ f dx.
    pub value: f64,
    /// Estimated absolute error; includes the rounding of the sums, but not that of the integrand's own evaluation.
    pub error: f64,
    /// Number of evaluations of the integrand.
    pub evaluations: usize,
}

/// Why a quadrature could not keep its tolerance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum QuadratureError {
    /// An end or a break point is not finite.
    NotFinite {
        /// The offending end or break point.
        limit: f64,
    },
    /// The integrand is not finite at an interior point.
    IntegrandNotFinite {
        /// Where it was evaluated.
        at: f64,
    },
    /// The rounding of the integrand (∫|f| ≫ |∫f|) hides the digits asked for.
    Rounding {
        /// The best value, with its error.
        best: Integral,
    },
    /// The budget of evaluations was used up.
    Evaluations {
        /// The best value, with its error.
        best: Integral,
    },
}

impl QuadratureError {
    /// The best value reached, where there is one.
    #[must_use]
    pub fn best(&self) -> Option<Integral> {
        match *self {
            Self::Rounding { best } | Self::Evaluations { best } => Some(best),
            Self::NotFinite { .. } | Self::IntegrandNotFinite { .. } => None,
        }
    }
}

impl core::fmt::Display for QuadratureError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::NotFinite { limit } => {
                write!(f, "the limit {limit} of an integral is not finite")
            }
            Self::IntegrandNotFinite { at } => write!(f, "the integrand is not finite at {at}"),
            Self::Rounding { best } => write!(
                f,
                "rounding of the integrand leaves an error of {:e} in the integral {:e}",
                best.error, best.value
            ),
            Self::Evaluations { best } => write!(
                f,
                "after {} evaluations the integral {:e} still has an error of {:e}",
                best.evaluations, best.value, best.error
            ),
        }
    }
}

impl core::error::Error for QuadratureError {}
