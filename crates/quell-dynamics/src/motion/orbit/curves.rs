//! Curves of the thresholds of a system in two parameters: the scheme of [`crate::orbit::curve`] for belts.
//!
//! The curve of a grazing or a separation is that of one contact, whose least slip velocity or load is zero along it, regardless of the
//! events of the others; contacts that graze together have one curve. It ends where another contact grazes or opens first. A curve of
//! multipliers ends where another multiplier leaves the unit circle.

use quell_model::System;
use quell_numerics::continuation::criticality::NoFirstLyapunov;
use quell_numerics::continuation::curve::{BifurcationCurvePoint, Trace, trace};
use quell_numerics::continuation::threshold::BifurcationKind;
use quell_numerics::continuation::{Image, PeriodMap, modulus};

use super::super::Motion;
use super::family::{BorderGuard, MotionFamily, MotionSignature, NoImage, Shot, SystemAt, shot_of};
use super::periodic::{NoMotionOrbit, motion_near, scale_of};
use super::thresholds::{MotionThreshold, criticality, fold_of, motion_thresholds};
use crate::orbit::OrbitVerdict;
use crate::orbit::threshold::ThresholdKind;
use crate::orbit::threshold_curve::{
    CurvesFound, LineSearched, Open, OpenLine, PointForm, ResponsePlane, ThresholdCurve,
    ThresholdCurveEnd, ThresholdCurvePoint, curves_of, part, threshold_curve,
};

/// Steps of the continuation runs that find the first points, at least. More find pairs of thresholds that lie closer together.
const STEPS: u32 = 40;

/// Modulus of a multiplier that counts as outside the unit circle: the critical one is on it up to its error, which is far smaller. With a
/// smaller excess that error would end a curve; with a larger one a curve would go on a little beyond a crossing.
const OUTSIDE: f64 = 1.0 + 1e-5;

/// Modulus of a further multiplier at the end of a curve from which on that multiplier ends it: the last point lies up to a step before the
/// crossing. It decides only which reason for the end is given.
const ABOUT_TO_LEAVE: f64 = 0.99;

/// Distance of another contact from its event, relative to its velocity or load, below which that event comes first: beyond the error of
/// a distance. With a value nearer to 0 rounding would end curves; a lower one follows them slightly too far.
const FIRST: f64 = -1e-9;

/// A curve of thresholds of a system.
pub type MotionCurve = ThresholdCurve<Vec<f64>>;

/// The curves of a system, and where curves may be missing.
pub type MotionCurves = CurvesFound<Vec<f64>, NoMotionOrbit>;

/// A system over a plane of two parameters, the first of which has thresholds.
pub struct MotionPlane<'a> {
    /// The system at both parameters.
    pub at: &'a SystemAt<'a>,
    /// Window of the first parameter.
    pub window: (f64, f64),
    /// Window of the second parameter.
    pub between: (f64, f64),
    /// Minimum number of points of a curve across either window.
    pub points: u32,
}

/// Every curve of thresholds of a system's base response that crosses one of `lines` lines across the second parameter.
///
/// # Errors
/// The last line, if no line has a base response to start from.
pub fn motion_curves(
    plane: &MotionPlane<'_>,
    lines: u32,
) -> Result<MotionCurves, OpenLine<NoMotionOrbit>> {
    curves_of(plane, lines)
}

impl MotionPlane<'_> {
    fn system(&self, value: f64, along: f64) -> Option<System> {
        (self.at)(&[value, along]).ok()
    }

    fn family(&self, system: &System, state: &[f64]) -> Option<MotionFamily<'_>> {
        let scale = scale_of(&Motion::new(system).ok()?, state);
        Some(MotionFamily { at: self.at, periods: 1, size: state.len(), scale })
    }

    fn trace_options(&self) -> Trace {
        Trace::windows(self.window, self.between, self.points)
    }

    /// The curve of a multiplier.
    fn of_multiplier(
        &self,
        found: &MotionThreshold,
        kind: BifurcationKind,
        along: f64,
    ) -> Option<MotionCurve> {
        let MotionThreshold { value, state, kind: name, signature, .. } = found;
        let system = self.system(*value, along)?;
        let family = self.family(&system, state)?;
        let at = [*value, along];
        let traced = trace(&family, kind, signature, state, at, self.trace_options())?;
        let mut curve = threshold_curve(*name, &traced, <[f64]>::to_vec);
        // Where two thresholds cross, the test function has a double root, at which the trace may end.
        let critical = if kind == BifurcationKind::NeimarkSacker { 2 } else { 1 };
        for (end, point) in curve.ends.iter_mut().zip([traced.points.first(), traced.points.last()])
        {
            let near = |point: &BifurcationCurvePoint| {
                point.multipliers.iter().filter(|z| modulus(**z) > ABOUT_TO_LEAVE).count()
                    > critical
            };
            if *end == ThresholdCurveEnd::Lost && point.is_some_and(near) {
                *end = ThresholdCurveEnd::Crossing;
            }
        }
        let kept: Vec<bool> = curve.points.iter().map(|point| point.radius <= OUTSIDE).collect();
        Some(part(curve, &kept, along, ThresholdCurveEnd::Crossing))
    }

    /// The curve on which one contact grazes or opens.
    fn of_contact(&self, found: &MotionThreshold, along: f64) -> Option<MotionCurve> {
        let MotionThreshold { value, state, kind, signature, contacts, .. } = found;
        let system = self.system(*value, along)?;
        let family = self.family(&system, state)?;
        let is_load = *kind == ThresholdKind::Separation;
        let guards = contacts.iter().map(|contact| BorderGuard { contact: *contact, is_load });
        let guarded = GuardedFamily { family, guards: guards.collect() };
        let options = self.trace_options();
        let grazing = BifurcationKind::Grazing;
        let traced = trace(&guarded, grazing, signature, state, [*value, along], options)?;
        let mut curve = threshold_curve(*kind, &traced, <[f64]>::to_vec);
        curve.contacts.clone_from(contacts);
        let kept = curve.points.iter().map(|point| {
            let at = [point.value, point.along];
            let met = shot_of(&guarded.family, &point.state, &at, signature);
            met.is_ok_and(|(_, met)| guarded.is_first(&met, signature))
        });
        let kept: Vec<bool> = kept.collect();
        Some(part(curve, &kept, along, ThresholdCurveEnd::Crossing))
    }
}

