//! What happens to the base response at a value of a parameter, and how its branch ends.
//!
//! The response is followed in the parameter by pseudo-arclength continuation, around folds and through grazings of γ = 0 and N = 0
//! ([`quell_numerics::continuation::branch`]). Where a multiplier crosses the unit circle within one signature, the value is the
//! root of a smooth test function: a complex pair is a Neimark–Sacker bifurcation, −1 a flip, +1 a fold. Where a response in slip
//! grazes γ = 0, the value is the root of its least slip velocity: the multipliers jump there, so that a
//! search for modulus 1, or differences across the grazing, are wrong by up to 3·10⁻⁴.
//! Multipliers at a grazing are one-sided: those of pure slip, and those of the orbit with contact events just beyond.

use quell_numerics::continuation::branch::{End, FixedPointBranch};
use quell_numerics::continuation::threshold::BifurcationKind as Event;

/// Least width of a gap, relative to the grazing: far above the error of a located root, 10⁻¹¹ of a step, and below the gaps that
/// were met, 10⁻³. With a larger value a gap would pass for an exact threshold, with a smaller one the reverse.
const LEAST_GAP: f64 = 1e-6;

/// An interval of the parameter next to a grazing in which no response was found: where a stick begins with a static level above μ(0⁺).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ResponseGap {
    /// The value of the grazing.
    pub grazing: f64,
    /// The value at which the response begins again, known to a thousandth of the gap.
    pub end: f64,
}

impl ResponseGap {
    /// Of a grazing beyond which nothing is known over a distance with its sign; `None` where the response goes on at once.
    pub(super) fn of(grazing: f64, distance: f64) -> Option<Self> {
        let is_wide = distance.abs() > LEAST_GAP * grazing.abs();
        is_wide.then_some(Self { grazing, end: grazing + distance })
    }

    /// Its ends, ascending.
    pub fn ends(&self) -> [f64; 2] {
        [self.grazing.min(self.end), self.grazing.max(self.end)]
    }
}

/// The kind of bifurcation at a threshold.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ThresholdKind {
    /// A complex pair of multipliers crosses the unit circle.
    NeimarkSacker,
    /// The Hopf bifurcation of steady sliding without dither.
    Hopf,
    /// A multiplier crosses −1.
    Flip,
    /// A multiplier crosses +1 and the branch of responses turns back.
    Fold,
    /// A multiplier crosses +1 and the branch continues.
    Branching,
    /// The orbit grazes v_r = 0.
    Grazing,
    /// The order of sticks and reversals changes.
    Signature,
    /// A contact opens, or closes for good.
    Separation,
}

impl ThresholdKind {
    /// Every kind, in the order of the codes in files: a new one is added at the end.
    pub const ALL: [Self; 8] = [
        Self::NeimarkSacker,
        Self::Hopf,
        Self::Flip,
        Self::Fold,
        Self::Grazing,
        Self::Branching,
        Self::Signature,
        Self::Separation,
    ];

    /// The word in outputs.
    pub const fn name(self) -> &'static str {
        match self {
            Self::NeimarkSacker => "neimark-sacker",
            Self::Hopf => "hopf",
            Self::Flip => "flip",
            Self::Fold => "fold",
            Self::Branching => "branching",
            Self::Grazing => "grazing",
            Self::Signature => "signature",
            Self::Separation => "separation",
        }
    }

    pub(crate) fn of(event: Event) -> Self {
        match event {
            Event::Fold => Self::Fold,
            Event::Branching => Self::Branching,
            Event::Flip => Self::Flip,
            Event::NeimarkSacker => Self::NeimarkSacker,
            Event::Grazing => Self::Grazing,
            Event::Border => Self::Signature,
        }
    }

    /// The event whose test function is zero on a curve of this kind; `None` if no test function is zero along it.
    pub(crate) fn event(self) -> Option<Event> {
        Some(match self {
            Self::Fold => Event::Fold,
            Self::Branching | Self::Signature | Self::Separation => return None,
            Self::Flip => Event::Flip,
            Self::NeimarkSacker | Self::Hopf => Event::NeimarkSacker,
            Self::Grazing => Event::Grazing,
        })
    }
}

/// How the branch of responses ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum BranchEnding {
    /// It covers the interval.
    Covered,
    /// It turned back and left the interval at its start.
    TurnedBack {
        /// The furthest value.
        at: f64,
    },
    /// It turned back and was lost: whether it turns again and continues further is unknown.
    LostTurning {
        /// The furthest value.
        furthest: f64,
        /// The last value.
        at: f64,
    },
    /// It grazes v_r = 0, and no response exists beyond.
    Touch {
        /// The value.
        at: f64,
    },
    /// It was lost.
    Lost {
        /// The last value.
        at: f64,
    },
}

impl BranchEnding {
    /// How a branch over a window ends.
    pub(crate) fn of<S>(branch: &FixedPointBranch<S>, from: f64, to: f64) -> Self {
        let beyond = |a: f64, b: f64| (b - a) * (to - from) > 0.0;
        let further = |a: f64, b: f64| if beyond(a, b) { b } else { a };
        let special = branch.special_points.iter().map(|point| point.parameter);
        let furthest =
            branch.points.iter().map(|point| point.parameter).chain(special).fold(from, further);
        match branch.end {
            End::Window { at } if at == to => Self::Covered,
            End::Window { .. } | End::Closed | End::TurnsBack { .. } => {
                Self::TurnedBack { at: furthest }
            }
            End::Grazing { at } => Self::Touch { at },
            End::Lost { at } | End::TooLong { at } if beyond(at, furthest) => {
                Self::LostTurning { furthest, at }
            }
            End::Lost { at } | End::TooLong { at } => Self::Lost { at },
        }
    }
}
