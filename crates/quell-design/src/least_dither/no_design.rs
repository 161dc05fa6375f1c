//! Why no dither is the answer to a design.

use super::LimitedQuantity;
use super::worst_point::NoLeast;
use crate::NoAnswer;

/// Why no dither is allowed.
#[derive(Clone, Debug, PartialEq)]
pub enum NoDesign {
    /// No allowed amplitude is quiet at this operating point.
    NeverQuiet {
        /// The point.
        point: Vec<f64>,
    },
    /// The nearest dither exceeds a limit.
    Limit {
        /// The limited quantity.
        quantity: LimitedQuantity,
        /// The ratio of its value to the limit (of the limit to its value for a smallest load).
        used: f64,
        /// The operating point, if it decides.
        point: Option<Vec<f64>>,
    },
    /// A limit of the actuator that no dither is known to keep: it has no finite value, or the file of the actuator ends before.
    Unlimited {
        /// The limited quantity.
        quantity: LimitedQuantity,
        /// The operating point, if it decides.
        point: Option<Vec<f64>>,
        /// Why.
        why: NoAnswer,
    },
    /// A point has no answer.
    Failed {
        /// The point.
        point: Vec<f64>,
        /// Why.
        why: NoAnswer,
    },
}

impl NoDesign {
    /// Whether it is known that there is no design: not where a computation failed on the way.
    pub fn is_known(&self) -> bool {
        !matches!(self, Self::Failed { .. })
    }
}

impl From<NoLeast> for NoDesign {
    fn from(why: NoLeast) -> Self {
        match why {
            NoLeast::NeverQuiet { point } => Self::NeverQuiet { point },
            NoLeast::Failed { point, why } => Self::Failed { point, why },
        }
    }
}
