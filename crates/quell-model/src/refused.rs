//! Numbers that a structure cannot take.

use std::fmt;

use crate::invalid::InvalidValues;

/// Why there is no structure with some numbers.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum RefusedNumbers {
    /// Some are out of their ranges.
    Invalid(InvalidValues),
    /// The study to which they belong refuses them, in the words of its reader.
    ByStudy(String),
}

impl RefusedNumbers {
    /// The refusal of a study.
    pub fn by_study(why: impl fmt::Display) -> Self {
        Self::ByStudy(why.to_string())
    }
}

impl From<InvalidValues> for RefusedNumbers {
    fn from(why: InvalidValues) -> Self {
        Self::Invalid(why)
    }
}

impl fmt::Display for RefusedNumbers {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Invalid(why) => why.fmt(f),
            Self::ByStudy(why) => f.write_str(why),
        }
    }
}

impl std::error::Error for RefusedNumbers {}