impl ResponsePlane for MotionPlane<'_> {
    type State = Vec<f64>;
    type Found = MotionThreshold;
    type Why = NoMotionOrbit;

    fn windows(&self) -> [(f64, f64); 2] {
        [self.window, self.between]
    }

    fn on_line(&self, along: f64) -> Result<LineSearched<MotionThreshold>, Open<NoMotionOrbit>> {
        let at = |values: &[f64]| (self.at)(&[values[0], along]);
        let found = motion_thresholds(&at, self.window, STEPS, None).map_err(Open::Begin)?;
        Ok(LineSearched::new(found.thresholds, found.ending))
    }

    fn place(found: &MotionThreshold) -> (f64, ThresholdKind, &[usize]) {
        (found.value, found.kind, &found.contacts)
    }

    fn form(&self, kind: ThresholdKind, point: &ThresholdCurvePoint<Vec<f64>>) -> PointForm {
        let at = [point.value, point.along];
        let family =
            self.system(at[0], at[1]).and_then(|system| self.family(&system, &point.state));
        let Some(family) = family else {
            let first_lyapunov = Err(NoFirstLyapunov::NotCritical);
            return PointForm { first_lyapunov, fold: None };
        };
        let width = (self.window.1 - self.window.0).abs();
        PointForm {
            first_lyapunov: criticality(&family, kind, &point.state, &at),
            fold: fold_of(&family, kind, &point.state, &at, width),
        }
    }

    fn through(&self, found: &MotionThreshold, along: f64) -> Option<MotionCurve> {
        match found.kind {
            // A signature that changes without a grazing, and a branching, have no test function.
            _ if found.kind == ThresholdKind::Separation && found.contacts.is_empty() => None,
            ThresholdKind::Grazing | ThresholdKind::Separation => self.of_contact(found, along),
            kind => self.of_multiplier(found, kind.event()?, along),
        }
    }

    fn with_events(
        &self,
        found: &MotionThreshold,
        (value, along): (f64, f64),
        state: &Vec<f64>,
    ) -> Option<OrbitVerdict> {
        let orbit = motion_near(&self.system(value, along)?, state, 1).ok()?;
        (orbit.signature != found.signature).then(|| orbit.verdict())
    }
}

/// A family whose distance is that of one contact from one of its events, or of contacts that graze together.
pub(super) struct GuardedFamily<'a> {
    pub(super) family: MotionFamily<'a>,
    pub(super) guards: Vec<BorderGuard>,
}

impl GuardedFamily<'_> {
    /// Whether no other contact that slips throughout has an event before this one.
    fn is_first(&self, met: &Shot, signature: &MotionSignature) -> bool {
        let others = met.distances(signature).filter(|(guard, _)| !self.guards.contains(guard));
        others.fold(f64::INFINITY, |least, (_, distance)| least.min(distance)) >= FIRST
    }
}

impl PeriodMap for GuardedFamily<'_> {
    type Signature = MotionSignature;
    type Error = NoImage;

    fn dimension(&self) -> usize {
        self.family.dimension()
    }

    fn scale(&self) -> f64 {
        self.family.scale()
    }

    fn image(
        &self,
        state: &[f64],
        parameters: &[f64],
        held: Option<&MotionSignature>,
    ) -> Result<Image<MotionSignature>, NoImage> {
        let Some(held) = held else { return self.family.image(state, parameters, held) };
        let (image, met) = shot_of(&self.family, state, parameters, held)?;
        // Distances are relative, and a family's distance is a length. That of one contact is smooth where several graze together.
        let own = |guard: &BorderGuard| met.approaches[guard.contact][usize::from(guard.is_load)];
        let distance = self.guards.first().map_or(f64::INFINITY, own) * self.scale();
        Ok(Image { distance, ..image })
    }
}
