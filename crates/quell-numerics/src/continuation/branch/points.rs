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
    /// The events during the period.
    pub signature: S,
}

/// The branch on one side of a special point.
#[derive(Clone, Debug, PartialEq)]
pub struct BranchSide<S> {
    /// Number of multipliers outside the unit circle.
    pub unstable: usize,
    /// Largest modulus of the multipliers.
    pub radius: f64,
    /// The events during the period.
    pub signature: S,
}

/// A special point of a branch: a threshold, or a border of signatures.
#[derive(Clone, Debug)]
pub struct SpecialPoint<S> {
    /// The parameter.
    pub parameter: f64,
    /// Bound on its error.
    pub error: f64,
    /// How far from a grazing point, with its sign, no response was found before the branch goes on; 0 where it goes on at once.
    pub gap: f64,
    /// Kind of the bifurcation.
    pub kind: BifurcationKind,
    /// The state.
    pub state: Vec<f64>,
    /// The branch for slightly smaller parameters; at a turning point with two branches, the one with fewer unstable
    /// multipliers.
    pub below: Option<BranchSide<S>>,
    /// The same for slightly larger parameters.
    pub above: Option<BranchSide<S>>,
}

impl<S> SpecialPoint<S> {
    /// Whether the branch turns back there, or ends: it is on one side only.
    pub fn is_turn(&self) -> bool {
        self.below.is_none() || self.above.is_none()
    }
}

/// End of a continuation run along a branch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum End {
    /// At an end of the window.
    Window {
        /// The parameter.
        at: f64,
    },
    /// At its start: the branch is closed.
    Closed,
    /// At a grazing point with no fixed point beyond it on either side.
    Grazing {
        /// The parameter.
        at: f64,
    },
    /// The branch turns back, and the run does not follow it further.
    TurnsBack {
        /// The parameter.
        at: f64,
    },
    /// The branch was lost.
    Lost {
        /// The last parameter, beyond which the steps became too short.
        at: f64,
    },
    /// After the maximum number of points.
    TooLong {
        /// The last parameter.
        at: f64,
    },
}

/// A branch with its special points, in order.
#[derive(Clone, Debug)]
pub struct FixedPointBranch<S> {
    /// Points.
    pub points: Vec<ContinuationPoint<S>>,
    /// Thresholds and borders of signatures.
    pub special_points: Vec<SpecialPoint<S>>,
    /// End of the branch.
    pub end: End,
}
