//! Values of a parameter at which the base response gains or loses stability.
//!
//! The response is followed in the parameter by pseudo-arclength continuation, around folds and through grazings of v_r = 0
//! ([`quell_numerics::continuation::branch`]). Where a multiplier crosses the unit circle within one signature, the value is the
//! root of a smooth test function: a complex pair is a Neimark–Sacker bifurcation, −1 a flip, +1 a fold. Where a pure-slip
//! orbit grazes v_r = 0, the value is the root of its least slip velocity: the multipliers jump there, so that a
//! search for modulus 1, or differences across the grazing, are wrong by up to 3·10⁻⁴.
//! Multipliers at a grazing are one-sided: those of pure slip, and those of the orbit with contact events just beyond.

use std::fmt;

use quell_linear::criticality::of_steady_sliding;
use quell_numerics::continuation::branch::{
    BranchSide, End, FixedPointBranch, Follow, SpecialPoint, follow,
};
use quell_numerics::continuation::criticality::{FirstLyapunov, NoFirstLyapunov, first_lyapunov};
use quell_numerics::continuation::fold::{FoldCoefficient, fold_coefficient};
use quell_numerics::continuation::spectral_radius;
use quell_numerics::continuation::threshold::BifurcationKind as Event;

use super::family::{BeltAt, FamilyParameters, Forced, Signature};
use super::no_orbit::NoOrbit;
use super::shooting::base_response;
use super::verdict::OrbitVerdict;
use crate::simulation::Start;

/// Number of steps in which the base response is first continued from sliding.
const FIRST_STEPS: u32 = 8;

/// Relative error of a threshold from which it is that of a gap: far above that of a located root, 10⁻¹¹ of a step, and below the gaps that
/// were met, 10⁻³. With a larger value a gap would pass for an exact threshold, with a smaller one the reverse.
const GAP: f64 = 1e-6;

/// Whether the error of a threshold is a gap next to a grazing, in which no response is known.
pub fn is_gap(value: f64, error: f64) -> bool {
    error > GAP * value.abs()
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

/// A value at which stability changes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Threshold {
    /// The parameter.
    pub value: f64,
    /// Bound on the error of the value.
    pub error: f64,
    /// The kind of bifurcation.
    pub kind: ThresholdKind,
    /// Verdict for slightly larger values; `None` if the response ends there.
    pub becomes: Option<OrbitVerdict>,
    /// Verdict for slightly smaller values; `None` if the response begins there.
    pub was: Option<OrbitVerdict>,
    /// State of the response at the threshold.
    pub state: Start,
    /// Whether the vibration beyond it grows from zero, by the coefficient of its normal form: per period of the map, and of a
    /// Hopf bifurcation as [`quell_linear::criticality`] gives it. The critical vector has displacement 1.
    pub first_lyapunov: Result<FirstLyapunov, NoFirstLyapunov>,
    /// On which side of a fold two responses exist; `None` for other kinds. The critical vector has displacement 1.
    pub fold: Option<Result<FoldCoefficient, NoFirstLyapunov>>,
}

/// A value at which the signature changes.
#[derive(Clone, Debug, PartialEq)]
pub struct SignatureChange {
    /// The parameter.
    pub value: f64,
    /// Signature for slightly smaller values; `None` without a response.
    pub below: Option<Signature>,
    /// Signature for slightly larger values; `None` without a response.
    pub above: Option<Signature>,
}

/// A response on the branch.
#[derive(Clone, Debug, PartialEq)]
pub struct BranchResponse {
    /// The parameter.
    pub value: f64,
    /// The response at τ = 0.
    pub state: Start,
    /// Modulus of the larger multiplier.
    pub radius: f64,
    /// Least slip velocity in pure slip.
    pub least_slip: Option<f64>,
    /// The sequence of events in the period.
    pub signature: Signature,
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

/// The thresholds in an interval, and the branch that contains them.
#[derive(Clone, Debug, PartialEq)]
pub struct Local {
    /// Changes of stability, in the order of the branch.
    pub thresholds: Vec<Threshold>,
    /// Changes of the signature, in the order of the branch.
    pub changes: Vec<SignatureChange>,
    /// The computed responses, in the order of the branch.
    pub branch: Vec<BranchResponse>,
    /// How the branch ends.
    pub ending: BranchEnding,
}

impl Local {
    /// The result without a response at the first value: nothing was followed.
    pub fn nowhere(from: f64) -> Self {
        let ending = BranchEnding::Lost { at: from };
        Self { thresholds: Vec::new(), changes: Vec::new(), branch: Vec::new(), ending }
    }
}

/// Why no thresholds were found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum NoThresholds {
    /// The parameter cannot take this value.
    Invalid {
        /// The value.
        value: f64,
    },
    /// The orbit at the first value was not found.
    Start(NoOrbit),
    /// The orbit was lost before the end of the interval.
    Lost {
        /// The last value at which it was found.
        at: f64,
    },
}

impl fmt::Display for NoThresholds {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Invalid { value } => write!(f, "the parameter cannot take the value {value}"),
            Self::Start(why) => why.fmt(f),
            Self::Lost { at } => write!(f, "the response was lost beyond {at}"),
        }
    }
}

impl std::error::Error for NoThresholds {}

