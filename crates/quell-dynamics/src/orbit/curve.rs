//! Curves of local thresholds in two parameters, by pseudo-arclength.
//!
//! Thresholds are found on a few lines across the second parameter and each is followed to the borders of the window; what
//! lies on a curve that is already there is not followed again. A curve that crosses none of the lines is missed.
//! The scheme is that of [`quell_numerics::continuation::curve`].

use std::fmt;

use quell_model::Belt;
use quell_numerics::continuation::curve::{Curve as Traced, CurveEnd, Trace, trace};
use quell_numerics::continuation::spectral_radius;

use super::family::{Forced, Setting, Signature, start_of};
use super::threshold::{Ending as BranchEnding, Kind, Local, NoThresholds, Threshold, local};
use super::{Verdict, near};
use crate::simulation::Start;

/// Steps of the walks that find the first points.
const STEPS: u32 = 40;

/// Distance beyond a touch, relative to the parameter, at which the response with contact events is looked at.
const BEYOND: f64 = 1e-5;

/// The two parameters and their windows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane<'a> {
    /// Path of the parameter whose thresholds are followed.
    pub path: &'a str,
    /// Its window.
    pub window: (f64, f64),
    /// Path of the parameter along which they are followed.
    pub along: &'a str,
    /// Its window.
    pub between: (f64, f64),
}

/// A threshold on a curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurvePoint {
    /// The first parameter.
    pub value: f64,
    /// The second parameter.
    pub along: f64,
    /// The response there.
    pub state: Start,
    /// Modulus of the larger multiplier; at a grazing that of the response in pure slip.
    pub radius: f64,
}

/// A curve of thresholds.
#[derive(Clone, Debug, PartialEq)]
pub struct ThresholdCurve {
    /// What happens on it.
    pub kind: Kind,
    /// Its points, in order.
    pub points: Vec<CurvePoint>,
    /// How it ends at its first and its last point.
    pub ends: [Ending; 2],
}

/// How a curve of thresholds ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Ending {
    /// At the border of a window.
    Window,
    /// Where it began.
    Closed,
    /// Its response touches v_r = 0.
    Grazing,
    /// Its pair of multipliers is real.
    Resonance,
    /// Beyond it the touch changes no verdict.
    SameVerdict,
    /// It was lost.
    Lost,
}

impl Ending {
    /// Words in outputs.
    pub fn name(self) -> &'static str {
        match self {
            Self::Window => "window",
            Self::Closed => "closed",
            Self::Grazing => "grazing",
            Self::Resonance => "resonance",
            Self::SameVerdict => "same-verdict",
            Self::Lost => "lost",
        }
    }

    fn of(end: CurveEnd) -> Self {
        match end {
            CurveEnd::Window => Self::Window,
            CurveEnd::Closed => Self::Closed,
            CurveEnd::Touch => Self::Grazing,
            CurveEnd::Resonance => Self::Resonance,
            CurveEnd::Lost | CurveEnd::TooLong => Self::Lost,
        }
    }
}

/// The curves of a plane, and where curves may be missing.
#[derive(Clone, Debug, PartialEq)]
pub struct CurvesFound {
    /// The curves.
    pub curves: Vec<ThresholdCurve>,
    /// Lines that were not searched to their ends.
    pub open: Vec<OpenLine>,
}

/// A line across the second parameter that was not searched to its end, or on which a threshold was not followed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OpenLine {
    /// The second parameter.
    pub along: f64,
    /// What happened.
    pub why: Open,
}

/// Why a line is open.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Open {
    /// The second parameter cannot take the value.
    Invalid,
    /// There is nothing to begin with.
    Begin(NoThresholds),
    /// The response was lost on the way.
    Lost {
        /// The last value of the first parameter at which it was found.
        at: f64,
    },
    /// A threshold is there, but no curve through it was found.
    NotFollowed {
        /// Its value of the first parameter.
        value: f64,
    },
}

impl Open {
    /// In words, with values of the first parameter as `value` tells them.
    pub fn words(&self, value: impl Fn(f64) -> String) -> String {
        match self {
            Self::Invalid => "the parameter cannot take this value".to_owned(),
            Self::Begin(why) => why.to_string(),
            Self::Lost { at } => format!("the response was lost beyond {}", value(*at)),
            Self::NotFollowed { value: at } => {
                format!("no curve was found through the threshold at {}", value(*at))
            }
        }
    }
}

impl fmt::Display for OpenLine {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "at {}: {}", self.along, self.why.words(|value| value.to_string()))
    }
}

impl std::error::Error for OpenLine {}

