//! A claim of the dissertation, its verdict and its expected verdict.

use std::fmt;

/// Verdict on a claim.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ClaimVerdict {
    /// The measured value rounds to the printed one, or the statement holds.
    Reproduced,
    /// The largest relative deviation from the printed value is at most the tolerance of the claim.
    Within {
        /// The largest |measured − printed|/|printed|.
        deviation: f64,
    },
    /// The deviation exceeds the tolerance, or the statement does not hold.
    NotReproduced {
        /// The relative deviation, where numbers are compared.
        deviation: Option<f64>,
    },
    /// The printed formula differs from its definition.
    FormulaWrong {
        /// |printed − correct|/|correct|.
        deviation: f64,
    },
    /// A finding of Quell that the dissertation does not state: it explains or extends a statement, and counts neither for nor
    /// against it.
    Finding,
}

impl ClaimVerdict {
    /// Kind of the verdict, as counted in the summary.
    pub fn name(self) -> &'static str {
        match self {
            Self::Reproduced => "reproduced",
            Self::Within { .. } => "reproduced within",
            Self::NotReproduced { .. } => "not reproduced",
            Self::FormulaWrong { .. } => "printed formula wrong",
            Self::Finding => "finding",
        }
    }

    /// Whether the claim holds.
    pub fn holds(self) -> bool {
        matches!(self, Self::Reproduced | Self::Within { .. } | Self::Finding)
    }

    /// The relative deviation on which the verdict is based.
    pub fn deviation(self) -> Option<f64> {
        match self {
            Self::Reproduced | Self::Finding => None,
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

/// A fraction as a percentage, rounded up so that "within" remains true.
fn percent(share: f64) -> String {
    let value = 100.0 * share;
    if value >= 10.0 {
        format!("{:.0} %", value.ceil())
    } else {
        format!("{:.1} %", (10.0 * value).ceil() / 10.0)
    }
}

/// The verdict that a claim is expected to have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Expected {
    /// Reproduced.
    Reproduced,
    /// Reproduced within the tolerance of the claim.
    Within,
    /// Not reproduced, with the reason.
    NotReproduced(&'static str),
    /// The printed formula is wrong, by this slip, which several formulas may share.
    FormulaWrong(&'static str),
    /// A finding that the dissertation does not state.
    Finding,
}

impl Expected {
    /// Kind of the verdict, named as by [`ClaimVerdict::name`].
    pub fn name(self) -> &'static str {
        match self {
            Self::Reproduced => "reproduced",
            Self::Within => "reproduced within",
            Self::NotReproduced(_) => "not reproduced",
            Self::FormulaWrong(_) => "printed formula wrong",
            Self::Finding => "finding",
        }
    }

    /// Why the claim does not hold; empty where it does.
    pub fn why(self) -> &'static str {
        match self {
            Self::NotReproduced(why) => why,
            Self::Reproduced | Self::Within | Self::FormulaWrong(_) | Self::Finding => "",
        }
    }
}

/// One claim with its verdict.
#[derive(Clone, Debug, PartialEq)]
pub struct Claim {
    /// Permanent name, such as `2.3-undithered-fundamental`.
    pub name: String,
    /// Figure, equation or section.
    pub place: String,
    /// The statement that is claimed.
    pub statement: String,
    /// The printed value; empty where the claim is not a number.
    pub printed: String,
    /// The measured value.
    pub measured: String,
    /// The numbers in `measured`.
    pub values: Vec<f64>,
    /// The verdict.
    pub verdict: ClaimVerdict,
    /// Largest relative deviation at which a printed number still counts as reproduced; `None` for a statement.
    pub tolerance: Option<f64>,
    /// The verdict on record; `None` for a claim that is not on record yet.
    pub expected: Option<Expected>,
    /// Remark for the reader; may be empty.
    pub note: String,
}

impl Claim {
    /// Whether the verdict is the one on record.
    pub fn as_expected(&self) -> bool {
        self.expected.is_some_and(|expected| expected.name() == self.verdict.name())
    }

    /// Whether it measures a statement of the dissertation; otherwise it is a finding.
    pub fn is_of_a_statement(&self) -> bool {
        self.verdict != ClaimVerdict::Finding
    }

    /// Why the claim does not hold, if it does not and the reason is on record; empty otherwise.
    pub fn why(&self) -> &'static str {
        self.expected.map_or("", Expected::why)
    }

    /// Sets the remark for the reader.
    pub(crate) fn note(&mut self, note: impl Into<String>) {
        self.note = note.into();
    }
}
