//! A claim of the dissertation and its verdict.

use std::fmt;

use super::ledger::Expected;

/// What becomes of a claim.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ClaimVerdict {
    /// The measured value rounds to the printed one; the statement holds.
    Reproduced,
    /// The largest relative deviation from the print is at most the claim's limit.
    Within {
        /// |measured − printed|/|printed|, the largest.
        deviation: f64,
    },
    /// Further off than the limit; the statement does not hold.
    NotReproduced {
        /// The relative deviation, where numbers are compared.
        deviation: Option<f64>,
    },
    /// The printed formula does not give what its definition gives.
    FormulaWrong {
        /// |printed − right|/|right|.
        deviation: f64,
    },
}

impl ClaimVerdict {
    /// Its kind, as counted in the summary.
    pub fn name(self) -> &'static str {
        match self {
            Self::Reproduced => "reproduced",
            Self::Within { .. } => "reproduced within",
            Self::NotReproduced { .. } => "not reproduced",
            Self::FormulaWrong { .. } => "printed formula wrong",
        }
    }

    /// Does the claim hold?
    pub fn holds(self) -> bool {
        matches!(self, Self::Reproduced | Self::Within { .. })
    }

    /// The relative deviation behind it.
    pub fn deviation(self) -> Option<f64> {
        match self {
            Self::Reproduced => None,
            Self::Within { deviation } | Self::FormulaWrong { deviation } => Some(deviation),
            Self::NotReproduced { deviation } => deviation,
        }
    }
}

impl fmt::Display for ClaimVerdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Within { deviation } => write!(f, "reproduced within {}", percent(*deviation)),
            Self::NotReproduced { deviation: Some(deviation) } => {
                write!(f, "not reproduced ({} off)", percent(*deviation))
            }
            Self::FormulaWrong { deviation } => {
                write!(f, "printed formula wrong ({} off)", percent(*deviation))
            }
            _ => f.write_str(self.name()),
        }
    }
}

/// A share as a percentage, rounded up so that "within" stays true.
fn percent(share: f64) -> String {
    let value = 100.0 * share;
    if value >= 10.0 {
        format!("{:.0} %", value.ceil())
    } else {
        format!("{:.1} %", (10.0 * value).ceil() / 10.0)
    }
}

/// One claim with its verdict.
#[derive(Clone, Debug, PartialEq)]
pub struct Claim {
    /// Name that stays, such as `2.3-undithered-fundamental`.
    pub name: String,
    /// Figure, equation or section.
    pub place: String,
    /// What is claimed.
    pub statement: String,
    /// As printed; empty where the claim is no number.
    pub printed: String,
    /// As measured.
    pub measured: String,
    /// The numbers behind `measured`.
    pub values: Vec<f64>,
    /// What follows.
    pub verdict: ClaimVerdict,
    /// Largest relative deviation at which a printed number still counts as reproduced; none for a statement.
    pub tolerance: Option<f64>,
    /// The verdict on record, none for a claim that is not on record yet.
    pub expected: Option<Expected>,
    /// What a reader should know; empty for nothing.
    pub note: String,
}

impl Claim {
    /// Is the verdict the one on record?
    pub fn as_expected(&self) -> bool {
        self.expected.is_some_and(|expected| expected.name() == self.verdict.name())
    }

    /// Why it does not hold, where it does not and the reason is on record; empty otherwise.
    pub fn why(&self) -> &'static str {
        self.expected.map_or("", Expected::why)
    }

    /// Adds what a reader should know.
    pub(crate) fn note(&mut self, note: impl Into<String>) {
        self.note = note.into();
    }
}
