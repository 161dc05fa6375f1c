//! Values of a parameter at which the base response of a system gains or loses stability.
//!
//! The response is followed by pseudo-arclength continuation, around folds and through grazings of γ = 0 and N = 0
//! ([`quell_numerics::continuation::branch`]): [`ThresholdKind`] says how.

use quell_linear::criticality::of_steady_sliding;
use quell_linear::pure_slip::period;
use quell_model::System;
use quell_numerics::continuation::branch::{
    BranchSide, FixedPointBranch, Follow, SpecialPoint, follow,
};
use quell_numerics::continuation::criticality::{FirstLyapunov, NoFirstLyapunov, first_lyapunov};
use quell_numerics::continuation::fold::{FoldCoefficient, fold_coefficient};
use quell_numerics::continuation::spectral_radius;
use quell_numerics::continuation::threshold::BifurcationKind;

use super::family::{BorderGuard, MotionSignature, NoImage, OrbitFamily, SystemAt, shot_of};
use super::periodic::{NoOrbit, base_response, scale_of, sliding_state};
use super::threshold_kind::{BranchEnding, ResponseGap, ThresholdKind};
use super::verdict::OrbitVerdict;
use crate::motion::Motion;
use crate::simulation::EventKind;

/// Steps in which the base response is first continued from steady sliding.
const FIRST_STEPS: u32 = 8;

/// Difference of two contacts' distances from their borders, relative to their velocities or loads, up to which they graze together:
/// beyond the error of a distance and far below what two different contacts have in common by chance.
const TOGETHER: f64 = 1e-9;

/// Relative change of a parameter over which a smooth period hardly changes, and one of two frequencies jumps; and the change of a period that
/// counts as a jump. A period is a ratio of a frequency to small whole numbers: it changes by the first, or by a factor.
const PERIOD_STEP: f64 = 1e-7;
const JUMP: f64 = 0.01;

/// A value at which stability changes.
#[derive(Clone, Debug, PartialEq)]
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
    /// Largest modulus of the multipliers on both sides, below and above.
    pub radii: [Option<f64>; 2],
    /// State of the response there.
    pub state: Vec<f64>,
    /// The events of the response there: at a grazing or a separation those of the side on which its contact slips throughout.
    pub signature: MotionSignature,
    /// The contacts that graze or open there, counted from 0: equal contacts may do so together. Empty for other kinds.
    pub contacts: Vec<usize>,
    /// Whether the vibration beyond it grows from zero, by the coefficient of its normal form: per period of the map, and of a
    /// Hopf bifurcation as [`quell_linear::criticality`] gives it. The critical vector has norm 1 over the coordinates.
    pub first_lyapunov: Result<FirstLyapunov, NoFirstLyapunov>,
    /// On which side of a fold two responses exist; `None` for other kinds. The critical vector has norm 1 over the coordinates.
    pub fold: Option<Result<FoldCoefficient, NoFirstLyapunov>>,
}

/// A value at which the events of the response change.
#[derive(Clone, Debug, PartialEq)]
pub struct SignatureChange {
    /// The parameter.
    pub value: f64,
    /// Events for slightly smaller values; `None` without a response.
    pub below: Option<MotionSignature>,
    /// Events for slightly larger values; `None` without a response.
    pub above: Option<MotionSignature>,
}

