//! Why a formula is no friction law.

use std::fmt;

use super::syntax::SyntaxError;
use crate::digits::digits;

/// Digits of a number in the words.
const DIGITS: usize = 6;

/// Why a formula is no friction law.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum UnusableFormula {
    /// It is not a formula.
    Syntax(SyntaxError),
    /// It needs too many series.
    TooLong {
        /// Their number.
        slots: usize,
        /// The largest number.
        most: usize,
    },
    /// A function is not smooth where it is used.
    Kink,
    /// It is not smooth up to v = 0⁺.
    NotSmooth,
    /// It is negative at v = 0⁺.
    Negative {
        /// Its value there.
        start: f64,
    },
    /// It is neither even nor odd.
    OneSided {
        /// The slip speed at which its values differ in size.
        speed: f64,
        /// The value at that speed.
        above: f64,
        /// The value at the negative one.
        below: f64,
    },
}

impl fmt::Display for UnusableFormula {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Syntax(why) => write!(f, "a valid formula; {why}"),
            Self::TooLong { slots, most } => write!(
                f,
                "shorter: it needs {slots} series (one per product, quotient or function), and the limit is {most}"
            ),
            Self::Kink => f.write_str(
                "smooth on each side of v = 0: the argument of abs, sign and sech must be a multiple of v or a constant, \
                 because any other argument could have a kink elsewhere",
            ),
            Self::NotSmooth => f.write_str(
                "smooth up to v = 0⁺, with a finite value and slope there; powers of v are smooth only if the \
                 exponent is an integer written in the formula",
            ),
            Self::Negative { start } => {
                write!(f, "≥ 0 at every slip speed; at v = 0⁺ it is {start:.6}")
            }
            Self::OneSided { speed, above, below } => {
                let [speed, above, below] =
                    [speed, above, below].map(|value| digits(*value, DIGITS));
                write!(
                    f,
                    "the same in both directions of slip; at v = ±{speed} it is {above} and {below}. Write abs(v) for the slip speed"
                )
            }
        }
    }
}

impl std::error::Error for UnusableFormula {}
