//! Curves of local thresholds in two parameters, by pseudo-arclength continuation.
//!
//! Thresholds are found on a few lines across the second parameter and each is followed to the borders of the window. A
//! threshold on a known curve is not followed again. A curve that crosses none of the lines is missed.
//! The scheme is that of [`quell_numerics::continuation::curve`]; any response with a period map can be followed.

use std::fmt;

use quell_numerics::continuation::criticality::{FirstLyapunov, NoFirstLyapunov};
use quell_numerics::continuation::curve::{
    BifurcationCurve as Traced, BifurcationCurvePoint, CurveEnd,
};
use quell_numerics::continuation::fold::FoldCoefficient;
use quell_numerics::continuation::spectral_radius;

use super::threshold::{BranchEnding, NoThresholds, ThresholdKind};
use super::verdict::OrbitVerdict;
use crate::simulation::Start;

/// Distance beyond a grazing, relative to the parameter, at which the response with contact events is evaluated.
const BEYOND: f64 = 1e-5;

/// A threshold on a curve, with a state of type `S`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ThresholdCurvePoint<S = Start> {
    /// The first parameter.
    pub value: f64,
    /// The second parameter.
    pub along: f64,
    /// The state of the response.
    pub state: S,
    /// Modulus of the larger multiplier; at a grazing, of the response in pure slip.
    pub radius: f64,
    /// What the normal form says about it.
    pub form: PointForm,
}

/// What the normal form at a threshold on a curve says.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointForm {
    /// Whether the vibration beyond a Hopf, Neimark–Sacker or flip bifurcation grows from zero.
    pub first_lyapunov: Result<FirstLyapunov, NoFirstLyapunov>,
    /// Towards which values of the first parameter a fold opens; `None` for other kinds.
    pub fold: Option<Result<FoldCoefficient, NoFirstLyapunov>>,
}

/// A curve of thresholds.
#[derive(Clone, Debug, PartialEq)]
pub struct ThresholdCurve<S = Start> {
    /// The kind of bifurcation.
    pub kind: ThresholdKind,
    /// The contacts that graze or open, counted from 0; empty for other kinds, and for a belt, which has one.
    pub contacts: Vec<usize>,
    /// Its points, in order.
    pub points: Vec<ThresholdCurvePoint<S>>,
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
    /// Another threshold crosses it: beyond, the response is unstable on both sides, or another contact grazes or opens first.
    Crossing,
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
            Self::Crossing => "crossing",
            Self::Lost => "lost",
        }
    }

    pub(crate) fn of(end: CurveEnd) -> Self {
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
pub struct CurvesFound<S = Start, W = NoThresholds> {
    /// The curves.
    pub curves: Vec<ThresholdCurve<S>>,
    /// Lines that were not searched completely.
    pub open: Vec<OpenLine<W>>,
}

/// A line across the second parameter that was not searched completely, or on which a threshold was not followed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OpenLine<W = NoThresholds> {
    /// The second parameter.
    pub along: f64,
    /// The reason.
    pub why: Open<W>,
}

/// Why a line is open.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Open<W = NoThresholds> {
    /// The second parameter cannot take the value.
    Invalid,
    /// There is no response to start from.
    Begin(W),
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

impl<W: fmt::Display> Open<W> {
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

impl<W: fmt::Display> fmt::Display for OpenLine<W> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "at {}: {}", self.along, self.why.words(|value| value.to_string()))
    }
}

impl<W: fmt::Display + fmt::Debug> std::error::Error for OpenLine<W> {}

/// The thresholds on a line, and the last value of the first parameter if the response was lost there.
pub(crate) struct LineSearched<T> {
    pub(crate) thresholds: Vec<T>,
    pub(crate) lost: Option<f64>,
}

impl<T> LineSearched<T> {
    pub(crate) fn new(thresholds: Vec<T>, ending: BranchEnding) -> Self {
        let lost = match ending {
            BranchEnding::Lost { at } | BranchEnding::LostTurning { at, .. } => Some(at),
            _ => None,
        };
        Self { thresholds, lost }
    }
}

/// A base response over a plane of two parameters.
pub(crate) trait ResponsePlane {
    /// A state of the response.
    type State;
    /// A threshold on a line.
    type Found;
    /// Why there is no response to start from.
    type Why;

    /// Windows of the first and of the second parameter.
    fn windows(&self) -> [(f64, f64); 2];

    /// The thresholds at a value of the second parameter.
    fn on_line(&self, along: f64) -> Result<LineSearched<Self::Found>, Open<Self::Why>>;

    /// Value and kind of a threshold, and the contacts that graze or open there.
    fn place(found: &Self::Found) -> (f64, ThresholdKind, &[usize]);

    /// What the normal form at a point of a curve of this kind says.
    fn form(&self, kind: ThresholdKind, point: &ThresholdCurvePoint<Self::State>) -> PointForm;

    /// The curve through a threshold, to the borders of the windows.
    fn through(&self, found: &Self::Found, along: f64) -> Option<ThresholdCurve<Self::State>>;

    /// The verdict on the response with further events near a state on the curve of a grazing, at values of both parameters;
    /// `None` if no such response exists.
    fn with_events(
        &self,
        found: &Self::Found,
        at: (f64, f64),
        state: &Self::State,
    ) -> Option<OrbitVerdict>;
}

