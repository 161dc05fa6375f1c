//! Values of a parameter at which the base response of a system gains or loses stability.
//!
//! The response is followed by pseudo-arclength continuation, around folds and through grazings of γ = 0 and N = 0
//! ([`quell_numerics::continuation::branch`]), as for the belt ([`crate::orbit::threshold`]).

use quell_linear::criticality::of_steady_sliding;
use quell_model::System;
use quell_numerics::continuation::branch::{BranchSide, Follow, SpecialPoint, follow};
use quell_numerics::continuation::criticality::{FirstLyapunov, NoFirstLyapunov, first_lyapunov};
use quell_numerics::continuation::spectral_radius;
use quell_numerics::continuation::threshold::BifurcationKind;

use super::super::Motion;
use super::family::{MotionFamily, MotionSignature, SystemAt, shot, time_of};
use super::periodic::{NoMotionOrbit, base_motion, scale_of, sliding_state};
use crate::orbit::OrbitVerdict;
use crate::orbit::threshold::{BranchEnding, ThresholdKind};
use crate::simulation::EventKind;

/// Steps in which the base response is first continued from steady sliding.
const FIRST_STEPS: u32 = 8;

/// A value at which stability changes.
#[derive(Clone, Debug, PartialEq)]
pub struct MotionThreshold {
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
    /// Largest modulus of the multipliers on both sides, below and above.
    pub radii: [Option<f64>; 2],
    /// State of the response there.
    pub state: Vec<f64>,
    /// Whether the vibration beyond it grows from zero, by the coefficient of its normal form: per period of the map, and of a
    /// Hopf bifurcation as [`quell_linear::criticality`] gives it. The critical vector has norm 1 over the coordinates.
    pub first_lyapunov: Result<FirstLyapunov, NoFirstLyapunov>,
}

/// A response on the branch.
#[derive(Clone, Debug, PartialEq)]
pub struct MotionBranchPoint {
    /// The parameter.
    pub value: f64,
    /// State at t = 0.
    pub state: Vec<f64>,
    /// Largest modulus of its multipliers.
    pub radius: f64,
    /// The sequence of its events.
    pub signature: MotionSignature,
}

/// The thresholds in an interval, and the branch that contains them.
#[derive(Clone, Debug, PartialEq)]
pub struct MotionThresholds {
    /// Changes of stability, in the order of the branch.
    pub thresholds: Vec<MotionThreshold>,
    /// The computed responses, in the order of the branch.
    pub branch: Vec<MotionBranchPoint>,
    /// How the branch ends.
    pub ending: BranchEnding,
}

/// Thresholds of the base response, or of the orbit of `periods` common periods near a state, followed from one value of a
/// parameter to another in at least `steps` steps.
///
/// # Errors
/// [`NoMotionOrbit`] if there is no such response at the first value.
pub fn motion_thresholds(
    at: &SystemAt<'_>,
    (from, to): (f64, f64),
    steps: u32,
    near: Option<(&[f64], u32)>,
) -> Result<MotionThresholds, NoMotionOrbit> {
    let invalid = |why| NoMotionOrbit::NoImage(super::family::NoImage::Invalid(why));
    let first = at(&[from]).map_err(invalid)?;
    at(&[to]).map_err(invalid)?;
    let (state, periods) = match near {
        Some((state, periods)) => (state.to_vec(), periods.max(1)),
        None => (first_state(&first)?, 1),
    };
    let motion = Motion::new(&first).map_err(NoMotionOrbit::Immobile)?;
    let scale = scale_of(&motion, &state);
    let family = MotionFamily { at, periods, size: state.len(), scale };
    let branch = follow(&family, &state, from, to > from, Follow::window(from, to, steps))?;
    let mut thresholds = Vec::new();
    for point in &branch.special_points {
        let (was, becomes) = (verdict(point.below.as_ref()), verdict(point.above.as_ref()));
        if was == becomes {
            continue;
        }
        let kind = match kind_of(&family, point) {
            ThresholdKind::NeimarkSacker if !first.has_waves() => ThresholdKind::Hopf,
            kind => kind,
        };
        thresholds.push(MotionThreshold {
            value: point.parameter,
            error: point.error,
            kind,
            becomes,
            was,
            radii: [&point.below, &point.above].map(|side| side.as_ref().map(|side| side.radius)),
            state: point.state.clone(),
            first_lyapunov: criticality(&family, point, kind),
        });
    }
    let ending = BranchEnding::of(&branch, from, to);
    let branch = branch.points.iter().map(|point| MotionBranchPoint {
        value: point.parameter,
        state: point.state.clone(),
        radius: spectral_radius(&point.multipliers),
        signature: point.signature.clone(),
    });
    Ok(MotionThresholds { thresholds, branch: branch.collect(), ending })
}

fn first_state(system: &System) -> Result<Vec<f64>, NoMotionOrbit> {
    match base_motion(system, FIRST_STEPS) {
        Ok(orbit) => Ok(orbit.state),
        Err(NoMotionOrbit::NoDither) => sliding_state(system).map_err(NoMotionOrbit::NoSliding),
        Err(why) => Err(why),
    }
}

fn verdict(side: Option<&BranchSide<MotionSignature>>) -> Option<OrbitVerdict> {
    side.map(|side| OrbitVerdict::of(side.radius, 0.0))
}

/// The coefficient that decides whether the bifurcation is supercritical.
fn criticality(
    family: &MotionFamily<'_>,
    point: &SpecialPoint<MotionSignature>,
    kind: ThresholdKind,
) -> Result<FirstLyapunov, NoFirstLyapunov> {
    let parameters = [point.parameter];
    let system = (family.at)(&parameters).map_err(|_| NoFirstLyapunov::NotCritical)?;
    if kind == ThresholdKind::Hopf {
        return of_steady_sliding(&system);
    }
    first_lyapunov(family, &point.state, &parameters, point.kind, system.structure.size())
}

/// The kind of a special point: where a contact opens, a separation.
fn kind_of(family: &MotionFamily<'_>, point: &SpecialPoint<MotionSignature>) -> ThresholdKind {
    let kind = ThresholdKind::of(point.kind);
    let opens = |side: Option<&BranchSide<MotionSignature>>| {
        side.map_or(0, |side| side.signature.count(EventKind::Separation))
    };
    match point.kind {
        BifurcationKind::Grazing if nearest_is_load(family, point) => ThresholdKind::Separation,
        BifurcationKind::Border if opens(point.below.as_ref()) != opens(point.above.as_ref()) => {
            ThresholdKind::Separation
        }
        _ => kind,
    }
}

/// Whether the border that a motion in pure slip reaches is that of a load.
fn nearest_is_load(family: &MotionFamily<'_>, point: &SpecialPoint<MotionSignature>) -> bool {
    let Ok(system) = (family.at)(&[point.parameter]) else { return false };
    let Ok(motion) = Motion::new(&system) else { return false };
    let slips = [&point.below, &point.above]
        .into_iter()
        .flatten()
        .map(|side| &side.signature)
        .find(|signature| signature.is_pure_slip());
    let time = time_of(&motion, family.periods);
    time.and_then(|time| shot(&motion, &point.state, time, slips))
        .is_ok_and(|(_, met)| met.least.is_some_and(|least| least.is_load))
}
