//! Values of a parameter at which the response that sliding becomes under dither gains or loses stability.
//!
//! The response is followed along the parameter by pseudo-arclength, around folds and through touches of v_r = 0
//! ([`quell_numerics::continuation::branch`]). Where a multiplier passes the unit circle inside one signature the value is the root of a
//! smooth test function: a complex pair is a Neimark–Sacker bifurcation, −1 a flip, +1 a fold. Where a pure-slip orbit
//! comes to touch v_r = 0 the value is the root of its least slip velocity, a grazing: the multipliers jump there, so that a
//! search for modulus 1, or differences that straddle the touch, are wrong by up to 3·10⁻⁴.
//! Multipliers at a touch are one-sided: those of pure slip, and those of the orbit with contact events found just beyond.

use std::fmt;

use quell_model::Belt;
use quell_numerics::continuation::branch::{Branch, End, Follow, Passage, Side, follow};
use quell_numerics::continuation::spectral_radius;
use quell_numerics::continuation::threshold::Kind as Event;

use super::family::{Forced, Setting, Signature, start_of};
use super::{NoOrbit, Verdict, quiet};
use crate::simulation::Start;

/// Steps in which an orbit is first followed from sliding.
const FIRST_STEPS: u32 = 8;

/// What happens to the orbit at a threshold.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Kind {
    /// A complex pair of multipliers passes the unit circle.
    NeimarkSacker,
    /// The same of steady sliding without dither: its oscillation begins or ceases to grow.
    Hopf,
    /// A multiplier passes −1.
    Flip,
    /// A multiplier passes +1 and the branch of responses turns back.
    Fold,
    /// A multiplier passes +1 and the branch goes on.
    Branching,
    /// The orbit touches v_r = 0.
    Grazing,
    /// The order of sticks and reversals changes.
    Signature,
}

impl Kind {
    /// Every kind, in the order of the codes in files: a new one is added at the end.
    pub const ALL: [Self; 7] = [
        Self::NeimarkSacker,
        Self::Hopf,
        Self::Flip,
        Self::Fold,
        Self::Grazing,
        Self::Branching,
        Self::Signature,
    ];

    /// Word in outputs.
    pub fn name(self) -> &'static str {
        match self {
            Self::NeimarkSacker => "neimark-sacker",
            Self::Hopf => "hopf",
            Self::Flip => "flip",
            Self::Fold => "fold",
            Self::Branching => "branching",
            Self::Grazing => "grazing",
            Self::Signature => "signature",
        }
    }

    fn of(event: Event) -> Self {
        match event {
            Event::Fold => Self::Fold,
            Event::Branching => Self::Branching,
            Event::Flip => Self::Flip,
            Event::NeimarkSacker => Self::NeimarkSacker,
            Event::Touch => Self::Grazing,
            Event::Border => Self::Signature,
        }
    }

    /// What is zero on a curve of this kind; `None` where nothing is.
    pub(super) fn event(self) -> Option<Event> {
        Some(match self {
            Self::Fold => Event::Fold,
            Self::Branching | Self::Signature => return None,
            Self::Flip => Event::Flip,
            Self::NeimarkSacker | Self::Hopf => Event::NeimarkSacker,
            Self::Grazing => Event::Touch,
        })
    }
}

/// A value at which stability changes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Threshold {
    /// The parameter.
    pub value: f64,
    /// Bound on its error.
    pub error: f64,
    /// What happens.
    pub kind: Kind,
    /// Verdict for slightly larger values; `None` where this response ends there.
    pub becomes: Option<Verdict>,
    /// Verdict for slightly smaller values; `None` where this response begins there.
    pub was: Option<Verdict>,
    /// State of the response at the threshold.
    pub state: Start,
}

/// A value at which the events of a period change.
#[derive(Clone, Debug, PartialEq)]
pub struct Change {
    /// The parameter.
    pub value: f64,
    /// For slightly smaller values; `None` where there is no response.
    pub below: Option<Signature>,
    /// For slightly larger values.
    pub above: Option<Signature>,
}

/// A response on the branch.
#[derive(Clone, Debug, PartialEq)]
pub struct Place {
    /// The parameter.
    pub value: f64,
    /// The response at τ = 0.
    pub state: Start,
    /// Modulus of the larger multiplier.
    pub radius: f64,
    /// Least slip velocity in pure slip.
    pub least_slip: Option<f64>,
    /// What happens along the period.
    pub signature: Signature,
}

/// Where the branch of responses ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Ending {
    /// It covers the interval.
    Covered,
    /// It turned back, at most at this value, and left the interval where it began.
    TurnedBack {
        /// The furthest value.
        at: f64,
    },
    /// It turned back and was lost: whether it turns again and goes further is not known.
    LostTurning {
        /// The furthest value.
        furthest: f64,
        /// The last value.
        at: f64,
    },
    /// It touches v_r = 0 with no response beyond.
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

/// The thresholds of an interval, and the branch on which they lie.
#[derive(Clone, Debug, PartialEq)]
pub struct Local {
    /// Changes of stability, in the order of the branch.
    pub thresholds: Vec<Threshold>,
    /// Changes of events, in the order of the branch.
    pub changes: Vec<Change>,
    /// The responses that were met, in the order of the branch.
    pub branch: Vec<Place>,
    /// How it ends.
    pub ending: Ending,
}

