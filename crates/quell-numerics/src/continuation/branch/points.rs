//! A branch of fixed points: its points, special points and end.

use num_complex::Complex64;

use super::super::threshold::BifurcationKind;

/// A point of a branch.
#[derive(Clone, Debug)]
pub struct ContinuationPoint<S> {
    /// The fixed point.
    pub state: Vec<f64>,
    /// The parameter.
    pub parameter: f64,
    /// Multipliers, the largest modulus first.
    pub multipliers: Vec<Complex64>,
    /// Mismatch after the period, relative to the scale.
    pub residual: f64,
    /// Distance from the border of the signature.
    pub distance: f64,
    /// What happens along the period.
    pub signature: S,
}

/// The branch on one side of a special_point.
#[derive(Clone, Debug, PartialEq)]
pub struct BranchSide<S> {
    /// Number of multipliers outside the unit circle.
    pub unstable: usize,
    /// Largest modulus.
    pub radius: f64,
    /// What happens along the period.
    pub signature: S,
}

/// A threshold, or a border of signatures.
#[derive(Clone, Debug)]
pub struct SpecialPoint<S> {
    /// The parameter.
    pub parameter: f64,
    /// Bound on its error.
    pub error: f64,
    /// What happens.
    pub kind: BifurcationKind,
    /// The state.
    pub state: Vec<f64>,
    /// The branch for slightly smaller parameters; of two, at a turning point, the one with fewer unstable multipliers.
    pub below: Option<BranchSide<S>>,
    /// The same for slightly larger ones.
    pub above: Option<BranchSide<S>>,
}

/// How a run along a branch ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum End {
    /// At an end of the window.
    Window {
        /// Which value.
        at: f64,
    },
    /// Where it began: the branch is closed.
    Closed,
    /// At a touch with no fixed point beyond it on either side.
    Grazing {
        /// The parameter.
        at: f64,
    },
    /// The branch was lost.
    Lost {
        /// The last parameter: beyond it steps became too short.
        at: f64,
    },
    /// After as many points as were allowed.
    TooLong {
        /// The last parameter.
        at: f64,
    },
}

/// A branch with what was passed on it, in order.
#[derive(Clone, Debug)]
pub struct FixedPointBranch<S> {
    /// Points.
    pub points: Vec<ContinuationPoint<S>>,
    /// Thresholds and borders of signatures.
    pub special_points: Vec<SpecialPoint<S>>,
    /// How it ended.
    pub end: End,
}
