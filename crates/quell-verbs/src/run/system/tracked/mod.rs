//! `stability --parameter`: eigenvalues of a system followed over a parameter, its thresholds, and their curves along a second one.

mod answer;

use std::cell::RefCell;

use quell_linear::averaging::{AveragingError, DitheredSystem};
use quell_linear::criticality::first_lyapunov;
use quell_linear::linearised::{FrictionSlopes, Linearised};
use quell_linear::steady::NoSteadySliding;
use quell_linear::tracking::{Family, StabilityChange, ThresholdOfStability, Tracked, track};
use quell_model::RefusedNumbers;
use quell_model::parameter::NORMAL_LOAD;
use quell_numerics::continuation::criticality::NoFirstLyapunov;
use quell_numerics::eigen::EigenError;
use quell_numerics::interval::RealInterval;
use quell_numerics::matrix::Matrix;
use quell_numerics::order::ascending_by;
use quell_numerics::roots::{Closeness, find_root};

use super::validity::ContactRanges;
use super::{failed, has_equations};
use crate::complaint::{Complaint, Failure};
use crate::reasons::reasons;
use crate::run::criticality::{FoundLyapunov, NoLyapunovCoefficient};
use crate::run::varied::{OF_THE_EQUATIONS, not_a_peak, number_meant};
use crate::study::{Model, ParameterId, SystemStudy};

/// Values of the parameter at which eigenvalues are computed at least.
const POINTS: usize = 129;

/// Values of the first parameter on each line of a curve.
const POINTS_OF_A_LINE: usize = 33;

/// Lines across the second parameter.
const LINES: usize = 81;

/// Two thresholds of neighbouring lines belong to one curve if they are closer than this share of the window.
const LINKED: f64 = 0.1;

/// What to follow.
#[derive(Clone, Debug, PartialEq)]
pub struct TrackRequest {
    /// Path of the parameter.
    pub parameter: String,
    /// Its window in the unit of that key.
    pub window: RealInterval,
    /// A second parameter and its window, along which thresholds are followed.
    pub along: Option<(String, RealInterval)>,
}

/// A curve of thresholds: (second parameter, threshold), ascending.
#[derive(Clone, Debug, PartialEq)]
pub struct StabilityCurve {
    /// Its points.
    pub points: Vec<(f64, ThresholdOfStability)>,
    /// For each point the first Lyapunov coefficient, or the reason why it is unknown.
    pub first_lyapunov: Vec<FoundLyapunov>,
}

/// Eigenvalues over a parameter.
#[derive(Clone, Debug)]
pub struct TrackedStability {
    /// The request.
    pub request: TrackRequest,
    /// Whether the verdicts are those of averaging.
    pub averaged: bool,
    /// The eigenvalues and thresholds over the window.
    pub tracked: Tracked<NoStateMatrix>,
    /// Where surfaces come to rest in the window, ascending.
    pub rests: Vec<SurfaceAtRest>,
    /// For each threshold of the window the first Lyapunov coefficient, or the reason why it is unknown.
    pub first_lyapunov: Vec<FoundLyapunov>,
    /// Curves along the second parameter; empty without one.
    pub curves: Vec<StabilityCurve>,
    /// Where contacts open or leave the range of their law: in the window, and over the second parameter.
    pub contacts: [ContactRanges; 2],
}

/// The state matrices of a study over one of its numbers, others fixed.
struct StudyFamily<'a> {
    model: &'a Model,
    parameter: ParameterId,
    fixed: Option<(ParameterId, f64)>,
    recorded: &'a RefCell<ContactRanges>,
    /// Where surfaces come to rest in the window.
    rests: Vec<SurfaceAtRest>,
}

reasons! {
    /// Why a study has no eigenvalues at a value of a parameter.
    pub enum NoStateMatrix {
        /// There is no study with the value.
        Refused(RefusedNumbers),
        /// There is no average.
        NoAverage(AveragingError),
        /// There is no steady sliding.
        NoSliding(NoSteadySliding),
        /// The eigenvalues are unknown.
        Eigenvalues(EigenError),
        ;
    }
}

impl Family for StudyFamily<'_> {
    type Error = NoStateMatrix;

    fn matrix(&self, value: f64) -> Result<Matrix, NoStateMatrix> {
        let varied = (self.parameter.clone(), value);
        let numbers: Vec<_> = self.fixed.iter().cloned().chain([varied]).collect();
        let at = self.fixed.as_ref().map_or(value, |(_, along)| *along);
        let system = self.model.at(&numbers).map_err(RefusedNumbers::by_study)?;
        if system.is_dithered() {
            let average = DitheredSystem::new(&system)?.average()?;
            ContactRanges::add(self.recorded, at, &system, Some(&average.contacts));
            return Ok(average.linear.state_matrix_with(&average.friction));
        }
        let linear = Linearised::new(&system)?;
        ContactRanges::add(self.recorded, at, &system, None);
        // Where dither may be averaged, bristles follow the slip at once, with dither and without.
        let at_once = !system.inputs.is_empty();
        let slopes = linear.friction().into_iter();
        let slopes: Vec<FrictionSlopes> =
            slopes.map(|slope| if at_once { slope.at_once() } else { slope }).collect();
        Ok(linear.state_matrix_with(&slopes))
    }

    fn overflows(why: EigenError) -> NoStateMatrix {
        why.into()
    }

    fn gaps(&self) -> Vec<(f64, NoStateMatrix)> {
        let why = |contact: &str| NoSteadySliding::AtRest { contact: contact.to_owned() };
        self.rests.iter().map(|rest| (rest.value, why(&rest.contact).into())).collect()
    }
}

