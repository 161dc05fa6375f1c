//! Curves of local thresholds in two parameters, by pseudo-arclength continuation.
//!
//! Thresholds are found on a few lines across the second parameter and each is followed to the borders of the window. A
//! threshold on a known curve is not followed again. A curve that crosses none of the lines is missed.
//! The scheme is that of [`quell_numerics::continuation::curve`]; [`threshold_curves`](super::threshold_curves) finds them.

use std::fmt;

use quell_numerics::continuation::criticality::{FirstLyapunov, NoFirstLyapunov};
use quell_numerics::continuation::curve::{
    BifurcationCurve as Traced, BifurcationCurvePoint, CurveEnd,
};
use quell_numerics::continuation::fold::FoldCoefficient;
use quell_numerics::continuation::spectral_radius;
use quell_numerics::interval::RealInterval;

use super::NoOrbit;
use super::threshold_kind::ThresholdKind;

/// A threshold on a curve.
#[derive(Clone, Debug, PartialEq)]
pub struct ThresholdCurvePoint {
    /// The first parameter.
    pub value: f64,
    /// The second parameter.
    pub along: f64,
    /// The state of the response.
    pub state: Vec<f64>,
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
pub struct ThresholdCurve {
    /// The kind of bifurcation.
    pub kind: ThresholdKind,
    /// The contacts that graze or open, counted from 0; empty for other kinds.
    pub contacts: Vec<usize>,
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
#[derive(Clone, Debug, PartialEq)]
pub struct OpenLine {
    /// The second parameter.
    pub along: f64,
    /// The reason.
    pub why: Open,
}

/// Why a line is open.
#[derive(Clone, Debug, PartialEq)]
pub enum Open {
    /// There is no response to start from.
    Begin(NoOrbit),
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

/// Whether a curve already passes through a threshold on a line.
pub(super) fn passes(curve: &ThresholdCurve, value: f64, along: f64, window: RealInterval) -> bool {
    let width = window.width();
    curve.points.windows(2).any(|pair| {
        let (a, b) = (&pair[0], &pair[1]);
        let share = (along - a.along) / (b.along - a.along);
        let at = share.mul_add(b.value - a.value, a.value);
        let tolerance = (0.1 * (b.value - a.value).abs()).max(1e-3 * width.abs());
        (0.0..=1.0).contains(&share) && (at - value).abs() <= tolerance
    })
}

/// The part of a curve around a line on which every point is `kept`, with this end where it is cut.
pub(super) fn part(
    mut curve: ThresholdCurve,
    kept: &[bool],
    along: f64,
    end: ThresholdCurveEnd,
) -> ThresholdCurve {
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

/// The curve of a trace.
pub(super) fn threshold_curve(kind: ThresholdKind, traced: &Traced) -> ThresholdCurve {
    let point = |point: &BifurcationCurvePoint| ThresholdCurvePoint {
        value: point.parameters[0],
        along: point.parameters[1],
        state: point.state.clone(),
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