impl Local {
    /// No response at the first value: nothing was followed.
    pub fn nowhere(from: f64) -> Self {
        let ending = Ending::Lost { at: from };
        Self { thresholds: Vec::new(), changes: Vec::new(), branch: Vec::new(), ending }
    }
}

/// Why there are no thresholds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum NoThresholds {
    /// The parameter cannot take this value.
    Invalid {
        /// The value.
        value: f64,
    },
    /// The orbit at the first value was not found.
    Start(NoOrbit),
    /// The orbit was lost on the way.
    Lost {
        /// The last value at which it was found.
        at: f64,
    },
}

impl fmt::Display for NoThresholds {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Invalid { value } => write!(f, "the parameter cannot be {value}"),
            Self::Start(why) => why.fmt(f),
            Self::Lost { at } => write!(f, "the response was lost beyond {at}"),
        }
    }
}

impl std::error::Error for NoThresholds {}

/// Thresholds of the response that sliding becomes at the value `from`, followed to the value `to` in at least `steps`
/// steps.
///
/// # Errors
/// [`NoThresholds`] where there is no such response at `from`.
pub fn local(
    belt: &Belt,
    path: &str,
    from: f64,
    to: f64,
    steps: u32,
) -> Result<Local, NoThresholds> {
    let valid = |value: f64| belt.with(path, value).map_err(|_| NoThresholds::Invalid { value });
    let first = quiet(&valid(from)?, FIRST_STEPS).map_err(NoThresholds::Start)?;
    valid(to)?;
    along(belt, path, (from, first.start), to, steps, 1)
}

/// Thresholds of the orbit of `periods` common periods near a state at the value `from`, followed to the value `to`.
///
/// # Errors
/// [`NoThresholds`] where there is no such orbit at `from`.
pub fn along(
    belt: &Belt,
    path: &str,
    (from, start): (f64, Start),
    to: f64,
    steps: u32,
    periods: u32,
) -> Result<Local, NoThresholds> {
    let paths = [path];
    let forced = Forced { belt, setting: Setting::Paths(&paths), periods };
    let state = [start.displacement, start.velocity];
    let window = Follow::window(from, to, steps);
    let branch = follow(&forced, &state, from, to > from, window)
        .map_err(|why| NoThresholds::Start(why.into()))?;
    let mut found = told(&branch, from, to);
    if belt.dithers().is_empty() {
        for threshold in &mut found.thresholds {
            if threshold.kind == Kind::NeimarkSacker {
                threshold.kind = Kind::Hopf;
            }
        }
    }
    Ok(found)
}

/// A branch in the terms of the belt.
fn told(branch: &Branch<Signature>, from: f64, to: f64) -> Local {
    let mut thresholds = Vec::new();
    let mut changes = Vec::new();
    for passage in &branch.passages {
        let (was, becomes) = (verdict(passage.below.as_ref()), verdict(passage.above.as_ref()));
        let kind = Kind::of(passage.kind);
        if was != becomes {
            let state = start_of(&passage.state);
            let (value, error) = (passage.parameter, passage.error);
            thresholds.push(Threshold { value, error, kind, becomes, was, state });
        }
        changes.extend(change(passage));
    }
    let places = branch.points.iter().map(|it| Place {
        value: it.parameter,
        state: start_of(&it.state),
        radius: spectral_radius(&it.multipliers),
        least_slip: it.distance.is_finite().then_some(it.distance),
        signature: it.signature.clone(),
    });
    let beyond = |a: f64, b: f64| (b - a) * (to - from) > 0.0;
    let further = |a: f64, b: f64| if beyond(a, b) { b } else { a };
    let passed = branch.passages.iter().map(|it| it.parameter);
    let furthest = branch.points.iter().map(|it| it.parameter).chain(passed).fold(from, further);
    let ending = match branch.end {
        End::Window { at } if at == to => Ending::Covered,
        End::Window { .. } | End::Closed => Ending::TurnedBack { at: furthest },
        End::Touch { at } => Ending::Touch { at },
        End::Lost { at } | End::TooLong { at } if beyond(at, furthest) => {
            Ending::LostTurning { furthest, at }
        }
        End::Lost { at } | End::TooLong { at } => Ending::Lost { at },
    };
    Local { thresholds, changes, branch: places.collect(), ending }
}

fn verdict(side: Option<&Side<Signature>>) -> Option<Verdict> {
    side.map(|side| Verdict::of(side.radius, 0.0))
}

fn change(passage: &Passage<Signature>) -> Option<Change> {
    let signature = |side: Option<&Side<Signature>>| side.map(|side| side.signature.clone());
    let (below, above) = (signature(passage.below.as_ref()), signature(passage.above.as_ref()));
    let contact = matches!(passage.kind, Event::Touch | Event::Border);
    (contact && below != above).then_some(Change { value: passage.parameter, below, above })
}

/// Every threshold of the orbit that sliding becomes, for `path` from `from` to `to` in at least `steps` steps.
///
/// # Errors
/// [`NoThresholds`], also where the branch is lost on the way.
pub fn local_thresholds(
    belt: &Belt,
    path: &str,
    from: f64,
    to: f64,
    steps: u32,
) -> Result<Vec<Threshold>, NoThresholds> {
    let found = local(belt, path, from, to, steps)?;
    match found.ending {
        Ending::Lost { at } | Ending::LostTurning { at, .. } => Err(NoThresholds::Lost { at }),
        _ => Ok(found.thresholds),
    }
}