/// A value of the parameter at which the surface of a contact comes to rest and its velocity changes its sign: friction reverses
/// there, and at the value itself there is no steady sliding.
#[derive(Clone, Debug, PartialEq)]
pub struct SurfaceAtRest {
    /// The parameter.
    pub value: f64,
    /// Name of the contact.
    pub contact: String,
}

/// Where surfaces come to rest inside a window, ascending.
fn rests(
    study: &SystemStudy,
    (parameter, RealInterval { lower: from, upper: to }): (&ParameterId, RealInterval),
    fixed: Option<&(ParameterId, f64)>,
) -> Vec<SurfaceAtRest> {
    let model = study.model();
    let velocities = |value: f64| -> Option<Vec<f64>> {
        let varied = (parameter.clone(), value);
        let numbers: Vec<_> = fixed.into_iter().cloned().chain([varied]).collect();
        let system = model.at(&numbers).ok()?;
        Some(system.contacts.iter().map(|contact| contact.surface_velocity.mean()).collect())
    };
    let grid = (0..POINTS).map(|k| from + (to - from) * k as f64 / (POINTS - 1) as f64);
    let met: Vec<(f64, Vec<f64>)> =
        grid.filter_map(|value| Some((value, velocities(value)?))).collect();
    let mut found = Vec::new();
    for (index, contact) in study.system().contacts.iter().enumerate() {
        let moving: Vec<RealInterval> = met
            .iter()
            .map(|(value, all)| RealInterval::new(*value, all[index]))
            .filter(|RealInterval { upper: v, .. }| *v != 0.0)
            .collect();
        for pair in moving.windows(2) {
            let [
                RealInterval { lower: low, upper: before },
                RealInterval { lower: high, upper: after },
            ] = [pair[0], pair[1]];
            if before * after > 0.0 {
                continue;
            }
            let velocity = |value: f64| velocities(value).map_or(f64::NAN, |all| all[index]);
            let closeness = Closeness { absolute: 1e-12 * (to - from), relative: 0.0 };
            let Ok(root) = find_root(velocity, low, high, closeness) else { continue };
            found.push(SurfaceAtRest { value: root.location, contact: contact.name.clone() });
        }
    }
    ascending_by(&mut found, |a| a.value);
    found
}

/// Follows the eigenvalues of a study.
///
/// # Errors
/// Complaints about the parameters and their windows; [`Failure::Failed`] if no value of the window has steady sliding.
pub fn run(study: &SystemStudy, request: &TrackRequest) -> Result<TrackedStability, Failure> {
    has_equations(study, "stability --parameter")?;
    understood(study, request)?;
    let model = study.model();
    let parameter = model.parameter(&request.parameter)?;
    let along = request.along.as_ref();
    let along = along.map(|(path, ends)| Ok::<_, Failure>((model.parameter(path)?, *ends)));
    let along = along.transpose()?;
    let recorded = [RefCell::default(), RefCell::default()];
    let family = |fixed: Option<(ParameterId, f64)>| {
        let recorded = &recorded[usize::from(fixed.is_some())];
        let rests = rests(study, (&parameter, request.window), fixed.as_ref());
        StudyFamily { model: &model, parameter: parameter.clone(), fixed, recorded, rests }
    };
    let whole = family(None);
    let tracked = track(&whole, request.window, POINTS);
    let tracked = tracked.map_err(|why| failed("stability", why))?;
    let mut curves = Vec::new();
    if let Some((along, RealInterval { lower: from, upper: to })) = &along {
        let width = request.window.width();
        for k in 0..LINES {
            let value = from + (to - from) * k as f64 / (LINES - 1) as f64;
            let line =
                track(&family(Some((along.clone(), value))), request.window, POINTS_OF_A_LINE);
            let thresholds = line.map_or_else(|_| Vec::new(), |line| line.thresholds);
            let step = (to - from) / (LINES - 1) as f64;
            extend(&mut curves, (value, step), thresholds, width);
        }
    }
    if let Some((along, _)) = &along {
        for curve in &mut curves {
            let points = curve.points.iter();
            let found = points.map(|(at, found)| {
                let numbers = [(along.clone(), *at), (parameter.clone(), found.value)];
                criticality(study, &numbers, found)
            });
            curve.first_lyapunov = found.collect();
        }
    }
    let averaged = study.system().is_dithered();
    let rests = whole.rests;
    let contacts = recorded.map(RefCell::into_inner);
    let first_lyapunov = tracked
        .thresholds
        .iter()
        .map(|found| criticality(study, &[(parameter.clone(), found.value)], found));
    let first_lyapunov = first_lyapunov.collect();
    let request = request.clone();
    Ok(TrackedStability { request, averaged, tracked, rests, first_lyapunov, curves, contacts })
}

