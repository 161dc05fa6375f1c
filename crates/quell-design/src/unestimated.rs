//! What a fit does not determine, and why.

use std::fmt;

/// Why a parameter of a fit has no standard error.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NoStandardError {
    /// The value was given.
    Fixed,
    /// The least RSS is on a bound of the parameter, where linearised errors do not hold.
    OnBound,
    /// It is on the bound 0.
    OnZero,
    /// It is on the bound that another parameter gives.
    OnBoundBy(&'static str),
    /// It is at the limit of the search.
    AtLimit,
    /// The data do not depend on the parameter.
    NoEffect,
    /// They determine it only together with other parameters.
    OnlyTogether,
    /// The RSS does not change with the parameter, or only together with others.
    NoChange,
    /// The model does not explain the data.
    NotExplained,
}

impl NoStandardError {
    /// Whether it is about this parameter: not where its value is fixed, nor where the whole model fails.
    pub fn is_of_parameter(self) -> bool {
        !matches!(self, Self::Fixed | Self::NotExplained)
    }
}

impl fmt::Display for NoStandardError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Fixed => "the value is fixed",
            Self::OnBound => "the least RSS is on a bound of the parameter",
            Self::OnZero => "the least RSS is on the bound 0",
            Self::OnBoundBy(other) => {
                return write!(f, "the least RSS is on the bound that {other} gives");
            }
            Self::AtLimit => {
                "the RSS is least at the limit of the search, an order of magnitude beyond the data"
            }
            Self::NoEffect => "the record does not depend on it",
            Self::OnlyTogether => "the record determines it only together with other parameters",
            Self::NoChange => {
                "the RSS does not change with this parameter, or only together with others"
            }
            Self::NotExplained => {
                "the model does not explain the record: a standard error is that of a model that does"
            }
        })
    }
}

impl std::error::Error for NoStandardError {}

/// A fit through all its data, whose information criterion has no lower bound.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ExactFit {
    /// Through every point of a law.
    Points,
    /// Through every sample of a record.
    Samples,
}

impl fmt::Display for ExactFit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Points => "the law passes through every point",
            Self::Samples => "the curve passes through every sample",
        })
    }
}

impl std::error::Error for ExactFit {}
