//! Curves of local thresholds in two parameters, by pseudo-arclength continuation.
//!
//! Thresholds are found on a few lines across the second parameter and each is followed to the borders of the window. A
//! threshold on a known curve is not followed again. A curve that crosses none of the lines is missed.
//! The scheme is that of [`quell_numerics::continuation::curve`].

use std::fmt;

use quell_model::Belt;
use quell_numerics::continuation::curve::{BifurcationCurve as Traced, CurveEnd, Trace, trace};
use quell_numerics::continuation::spectral_radius;

use super::family::{FamilyParameters, Forced, Signature};
use super::shooting::near;
use super::threshold::{BranchEnding, Local, NoThresholds, Threshold, ThresholdKind, local};
use super::verdict::OrbitVerdict;
use crate::simulation::Start;

/// Steps of the continuation runs that find the first points.
const STEPS: u32 = 40;

/// Distance beyond a grazing, relative to the parameter, at which the response with contact events is evaluated.
const BEYOND: f64 = 1e-5;

/// The plane of two parameters and their windows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ParameterPlane<'a> {
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
pub struct ThresholdCurvePoint {
    /// The first parameter.
    pub value: f64,
    /// The second parameter.
    pub along: f64,
    /// The state of the response.
    pub state: Start,
    /// Modulus of the larger multiplier; at a grazing, of the response in pure slip.
    pub radius: f64,
}

/// A curve of thresholds.
#[derive(Clone, Debug, PartialEq)]
pub struct ThresholdCurve {
    /// The kind of bifurcation.
    pub kind: ThresholdKind,
    /// Its points, in order.
    pub points: Vec<ThresholdCurvePoint>,
    /// How it ends at its first and at its last point.
    pub ends: [ThresholdCurveEnd; 2],
}

/// How a curve of thresholds ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ThresholdCurveEnd {
    /// At the border of a window.
    Window,
    /// At its own start: the curve is closed.
    Closed,
    /// Its response grazes v_r = 0.
    Grazing,
    /// Its pair of multipliers is real.
    Resonance,
    /// Beyond it the grazing changes no verdict.
    SameVerdict,
    /// It was lost.
    Lost,
}

impl ThresholdCurveEnd {
    /// The word in outputs.
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
            CurveEnd::Grazing => Self::Grazing,
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
    /// Lines that were not searched completely.
    pub open: Vec<OpenLine>,
}

/// A line across the second parameter that was not searched completely, or on which a threshold was not followed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OpenLine {
    /// The second parameter.
    pub along: f64,
    /// The reason.
    pub why: Open,
}

/// Why a line is open.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Open {
    /// The second parameter cannot take the value.
    Invalid,
    /// There is no response to start from.
    Begin(NoThresholds),
    /// The response was lost before the end of the line.
    Lost {
        /// The last value of the first parameter at which it was found.
        at: f64,
    },
    /// A threshold was found, but no curve through it.
    NotFollowed {
        /// Its value of the first parameter.
        value: f64,
    },
}

