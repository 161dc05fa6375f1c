//! Why a node gives no number.

use std::fmt;

use quell_model::friction::expression::SyntaxError;
use quell_model::units::measure::Unread;

/// Why a node gives no number: the words after the allowed range.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum NoNumber {
    /// It is of another kind.
    OtherKind(&'static str),
    /// A number is in quotes.
    Quoted(&'static str),
    /// Its unit is wrong.
    Unit(Unread),
    /// The study has no units.
    NoUnits {
        /// What is wrong with its unit.
        why: Unread,
        /// What gives the study units.
        needed: &'static str,
    },
    /// A formula of parameters is wrong.
    Formula(SyntaxError),
}

impl fmt::Display for NoNumber {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::OtherKind(kind) => write!(f, "; got {kind}"),
            Self::Quoted(kind) => write!(f, ", without quotes; got {kind}"),
            Self::Unit(why) => write!(f, "; {why}"),
            Self::NoUnits { why, needed } => write!(f, "; {why}: units require {needed}"),
            Self::Formula(why) => write!(f, ", or a formula of parameters; {why}"),
        }
    }
}

impl std::error::Error for NoNumber {}
