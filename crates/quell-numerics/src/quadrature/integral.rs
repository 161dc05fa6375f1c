//! The result of a quadrature, and the reasons why it failed.

/// Value of an integral, with the error bound that was reached and the cost.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Integral {
    /// ∫ f dx.
    pub value: f64,
    /// Estimated absolute error; includes the rounding of the sums, but not that of evaluating the integrand.
    pub error: f64,
    /// Number of evaluations of the integrand.
    pub evaluations: usize,
}

/// The reason why a quadrature could not meet its tolerance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum QuadratureError {
    /// An end or a break point is not finite.
    NotFinite {
        /// The offending end or break point.
        limit: f64,
    },
    /// The integrand is not finite at an interior point.
    IntegrandNotFinite {
        /// The point of evaluation.
        at: f64,
    },
    /// The rounding errors of the integrand (∫|f| ≫ |∫f|) exceed the requested tolerance.
    Rounding {
        /// The best value, with its error.
        best: Integral,
    },
    /// The maximum number of evaluations was reached.
    Evaluations {
        /// The best value, with its error.
        best: Integral,
    },
}

impl QuadratureError {
    /// The best value reached, if there is one.
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