/// The curves of a plane, or the last line if no line has a base response to start from.
type Searched<P> = Result<
    CurvesFound<<P as ResponsePlane>::State, <P as ResponsePlane>::Why>,
    OpenLine<<P as ResponsePlane>::Why>,
>;

/// Every curve of thresholds that crosses one of `lines` lines across the second parameter.
///
/// # Errors
/// The last line, if no line has a base response to start from.
pub(crate) fn curves_of<P: ResponsePlane>(plane: &P, lines: u32) -> Searched<P> {
    let [window, (first, last)] = plane.windows();
    let lines = lines.max(1);
    let mut found: Vec<ThresholdCurve<P::State>> = Vec::new();
    let mut open: Vec<OpenLine<P::Why>> = Vec::new();
    let mut has_started = false;
    // Lines are inside the window, so that no curve starts on its border.
    for line in 0..lines {
        let along = first + (last - first) * (f64::from(line) + 0.5) / f64::from(lines);
        let mut leave_open = |why| open.push(OpenLine { along, why });
        let LineSearched { thresholds, lost } = match plane.on_line(along) {
            Ok(searched) => searched,
            Err(why) => {
                leave_open(why);
                continue;
            }
        };
        has_started = true;
        if let Some(at) = lost {
            leave_open(Open::Lost { at });
        }
        for threshold in thresholds {
            let (value, kind, contacts) = P::place(&threshold);
            let same = |curve: &&ThresholdCurve<P::State>| {
                curve.kind == kind && curve.contacts == contacts
            };
            if found.iter().filter(same).any(|curve| passes(curve, value, along, window)) {
                continue;
            }
            let Some(mut curve) = plane.through(&threshold, along) else {
                leave_open(Open::NotFollowed { value });
                continue;
            };
            if matches!(kind, ThresholdKind::Grazing | ThresholdKind::Separation) {
                curve = deciding_part(plane, &threshold, curve, along);
            }
            for point in &mut curve.points {
                point.form = plane.form(kind, point);
            }
            found.push(curve);
        }
    }
    match open.pop() {
        Some(line) if !has_started => Err(line),
        last => {
            open.extend(last);
            Ok(CurvesFound { curves: found, open })
        }
    }
}

/// Whether a curve already passes through a threshold on a line.
fn passes<S>(curve: &ThresholdCurve<S>, value: f64, along: f64, window: (f64, f64)) -> bool {
    let width = window.1 - window.0;
    curve.points.windows(2).any(|pair| {
        let (a, b) = (&pair[0], &pair[1]);
        let share = (along - a.along) / (b.along - a.along);
        let at = share.mul_add(b.value - a.value, a.value);
        let tolerance = (0.1 * (b.value - a.value).abs()).max(1e-3 * width.abs());
        (0.0..=1.0).contains(&share) && (at - value).abs() <= tolerance
    })
}

/// The part of a grazing curve, around the line on which it was found, where the grazing changes the verdict.
fn deciding_part<P: ResponsePlane>(
    plane: &P,
    found: &P::Found,
    curve: ThresholdCurve<P::State>,
    along: f64,
) -> ThresholdCurve<P::State> {
    let decides = |point: &ThresholdCurvePoint<P::State>| {
        let beyond = |side: f64| {
            let value = point.value * (1.0 + side * BEYOND);
            plane.with_events(found, (value, point.along), &point.state)
        };
        beyond(1.0).or_else(|| beyond(-1.0)) != Some(OrbitVerdict::of(point.radius, 0.0))
    };
    let kept: Vec<bool> = curve.points.iter().map(decides).collect();
    part(curve, &kept, along, ThresholdCurveEnd::SameVerdict)
}

/// The part of a curve around a line on which every point is `kept`, with this end where it is cut.
pub(crate) fn part<S>(
    mut curve: ThresholdCurve<S>,
    kept: &[bool],
    along: f64,
    end: ThresholdCurveEnd,
) -> ThresholdCurve<S> {
    let distance = |index: &usize| (curve.points[*index].along - along).abs();
    let nearest = (0..kept.len()).min_by(|a, b| distance(a).total_cmp(&distance(b)));
    let Some(nearest) = nearest else { return curve };
    let first = (0..nearest).rev().find(|index| !kept[*index]).map_or(0, |index| index + 1);
    let last = (nearest + 1..kept.len()).find(|index| !kept[*index]).unwrap_or(kept.len());
    if first > 0 {
        curve.ends[0] = end;
    }
    if last < kept.len() {
        curve.ends[1] = end;
    }
    curve.points.truncate(last);
    curve.points.drain(..first);
    curve
}

/// The curve of a trace, with states of type `S`.
pub(crate) fn threshold_curve<S>(
    kind: ThresholdKind,
    traced: &Traced,
    state: impl Fn(&[f64]) -> S,
) -> ThresholdCurve<S> {
    let point = |point: &BifurcationCurvePoint| ThresholdCurvePoint {
        value: point.parameters[0],
        along: point.parameters[1],
        state: state(&point.state),
        radius: spectral_radius(&point.multipliers),
        form: PointForm { first_lyapunov: Err(NoFirstLyapunov::OtherKind), fold: None },
    };
    ThresholdCurve {
        kind,
        contacts: Vec::new(),
        points: traced.points.iter().map(point).collect(),
        ends: traced.ends.map(ThresholdCurveEnd::of),
    }
}
