//! Curves of the thresholds of a system in two parameters.
//!
//! Thresholds are found on a few lines across the second parameter and each is followed to the borders of the window. A threshold on a
//! known curve is not followed again. A curve that crosses none of the lines is missed.
//!
//! The curve of a grazing or a separation is that of one contact, whose least slip velocity or load is zero along it, regardless of the
//! events of the others; contacts that graze together have one curve. It ends where another contact grazes or opens first. A curve of
//! multipliers ends where another multiplier leaves the unit circle.

use quell_model::System;
use quell_numerics::continuation::criticality::NoFirstLyapunov;
use quell_numerics::continuation::curve::{BifurcationCurvePoint, Trace, trace};
use quell_numerics::continuation::threshold::BifurcationKind;
use quell_numerics::continuation::{Image, PeriodMap};
use quell_numerics::interval::RealInterval;
use quell_numerics::polar::modulus;

use super::family::{BorderGuard, MotionSignature, NoImage, OrbitFamily, Shot, SystemAt, shot_of};
use super::periodic::{near, scale_of};
use super::threshold_curve::{
    CurvesFound, Open, OpenLine, PointForm, ThresholdCurve, ThresholdCurveEnd, ThresholdCurvePoint,
    part, passes, threshold_curve,
};
use super::threshold_kind::{BranchEnding, ThresholdKind};
use super::thresholds::{Threshold, branch_thresholds, criticality, fold_of};
use super::verdict::OrbitVerdict;
use crate::motion::Motion;

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

/// Distance beyond a grazing, relative to the parameter, at which the response with contact events is evaluated.
const BEYOND: f64 = 1e-5;

/// A system over a plane of two parameters, the first of which has thresholds.
pub struct ThresholdPlane<'a> {
    /// The system at both parameters.
    pub at: &'a SystemAt<'a>,
    /// Window of the first parameter.
    pub window: RealInterval,
    /// Window of the second parameter.
    pub between: RealInterval,
    /// Minimum number of points of a curve across either window.
    pub points: u32,
}