impl Open {
    /// A description, with values of the first parameter as formatted by `value`.
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
/// The last line, if no line has a base response to start from.
pub fn curves(
    belt: &Belt,
    plane: ParameterPlane<'_>,
    lines: u32,
    points: u32,
) -> Result<CurvesFound, OpenLine> {
    let (first, last) = plane.between;
    let lines = lines.max(1);
    let mut found: Vec<ThresholdCurve> = Vec::new();
    let mut open: Vec<OpenLine> = Vec::new();
    let mut has_started = false;
    // Lines are inside the window, so that no curve starts on its border.
    for line in 0..lines {
        let along = first + (last - first) * (f64::from(line) + 0.5) / f64::from(lines);
        let on_line = belt.with(plane.along, along).map_err(|_| Open::Invalid).and_then(|belt| {
            local(&belt, plane.path, plane.window.0, plane.window.1, STEPS).map_err(Open::Begin)
        });
        let mut leave_open = |why: Open| open.push(OpenLine { along, why });
        match on_line {
            Err(why) => leave_open(why),
            Ok(Local { thresholds, ending, .. }) => {
                has_started = true;
                if let BranchEnding::Lost { at } | BranchEnding::LostTurning { at, .. } = ending {
                    leave_open(Open::Lost { at });
                }
                for threshold in thresholds {
                    if found.iter().any(|curve| passes(curve, &threshold, along, plane)) {
                        continue;
                    }
                    match follow_threshold(belt, plane, &threshold, along, points) {
                        Some(curve) => found.push(curve),
                        None => leave_open(Open::NotFollowed { value: threshold.value }),
                    }
                }
            }
        }
    }
    match open.last() {
        Some(line) if !has_started => Err(*line),
        _ => Ok(CurvesFound { curves: found, open }),
    }
}

/// Whether a curve already passes through a threshold on a line.
fn passes(
    curve: &ThresholdCurve,
    threshold: &Threshold,
    along: f64,
    plane: ParameterPlane<'_>,
) -> bool {
    let width = plane.window.1 - plane.window.0;
    curve.kind == threshold.kind
        && curve.points.windows(2).any(|pair| {
            let (a, b) = (pair[0], pair[1]);
            let share = (along - a.along) / (b.along - a.along);
            let value = share.mul_add(b.value - a.value, a.value);
            let tolerance = (0.1 * (b.value - a.value).abs()).max(1e-3 * width.abs());
            (0.0..=1.0).contains(&share) && (value - threshold.value).abs() <= tolerance
        })
}

/// The curve through a threshold.
fn follow_threshold(
    belt: &Belt,
    plane: ParameterPlane<'_>,
    threshold: &Threshold,
    along: f64,
    points: u32,
) -> Option<ThresholdCurve> {
    let paths = [plane.path, plane.along];
    let forced = Forced { belt, parameters: FamilyParameters::Paths(&paths), periods: 1 };
    let at = belt.with(plane.along, along).ok()?.with(plane.path, threshold.value).ok()?;
    // A threshold located as a root belongs to the response in pure slip, unless shooting finds another signature.
    let orbit = near(&at, threshold.state, 1).ok();
    let pure = Signature::PureSlip(1);
    let signature = match (&orbit, threshold.kind) {
        (_, ThresholdKind::Grazing) | (None, _) => pure,
        (Some(orbit), _) => orbit.signature(),
    };
    let kind = threshold.kind.event()?;
    let options = Trace::windows(plane.window, plane.between, points);
    let state = [threshold.state.displacement, threshold.state.velocity];
    let traced = trace(&forced, kind, &signature, &state, [threshold.value, along], options)?;
    let curve = threshold_curve(threshold.kind, &traced);
    Some(if threshold.kind == ThresholdKind::Grazing {
        deciding_part(belt, plane, curve, along)
    } else {
        curve
    })
}

fn threshold_curve(kind: ThresholdKind, traced: &Traced) -> ThresholdCurve {
    let points = traced
        .points
        .iter()
        .map(|point| ThresholdCurvePoint {
            value: point.parameters[0],
            along: point.parameters[1],
            state: Start::of_state(&point.state),
            radius: spectral_radius(&point.multipliers),
        })
        .collect();
    ThresholdCurve { kind, points, ends: traced.ends.map(ThresholdCurveEnd::of) }
}

/// The part of a grazing curve, around the line on which it was found, where the grazing changes the verdict.
fn deciding_part(
    belt: &Belt,
    plane: ParameterPlane<'_>,
    mut curve: ThresholdCurve,
    along: f64,
) -> ThresholdCurve {
    let decides = |point: &ThresholdCurvePoint| {
        let beyond = |side: f64| {
            let value = point.value * (1.0 + side * BEYOND);
            let at = belt.with(plane.along, point.along).ok()?.with(plane.path, value).ok()?;
            let orbit = near(&at, point.state, 1).ok()?;
            (!orbit.is_pure_slip()).then(|| orbit.verdict())
        };
        beyond(1.0).or_else(|| beyond(-1.0)) != Some(OrbitVerdict::of(point.radius, 0.0))
    };
    let kept: Vec<bool> = curve.points.iter().map(decides).collect();
    let distance = |index: &usize| (curve.points[*index].along - along).abs();
    let nearest = (0..kept.len()).min_by(|a, b| distance(a).total_cmp(&distance(b)));
    let Some(nearest) = nearest else { return curve };
    let first = (0..nearest).rev().find(|index| !kept[*index]).map_or(0, |index| index + 1);
    let last = (nearest + 1..kept.len()).find(|index| !kept[*index]).unwrap_or(kept.len());
    if first > 0 {
        curve.ends[0] = ThresholdCurveEnd::SameVerdict;
    }
    if last < kept.len() {
        curve.ends[1] = ThresholdCurveEnd::SameVerdict;
    }
    curve.points = curve.points[first..last].to_vec();
    curve
}
