//! Curves of a belt's local thresholds in two parameters; `threshold_curve` has the scheme.

use quell_model::Belt;
use quell_numerics::continuation::curve::{Trace, trace};

use super::family::{BeltAt, FamilyParameters, Forced, Signature};
use super::shooting::near;
use super::threshold::{NoThresholds, Threshold, ThresholdKind, criticality, fold_of, local};
pub use super::threshold_curve::{
    CurvesFound, Open, OpenLine, PointForm, ThresholdCurve, ThresholdCurveEnd, ThresholdCurvePoint,
};
use super::threshold_curve::{LineSearched, ResponsePlane, curves_of, threshold_curve};
use super::verdict::OrbitVerdict;
use crate::simulation::Start;

/// Steps of the continuation runs that find the first points.
const STEPS: u32 = 40;

/// The plane of two parameters and their windows.
#[derive(Clone, Copy)]
pub struct ParameterPlane<'a> {
    /// The belt at values of the number whose thresholds are followed and of the number along which they are.
    pub at: BeltAt<'a>,
    /// Window of the first.
    pub window: (f64, f64),
    /// Window of the second.
    pub between: (f64, f64),
}

/// A belt over a plane.
struct BeltPlane<'a> {
    belt: &'a Belt,
    plane: ParameterPlane<'a>,
    points: u32,
}

impl ResponsePlane for BeltPlane<'_> {
    type State = Start;
    type Found = Threshold;
    type Why = NoThresholds;

    fn windows(&self) -> [(f64, f64); 2] {
        [self.plane.window, self.plane.between]
    }

    fn on_line(&self, along: f64) -> Result<LineSearched<Self::Found>, Open> {
        let ParameterPlane { at, window, .. } = self.plane;
        let on_line = |values: &[f64]| at(&[values[0], along]);
        let found = local(&on_line, window.0, window.1, STEPS).map_err(|why| match why {
            NoThresholds::Invalid { .. } => Open::Invalid,
            why => Open::Begin(why),
        })?;
        Ok(LineSearched::new(found.thresholds, found.ending))
    }

    fn place(found: &Self::Found) -> (f64, ThresholdKind, &[usize]) {
        (found.value, found.kind, &[])
    }

    fn form(&self, kind: ThresholdKind, point: &ThresholdCurvePoint) -> PointForm {
        let Self { belt, plane, .. } = *self;
        let forced = Forced { belt, parameters: FamilyParameters::Numbers(plane.at), periods: 1 };
        let at = [point.value, point.along];
        let width = (plane.window.1 - plane.window.0).abs();
        PointForm {
            first_lyapunov: criticality(&forced, kind, point.state, &at),
            fold: fold_of(&forced, kind, point.state, &at, width),
        }
    }

    fn through(&self, found: &Self::Found, along: f64) -> Option<ThresholdCurve> {
        let Self { belt, plane, points } = *self;
        let forced = Forced { belt, parameters: FamilyParameters::Numbers(plane.at), periods: 1 };
        let at = (plane.at)(&[found.value, along])?;
        // A threshold located as a root belongs to the response in pure slip, unless shooting finds another signature.
        let orbit = near(&at, found.state, 1).ok();
        let pure = Signature::PureSlip(1);
        let signature = match (&orbit, found.kind) {
            (_, ThresholdKind::Grazing) | (None, _) => pure,
            (Some(orbit), _) => orbit.signature(),
        };
        let kind = found.kind.event()?;
        let options = Trace::windows(plane.window, plane.between, points);
        let state = [found.state.displacement, found.state.velocity];
        let traced = trace(&forced, kind, &signature, &state, [found.value, along], options)?;
        Some(threshold_curve(found.kind, &traced, Start::of_state))
    }

    fn with_events(
        &self,
        _: &Threshold,
        (value, along): (f64, f64),
        state: &Start,
    ) -> Option<OrbitVerdict> {
        let at = (self.plane.at)(&[value, along])?;
        let orbit = near(&at, *state, 1).ok()?;
        (!orbit.is_pure_slip()).then(|| orbit.verdict())
    }
}

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
    curves_of(&BeltPlane { belt, plane, points }, lines)
}