/// The first Lyapunov coefficient at a threshold of steady sliding without dither, at these numbers of the study.
fn criticality(
    study: &SystemStudy,
    numbers: &[(ParameterId, f64)],
    found: &ThresholdOfStability,
) -> FoundLyapunov {
    if found.change != StabilityChange::Hopf {
        return Err(NoFirstLyapunov::OtherKind.into());
    }
    let system = study.model().at(numbers).map_err(RefusedNumbers::by_study)?;
    if system.is_dithered() {
        return Err(NoLyapunovCoefficient::OfAverage);
    }
    let linear = Linearised::new(&system)?;
    Ok(first_lyapunov(&system, &linear, found.eigenvalue.im.abs())?)
}

/// Adds the thresholds of a line to the curves that end at the line before.
fn extend(
    curves: &mut Vec<StabilityCurve>,
    (value, step): (f64, f64),
    thresholds: Vec<ThresholdOfStability>,
    width: f64,
) {
    let mut taken = vec![false; curves.len()];
    for found in thresholds {
        let distance = |curve: &StabilityCurve| {
            let (at, last) = curve.points.last()?;
            let follows = (value - at) <= 1.5 * step;
            let same = last.change == found.change && last.verdicts == found.verdicts;
            let distance = (last.value - found.value).abs();
            (follows && same && distance <= LINKED * width).then_some(distance)
        };
        let open = taken.iter().enumerate().filter(|(_, taken)| !**taken);
        let near = open.filter_map(|(index, _)| Some((distance(&curves[index])?, index)));
        if let Some((_, index)) = near.min_by(|a, b| a.0.total_cmp(&b.0)) {
            curves[index].points.push((value, found));
            taken[index] = true;
        } else {
            curves
                .push(StabilityCurve { points: vec![(value, found)], first_lyapunov: Vec::new() });
            taken.push(true);
        }
    }
}

/// The path of the study that is closest to a wrong one.
fn nearest(study: &SystemStudy, path: &str) -> Option<String> {
    study.model().parameter(path).err()?.suggestion
}

/// Every complaint about a request.
pub(in crate::run) fn understood(
    study: &SystemStudy,
    request: &TrackRequest,
) -> Result<(), Failure> {
    let mut wrong = Vec::new();
    let along = request.along.as_ref();
    let along = along.map(|(path, window)| (("--along", "--between", "--between"), path, *window));
    let first = (("--parameter", "--from", "--to"), &request.parameter, request.window);
    for ((option, from, to), path, window) in [Some(first), along].into_iter().flatten() {
        if study.number(path).is_none() {
            let contact = study.system().contacts.first().map_or("NAME", |contact| &contact.name);
            let example = study.path_of(contact, NORMAL_LOAD);
            let allowed = match not_a_peak(path, study.document_kind()) {
                Some(why) => format!("the path of a peak value: {why}"),
                None => format!("the path of a number of the study, such as {example}"),
            };
            let complaint = Complaint::option(option, path.as_str(), allowed);
            let near = nearest(study, path).or_else(|| number_meant(study, path));
            wrong.push(complaint.suggesting(near));
            continue;
        }
        if window.lower.is_nan() || window.upper.is_nan() || window.lower >= window.upper {
            let allowed = format!("a finite number above {from} {}", window.lower);
            wrong.push(Complaint::option(to, window.upper, allowed));
            continue;
        }
        let model = study.model();
        let parameter = model.parameter(path)?;
        let [first, last] =
            [window.lower, window.upper].map(|end| model.at(&[(parameter.clone(), end)]));
        if first.is_ok_and(|first| last.is_ok_and(|last| first == last)) {
            wrong.push(Complaint::option(option, path.as_str(), OF_THE_EQUATIONS));
        }
    }
    let number = |path: &str| study.address(path).map(|address| address.number).ok();
    let first = number(&request.parameter);
    let same = |(path, _): &&(String, RealInterval)| first.is_some() && number(path) == first;
    if let Some((path, _)) = request.along.as_ref().filter(same) {
        let allowed = "a parameter other than --parameter";
        wrong.push(Complaint::option("--along", path.as_str(), allowed));
    }
    if wrong.is_empty() { Ok(()) } else { Err(wrong.into()) }
}