/// A response on the branch.
#[derive(Clone, Debug, PartialEq)]
pub struct BranchResponse {
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
pub struct BranchThresholds {
    /// Changes of stability, in the order of the branch.
    pub thresholds: Vec<Threshold>,
    /// Changes of the events, in the order of the branch.
    pub changes: Vec<SignatureChange>,
    /// Intervals in which no response was found, up to the first turn of the branch, in its order.
    pub gaps: Vec<ResponseGap>,
    /// The computed responses, in the order of the branch.
    pub branch: Vec<BranchResponse>,
    /// How the branch ends.
    pub ending: BranchEnding,
}

/// Thresholds of the base response, or of the orbit of `periods` common periods near a state, followed from one value of a
/// parameter to another in at least `steps` steps.
///
/// # Errors
/// [`NoOrbit`] if there is no such response at the first value.
pub fn branch_thresholds(
    at: &SystemAt<'_>,
    from: f64,
    to: f64,
    steps: u32,
    near: Option<(&[f64], u32)>,
) -> Result<BranchThresholds, NoOrbit> {
    let invalid = |why| NoOrbit::NoImage(NoImage::Invalid(why));
    let first = at(&[from]).map_err(invalid)?;
    at(&[to]).map_err(invalid)?;
    if period_jumps(at, &first, from, to) {
        return Err(NoOrbit::NoImage(NoImage::PeriodJumps));
    }
    let (state, periods) = match near {
        Some((state, periods)) => (state.to_vec(), periods.max(1)),
        None => (first_state(&first)?, 1),
    };
    let motion = Motion::new(&first).map_err(NoOrbit::Immobile)?;
    let scale = scale_of(&motion, &state);
    let family = OrbitFamily { at, periods, size: state.len(), scale };
    let branch = follow(&family, &state, from, to > from, Follow::window(from, to, steps))?;
    let mut thresholds = Vec::new();
    for point in &branch.special_points {
        let was = verdict(&branch, point, Side::Below);
        let becomes = verdict(&branch, point, Side::Above);
        if was == becomes {
            continue;
        }
        let border = border_of(&family, point);
        let kind = match kind_of(point, border.as_ref()) {
            ThresholdKind::NeimarkSacker if !first.has_waves() => ThresholdKind::Hopf,
            kind => kind,
        };
        let sides = [&point.below, &point.above].map(|side| side.as_ref());
        let Some(side) = sides.into_iter().flatten().next() else { continue };
        let (signature, contacts) = match border {
            Some(border) => (border.signature, border.contacts),
            None => (side.signature.clone(), Vec::new()),
        };
        thresholds.push(Threshold {
            value: point.parameter,
            error: point.error,
            kind,
            becomes,
            was,
            radii: [&point.below, &point.above].map(|side| side.as_ref().map(|side| side.radius)),
            state: point.state.clone(),
            signature,
            contacts,
            first_lyapunov: criticality(&family, kind, &point.state, &[point.parameter]),
            fold: fold_of(&family, kind, &point.state, &[point.parameter], (to - from).abs()),
        });
    }
    let changes = branch.special_points.iter().filter_map(signature_change).collect();
    // Beyond a turn the branch passes values at which it was known before.
    let gaps = branch.special_points.iter().take_while(|point| !point.is_turn());
    let gaps = gaps.filter_map(|point| ResponseGap::of(point.parameter, point.gap)).collect();
    let ending = BranchEnding::of(&branch, from, to);
    let branch = branch.points.iter().map(|point| BranchResponse {
        value: point.parameter,
        state: point.state.clone(),
        radius: spectral_radius(&point.multipliers),
        signature: point.signature.clone(),
    });
    Ok(BranchThresholds { thresholds, changes, gaps, branch: branch.collect(), ending })
}

/// Whether the period of the dithers has no derivative in the parameter: that of two frequencies, one of which varies.
fn period_jumps(at: &SystemAt<'_>, first: &System, from: f64, to: f64) -> bool {
    let step = (PERIOD_STEP * from.abs()).copysign(to - from);
    let (Some(here), Ok(next)) = (period(first), at(&[from + step])) else { return false };
    period(&next).is_none_or(|next| (next / here - 1.0).abs() > JUMP)
}

fn first_state(system: &System) -> Result<Vec<f64>, NoOrbit> {
    match base_response(system, FIRST_STEPS) {
        Ok(orbit) => Ok(orbit.state),
        Err(NoOrbit::NoDither) => sliding_state(system).map_err(NoOrbit::NoSliding),
        Err(why) => Err(why),
    }
}

fn signature_change(point: &SpecialPoint<MotionSignature>) -> Option<SignatureChange> {
    let signature = |side: &Option<BranchSide<MotionSignature>>| {
        side.as_ref().map(|side| side.signature.clone())
    };
    let (below, above) = (signature(&point.below), signature(&point.above));
    let is_contact = matches!(point.kind, BifurcationKind::Grazing | BifurcationKind::Border);
    let value = point.parameter;
    (is_contact && below != above).then_some(SignatureChange { value, below, above })
}

/// A side of a special point.
#[derive(Clone, Copy, PartialEq)]
enum Side {
    Below,
    Above,
}

/// The verdict on a side of a special point. Where multipliers tend to the unit circle at the point itself, as those of a stick do whose
/// surface stops, it is that of the nearest response on that side, if nothing else changes up to it.
fn verdict(
    branch: &FixedPointBranch<MotionSignature>,
    point: &SpecialPoint<MotionSignature>,
    on: Side,
) -> Option<OrbitVerdict> {
    let side = if on == Side::Below { &point.below } else { &point.above }.as_ref()?;
    let verdict = OrbitVerdict::of(side.radius, 0.0);
    if verdict != OrbitVerdict::Undecided {
        return Some(verdict);
    }
    let away = |value: f64| match on {
        Side::Below => point.parameter - value,
        Side::Above => value - point.parameter,
    };
    let special = branch.special_points.iter().map(|other| away(other.parameter));
    let next = special.filter(|away| *away > 0.0).fold(f64::INFINITY, f64::min);
    let decided = branch.points.iter().filter_map(|response| {
        let verdict = OrbitVerdict::of(spectral_radius(&response.multipliers), 0.0);
        let away = away(response.parameter);
        let is_near = away > 0.0 && away < next && response.signature == side.signature;
        (is_near && verdict != OrbitVerdict::Undecided).then_some((away, verdict))
    });
    let nearest = decided.min_by(|a, b| a.0.total_cmp(&b.0));
    Some(nearest.map_or(verdict, |(_, verdict)| verdict))
}

/// The coefficient that decides whether the bifurcation is supercritical.
pub(super) fn criticality(
    family: &OrbitFamily<'_>,
    kind: ThresholdKind,
    state: &[f64],
    parameters: &[f64],
) -> Result<FirstLyapunov, NoFirstLyapunov> {
    let event = kind.event().ok_or(NoFirstLyapunov::OtherKind)?;
    let system = (family.at)(parameters).map_err(|_| NoFirstLyapunov::NotCritical)?;
    if kind == ThresholdKind::Hopf {
        return of_steady_sliding(&system);
    }
    first_lyapunov(family, state, parameters, event, system.structure.size())
}

/// The coefficient that decides to which side a fold in the first parameter opens, whose window is `width` wide; `None` for other
/// kinds.
pub(super) fn fold_of(
    family: &OrbitFamily<'_>,
    kind: ThresholdKind,
    state: &[f64],
    parameters: &[f64],
    width: f64,
) -> Option<Result<FoldCoefficient, NoFirstLyapunov>> {
    (kind == ThresholdKind::Fold).then(|| {
        let system = (family.at)(parameters).map_err(|_| NoFirstLyapunov::NotCritical)?;
        fold_coefficient(family, state, parameters, (0, width), system.structure.size())
    })
}

/// The border at which a motion grazes.
struct MotionBorder {
    /// The events on the side on which the contacts slip throughout.
    signature: MotionSignature,
    contacts: Vec<usize>,
    is_load: bool,
}

/// The border of a grazing point; `None` for other points.
fn border_of(
    family: &OrbitFamily<'_>,
    point: &SpecialPoint<MotionSignature>,
) -> Option<MotionBorder> {
    if point.kind != BifurcationKind::Grazing {
        return None;
    }
    let sides = [&point.below, &point.above].into_iter().flatten();
    let met = sides.filter_map(|side| {
        let parameters = [point.parameter];
        let (_, met) = shot_of(family, &point.state, &parameters, &side.signature).ok()?;
        let (guard, nearest) = met.nearest(&side.signature)?;
        let together = |guard_and_distance: &(BorderGuard, f64)| {
            let (other, distance) = guard_and_distance;
            other.is_load == guard.is_load && (distance - nearest).abs() <= TOGETHER
        };
        let contacts = met.distances(&side.signature).filter(together);
        let contacts = contacts.map(|(guard, _)| guard.contact).collect();
        let signature = side.signature.clone();
        Some((nearest.abs(), MotionBorder { signature, contacts, is_load: guard.is_load }))
    });
    met.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, border)| border)
}

/// The kind of a special point: where a contact opens, a separation.
fn kind_of(point: &SpecialPoint<MotionSignature>, border: Option<&MotionBorder>) -> ThresholdKind {
    let opens = |side: Option<&BranchSide<MotionSignature>>| {
        side.map_or(0, |side| side.signature.count(EventKind::Separation))
    };
    match point.kind {
        BifurcationKind::Grazing if border.is_some_and(|border| border.is_load) => {
            ThresholdKind::Separation
        }
        BifurcationKind::Border if opens(point.below.as_ref()) != opens(point.above.as_ref()) => {
            ThresholdKind::Separation
        }
        _ => ThresholdKind::of(point.kind),
    }
}