/// Every curve of thresholds that crosses one of `lines` lines across the second parameter, with at least `points` points across
/// either window.
///
/// # Errors
/// The last line, where none has a response of sliding to begin with.
pub fn curves(
    belt: &Belt,
    plane: Plane<'_>,
    lines: u32,
    points: u32,
) -> Result<CurvesFound, OpenLine> {
    let (first, last) = plane.between;
    let lines = lines.max(1);
    let mut found: Vec<ThresholdCurve> = Vec::new();
    let mut open: Vec<OpenLine> = Vec::new();
    let mut begun = false;
    // Lines lie inside the window, so that a curve does not begin on its border.
    for line in 0..lines {
        let place = first + (last - first) * (f64::from(line) + 0.5) / f64::from(lines);
        let on_line = belt.with(plane.along, place).map_err(|_| Open::Invalid).and_then(|belt| {
            local(&belt, plane.path, plane.window.0, plane.window.1, STEPS).map_err(Open::Begin)
        });
        let mut leave = |why: Open| open.push(OpenLine { along: place, why });
        match on_line {
            Err(why) => leave(why),
            Ok(Local { thresholds, ending, .. }) => {
                begun = true;
                if let BranchEnding::Lost { at } | BranchEnding::LostTurning { at, .. } = ending {
                    leave(Open::Lost { at });
                }
                for threshold in thresholds {
                    if found.iter().any(|it| passes(it, &threshold, place, plane)) {
                        continue;
                    }
                    match followed(belt, plane, &threshold, place, points) {
                        Some(curve) => found.push(curve),
                        None => leave(Open::NotFollowed { value: threshold.value }),
                    }
                }
            }
        }
    }
    match open.last() {
        Some(line) if !begun => Err(*line),
        _ => Ok(CurvesFound { curves: found, open }),
    }
}

/// Whether a curve passes a threshold on a line already.
fn passes(curve: &ThresholdCurve, threshold: &Threshold, place: f64, plane: Plane<'_>) -> bool {
    let width = plane.window.1 - plane.window.0;
    curve.kind == threshold.kind
        && curve.points.windows(2).any(|pair| {
            let (a, b) = (pair[0], pair[1]);
            let share = (place - a.along) / (b.along - a.along);
            let there = share.mul_add(b.value - a.value, a.value);
            let bend = (0.1 * (b.value - a.value).abs()).max(1e-3 * width.abs());
            (0.0..=1.0).contains(&share) && (there - threshold.value).abs() <= bend
        })
}

/// The curve through a threshold.
fn followed(
    belt: &Belt,
    plane: Plane<'_>,
    threshold: &Threshold,
    place: f64,
    points: u32,
) -> Option<ThresholdCurve> {
    let paths = [plane.path, plane.along];
    let forced = Forced { belt, setting: Setting::Paths(&paths), periods: 1 };
    let at = belt.with(plane.along, place).ok()?.with(plane.path, threshold.value).ok()?;
    // A threshold that is a root belongs to the response in pure slip, unless it is found among others.
    let orbit = near(&at, threshold.state, 1).ok();
    let pure = Signature::PureSlip(1);
    let signature = match (&orbit, threshold.kind) {
        (_, Kind::Grazing) | (None, _) => pure,
        (Some(orbit), _) => orbit.signature(),
    };
    let kind = threshold.kind.event()?;
    let options = Trace::windows(plane.window, plane.between, points);
    let state = [threshold.state.displacement, threshold.state.velocity];
    let traced = trace(&forced, kind, &signature, &state, [threshold.value, place], options)?;
    let curve = told(threshold.kind, &traced);
    Some(if threshold.kind == Kind::Grazing {
        while_it_decides(belt, plane, curve, place)
    } else {
        curve
    })
}

fn told(kind: Kind, traced: &Traced) -> ThresholdCurve {
    let points = traced
        .points
        .iter()
        .map(|point| CurvePoint {
            value: point.parameters[0],
            along: point.parameters[1],
            state: start_of(&point.state),
            radius: spectral_radius(&point.multipliers),
        })
        .collect();
    ThresholdCurve { kind, points, ends: traced.ends.map(Ending::of) }
}

/// The part of a curve of touches around the line where it was met on which the touch changes the verdict.
fn while_it_decides(
    belt: &Belt,
    plane: Plane<'_>,
    mut curve: ThresholdCurve,
    place: f64,
) -> ThresholdCurve {
    let decides = |point: &CurvePoint| {
        let beyond = |side: f64| {
            let value = point.value * (1.0 + side * BEYOND);
            let at = belt.with(plane.along, point.along).ok()?.with(plane.path, value).ok()?;
            let orbit = near(&at, point.state, 1).ok()?;
            (!orbit.is_pure_slip()).then(|| orbit.verdict())
        };
        beyond(1.0).or_else(|| beyond(-1.0)) != Some(Verdict::of(point.radius, 0.0))
    };
    let kept: Vec<bool> = curve.points.iter().map(decides).collect();
    let off = |index: &usize| (curve.points[*index].along - place).abs();
    let Some(met) = (0..kept.len()).min_by(|a, b| off(a).total_cmp(&off(b))) else { return curve };
    let first = (0..met).rev().find(|it| !kept[*it]).map_or(0, |it| it + 1);
    let last = (met + 1..kept.len()).find(|it| !kept[*it]).unwrap_or(kept.len());
    if first > 0 {
        curve.ends[0] = Ending::SameVerdict;
    }
    if last < kept.len() {
        curve.ends[1] = Ending::SameVerdict;
    }
    curve.points = curve.points[first..last].to_vec();
    curve
}