/// Every curve of thresholds of a system's base response that crosses one of `lines` lines across the second parameter.
///
/// # Errors
/// The last line, if no line has a base response to start from.
pub fn threshold_curves(plane: &ThresholdPlane<'_>, lines: u32) -> Result<CurvesFound, OpenLine> {
    let (window, RealInterval { lower: first, upper: last }) = (plane.window, plane.between);
    let lines = lines.max(1);
    let mut found: Vec<ThresholdCurve> = Vec::new();
    let mut open: Vec<OpenLine> = Vec::new();
    let mut has_started = false;
    // Lines are inside the window, so that no curve starts on its border.
    for line in 0..lines {
        let along = first + (last - first) * (f64::from(line) + 0.5) / f64::from(lines);
        let mut leave_open = |why| open.push(OpenLine { along, why });
        let on_line = |values: &[f64]| (plane.at)(&[values[0], along]);
        let searched = match branch_thresholds(&on_line, window.lower, window.upper, STEPS, None) {
            Ok(searched) => searched,
            Err(why) => {
                leave_open(Open::Begin(why));
                continue;
            }
        };
        has_started = true;
        if let BranchEnding::Lost { at } | BranchEnding::LostTurning { at, .. } = searched.ending {
            leave_open(Open::Lost { at });
        }
        for threshold in searched.thresholds {
            let (value, kind, contacts) = (threshold.value, threshold.kind, &threshold.contacts);
            let same = |curve: &&ThresholdCurve| curve.kind == kind && curve.contacts == *contacts;
            if found.iter().filter(same).any(|curve| passes(curve, value, along, window)) {
                continue;
            }
            let Some(mut curve) = plane.through(&threshold, along) else {
                leave_open(Open::NotFollowed { value });
                continue;
            };
            if matches!(kind, ThresholdKind::Grazing | ThresholdKind::Separation) {
                curve = plane.deciding_part(&threshold, curve, along);
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

impl ThresholdPlane<'_> {
    fn system(&self, value: f64, along: f64) -> Option<System> {
        (self.at)(&[value, along]).ok()
    }

    fn family(&self, system: &System, state: &[f64]) -> Option<OrbitFamily<'_>> {
        let scale = scale_of(&Motion::new(system).ok()?, state);
        Some(OrbitFamily { at: self.at, periods: 1, size: state.len(), scale })
    }

    fn trace_options(&self) -> Trace {
        Trace::windows(self.window, self.between, self.points)
    }

    /// The curve of a multiplier.
    fn of_multiplier(
        &self,
        found: &Threshold,
        kind: BifurcationKind,
        along: f64,
    ) -> Option<ThresholdCurve> {
        let Threshold { value, state, kind: name, signature, .. } = found;
        let system = self.system(*value, along)?;
        let family = self.family(&system, state)?;
        let at = [*value, along];
        let traced = trace(&family, kind, signature, state, at, self.trace_options())?;
        let mut curve = threshold_curve(*name, &traced);
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
    fn of_contact(&self, found: &Threshold, along: f64) -> Option<ThresholdCurve> {
        let Threshold { value, state, kind, signature, contacts, .. } = found;
        let system = self.system(*value, along)?;
        let family = self.family(&system, state)?;
        let is_load = *kind == ThresholdKind::Separation;
        let guards = contacts.iter().map(|contact| BorderGuard { contact: *contact, is_load });
        let guarded = GuardedFamily { family, guards: guards.collect() };
        let options = self.trace_options();
        let grazing = BifurcationKind::Grazing;
        let traced = trace(&guarded, grazing, signature, state, [*value, along], options)?;
        let mut curve = threshold_curve(*kind, &traced);
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

impl ThresholdPlane<'_> {
    /// What the normal form at a point of a curve of this kind says.
    fn form(&self, kind: ThresholdKind, point: &ThresholdCurvePoint) -> PointForm {
        let at = [point.value, point.along];
        let family =
            self.system(at[0], at[1]).and_then(|system| self.family(&system, &point.state));
        let Some(family) = family else {
            let first_lyapunov = Err(NoFirstLyapunov::NotCritical);
            return PointForm { first_lyapunov, fold: None };
        };
        let width = self.window.width().abs();
        PointForm {
            first_lyapunov: criticality(&family, kind, &point.state, &at),
            fold: fold_of(&family, kind, &point.state, &at, width),
        }
    }

    /// The part of a grazing curve, around the line on which it was found, where the grazing changes the verdict.
    fn deciding_part(
        &self,
        found: &Threshold,
        curve: ThresholdCurve,
        along: f64,
    ) -> ThresholdCurve {
        let decides = |point: &ThresholdCurvePoint| {
            let beyond = |side: f64| {
                let value = point.value * (1.0 + side * BEYOND);
                self.with_events(found, (value, point.along), &point.state)
            };
            beyond(1.0).or_else(|| beyond(-1.0)) != Some(OrbitVerdict::of(point.radius, 0.0))
        };
        let kept: Vec<bool> = curve.points.iter().map(decides).collect();
        part(curve, &kept, along, ThresholdCurveEnd::SameVerdict)
    }

    /// The curve through a threshold, to the borders of the windows.
    fn through(&self, found: &Threshold, along: f64) -> Option<ThresholdCurve> {
        match found.kind {
            // A signature that changes without a grazing, and a branching, have no test function.
            _ if found.kind == ThresholdKind::Separation && found.contacts.is_empty() => None,
            ThresholdKind::Grazing | ThresholdKind::Separation => self.of_contact(found, along),
            kind => self.of_multiplier(found, kind.event()?, along),
        }
    }

    /// The verdict on the response with further events near a state on the curve of a grazing, at values of both parameters; `None` if
    /// no such response exists.
    fn with_events(
        &self,
        found: &Threshold,
        (value, along): (f64, f64),
        state: &[f64],
    ) -> Option<OrbitVerdict> {
        let orbit = near(&self.system(value, along)?, state, 1).ok()?;
        (orbit.signature != found.signature).then(|| orbit.verdict())
    }
}

/// A family whose distance is that of one contact from one of its events, or of contacts that graze together.
pub(super) struct GuardedFamily<'a> {
    pub(super) family: OrbitFamily<'a>,
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