/// Thresholds of the base response at the value `from`, followed to the value `to` in at least `steps` steps.
///
/// # Errors
/// [`NoThresholds`] if there is no base response at `from`.
pub fn local(at: BeltAt<'_>, from: f64, to: f64, steps: u32) -> Result<Local, NoThresholds> {
    let valid = |value: f64| at(&[value]).ok_or(NoThresholds::Invalid { value });
    let first = base_response(&valid(from)?, FIRST_STEPS).map_err(NoThresholds::Start)?;
    valid(to)?;
    along(at, (from, first.start), to, steps, 1)
}

/// Thresholds of the orbit of `periods` common periods near a state at the value `from`, followed to the value `to`.
///
/// # Errors
/// [`NoThresholds`] if there is no such orbit at `from`.
pub fn along(
    at: BeltAt<'_>,
    (from, start): (f64, Start),
    to: f64,
    steps: u32,
    periods: u32,
) -> Result<Local, NoThresholds> {
    let invalid = NoThresholds::Start(NoOrbit::Invalid { value: from });
    let belt = &at(&[from]).ok_or(invalid)?;
    let forced = Forced { belt, parameters: FamilyParameters::Numbers(at), periods };
    let state = [start.displacement, start.velocity];
    let window = Follow::window(from, to, steps);
    let branch = follow(&forced, &state, from, to > from, window)
        .map_err(|why| NoThresholds::Start(why.into()))?;
    let mut found = local_thresholds_of(&branch, from, to);
    for threshold in &mut found.thresholds {
        if belt.dithers().is_empty() && threshold.kind == ThresholdKind::NeimarkSacker {
            threshold.kind = ThresholdKind::Hopf;
        }
        let parameters = [threshold.value];
        threshold.first_lyapunov =
            criticality(&forced, threshold.kind, threshold.state, &parameters);
        threshold.fold =
            fold_of(&forced, threshold.kind, threshold.state, &parameters, (to - from).abs());
    }
    Ok(found)
}

/// The coefficient that decides whether a bifurcation is supercritical.
pub(super) fn criticality(
    forced: &Forced<'_>,
    kind: ThresholdKind,
    state: Start,
    parameters: &[f64],
) -> Result<FirstLyapunov, NoFirstLyapunov> {
    let event = kind.event().ok_or(NoFirstLyapunov::OtherKind)?;
    if kind == ThresholdKind::Hopf {
        let belt = forced.belt_at(parameters).map_err(|_| NoFirstLyapunov::NotCritical)?;
        return of_steady_sliding(&belt.system());
    }
    first_lyapunov(forced, &[state.displacement, state.velocity], parameters, event, 1)
}

/// The coefficient that decides to which side a fold in the first parameter opens, whose window is `width` wide; `None` for other
/// kinds.
pub(super) fn fold_of(
    forced: &Forced<'_>,
    kind: ThresholdKind,
    state: Start,
    parameters: &[f64],
    width: f64,
) -> Option<Result<FoldCoefficient, NoFirstLyapunov>> {
    let state = [state.displacement, state.velocity];
    (kind == ThresholdKind::Fold)
        .then(|| fold_coefficient(forced, &state, parameters, (0, width), 1))
}

/// Translates a branch into the terms of the belt.
fn local_thresholds_of(branch: &FixedPointBranch<Signature>, from: f64, to: f64) -> Local {
    let mut thresholds = Vec::new();
    let mut changes = Vec::new();
    for point in &branch.special_points {
        let (was, becomes) = (verdict(point.below.as_ref()), verdict(point.above.as_ref()));
        let kind = ThresholdKind::of(point.kind);
        if was != becomes {
            let state = Start::of_state(&point.state);
            let (value, error) = (point.parameter, point.error);
            let first_lyapunov = Err(NoFirstLyapunov::OtherKind);
            let found =
                Threshold { value, error, kind, becomes, was, state, first_lyapunov, fold: None };
            thresholds.push(found);
        }
        changes.extend(signature_change(point));
    }
    let responses = branch.points.iter().map(|point| BranchResponse {
        value: point.parameter,
        state: Start::of_state(&point.state),
        radius: spectral_radius(&point.multipliers),
        least_slip: point.distance.is_finite().then_some(point.distance),
        signature: point.signature.clone(),
    });
    let ending = BranchEnding::of(branch, from, to);
    Local { thresholds, changes, branch: responses.collect(), ending }
}

fn verdict(side: Option<&BranchSide<Signature>>) -> Option<OrbitVerdict> {
    side.map(|side| OrbitVerdict::of(side.radius, 0.0))
}

fn signature_change(point: &SpecialPoint<Signature>) -> Option<SignatureChange> {
    let signature = |side: Option<&BranchSide<Signature>>| side.map(|side| side.signature.clone());
    let (below, above) = (signature(point.below.as_ref()), signature(point.above.as_ref()));
    let is_contact = matches!(point.kind, Event::Grazing | Event::Border);
    (is_contact && below != above).then_some(SignatureChange {
        value: point.parameter,
        below,
        above,
    })
}

/// Every threshold of the base response, for `path` from `from` to `to` in at least `steps` steps.
///
/// # Errors
/// [`NoThresholds`], also if the branch is lost before `to`.
pub fn local_thresholds(
    at: BeltAt<'_>,
    from: f64,
    to: f64,
    steps: u32,
) -> Result<Vec<Threshold>, NoThresholds> {
    let found = local(at, from, to, steps)?;
    match found.ending {
        BranchEnding::Lost { at } | BranchEnding::LostTurning { at, .. } => {
            Err(NoThresholds::Lost { at })
        }
        _ => Ok(found.thresholds),
    }
}
