//! `stability --parameter`: eigenvalues of a system followed over a parameter, its thresholds, and their curves along a second one.

use std::fmt::Write as _;

use quell_linear::averaging::DitheredSystem;
use quell_linear::growth::Verdict;
use quell_linear::linearised::Linearised;
use quell_linear::tracking::{Family, StabilityChange, ThresholdOfStability, Tracked, track};
use quell_model::units::Quantity;
use quell_numerics::eigen::EigenError;
use quell_numerics::matrix::Matrix;
use serde_json::{Value as Json, json};

use super::{failed, has_equations, is_dithered, oscillating};
use crate::complaint::{Complaint, Failure, Fault, Origin};
use crate::dataset::{Array, Dataset};
use crate::fields::Fields;
use crate::study::{SystemStudy, SystemUnits};
use crate::words::{digits, plural};

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
    pub window: (f64, f64),
    /// A second parameter and its window, along which thresholds are followed.
    pub along: Option<(String, (f64, f64))>,
}

/// A curve of thresholds: (second parameter, threshold), ascending.
#[derive(Clone, Debug, PartialEq)]
pub struct StabilityCurve {
    /// Its points.
    pub points: Vec<(f64, ThresholdOfStability)>,
}

/// Eigenvalues over a parameter.
#[derive(Clone, Debug)]
pub struct TrackedStability {
    /// The request.
    pub request: TrackRequest,
    /// Whether the verdicts are those of averaging.
    pub averaged: bool,
    /// The eigenvalues and thresholds over the window.
    pub tracked: Tracked<String>,
    /// Curves along the second parameter; empty without one.
    pub curves: Vec<StabilityCurve>,
}

/// The state matrices of a study over one of its numbers, others fixed.
struct StudyFamily<'a> {
    study: &'a SystemStudy,
    path: &'a str,
    fixed: Option<(&'a str, f64)>,
}

impl Family for StudyFamily<'_> {
    type Error = String;

    fn matrix(&self, value: f64) -> Result<Matrix, String> {
        let numbers: Vec<(&str, f64)> =
            self.fixed.into_iter().chain([(self.path, value)]).collect();
        let system = self.study.system_at(&numbers).map_err(|why| why.to_string())?;
        if is_dithered(&system) {
            let prepared = DitheredSystem::new(&system).map_err(|why| why.to_string())?;
            let average = prepared.average().map_err(|why| why.to_string())?;
            return Ok(average.linear.state_matrix_with(&average.friction));
        }
        let linear = Linearised::new(&system).map_err(|why| why.to_string())?;
        Ok(linear.state_matrix_with(&linear.friction()))
    }

    fn overflows(why: EigenError) -> String {
        why.to_string()
    }
}

/// Follows the eigenvalues of a study.
///
/// # Errors
/// Complaints about the parameters and their windows; [`Failure::Failed`] if no value of the window has steady sliding.
pub fn run(study: &SystemStudy, request: &TrackRequest) -> Result<TrackedStability, Failure> {
    has_equations(study, "stability")?;
    understood(study, request)?;
    let family = |fixed| StudyFamily { study, path: &request.parameter, fixed };
    let tracked = track(&family(None), request.window, POINTS);
    let tracked = tracked.map_err(|why| failed("stability", why))?;
    let mut curves = Vec::new();
    if let Some((along, (from, to))) = &request.along {
        let width = request.window.1 - request.window.0;
        for k in 0..LINES {
            let value = from + (to - from) * k as f64 / (LINES - 1) as f64;
            let line = track(&family(Some((along, value))), request.window, POINTS_OF_A_LINE);
            let thresholds = line.map_or_else(|_| Vec::new(), |line| line.thresholds);
            let step = (to - from) / (LINES - 1) as f64;
            extend(&mut curves, (value, step), thresholds, width);
        }
    }
    let averaged = is_dithered(study.system());
    Ok(TrackedStability { request: request.clone(), averaged, tracked, curves })
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
            curves.push(StabilityCurve { points: vec![(value, found)] });
            taken.push(true);
        }
    }
}

/// The path of the study that is closest to a wrong one.
fn nearest(study: &SystemStudy, path: &str) -> Option<String> {
    let complaints = study.with(path, 0.0).err()?;
    complaints.iter().find_map(|complaint| complaint.suggestion.clone())
}

/// Every complaint about a request.
pub(super) fn understood(study: &SystemStudy, request: &TrackRequest) -> Result<(), Failure> {
    let mut wrong = Vec::new();
    let along = request.along.as_ref();
    let along = along.map(|(path, window)| (("--along", "--between", "--between"), path, *window));
    let first = (("--parameter", "--from", "--to"), &request.parameter, request.window);
    for ((option, from, to), path, window) in [Some(first), along].into_iter().flatten() {
        if study.number(path).is_none() {
            let allowed =
                "the path of a number of the study, such as contact.pad.friction.coefficient";
            let complaint = Complaint::option(option, path.as_str(), allowed);
            wrong.push(complaint.suggesting(nearest(study, path)));
            continue;
        }
        if window.0.is_nan() || window.1.is_nan() || window.0 >= window.1 {
            let allowed = format!("a finite number above {from} {}", window.0);
            wrong.push(Complaint::option(to, window.1, allowed));
        }
    }
    if request.along.as_ref().is_some_and(|(path, _)| *path == request.parameter) {
        let allowed = "a parameter other than --parameter";
        wrong.push(Complaint::option("--along", request.parameter.as_str(), allowed));
    }
    if wrong.is_empty() { Ok(()) } else { Err(wrong.into()) }
}

/// The roots of `thresholds` of a system, which are those of `stability --parameter`.
///
/// # Errors
/// As [`run`]; a system with dither, whose exact thresholds are those of its periodic motions.
pub fn thresholds(
    study: &SystemStudy,
    request: &TrackRequest,
) -> Result<TrackedStability, Failure> {
    if is_dithered(study.system()) {
        let allowed = "a study without dither: curves of thresholds of periodic motions are not implemented yet; `thresholds` \
                       without --along gives the exact thresholds, and `stability --parameter --along` those of averaging";
        return Err(
            Complaint::new(Fault::NotBuilt, "dither", Origin::Whole, Json::Null, allowed).into()
        );
    }
    run(study, request)
}

impl TrackedStability {
    /// The protocol of the verdicts.
    pub fn protocol(&self) -> &'static str {
        if self.averaged { "averaged" } else { "linearised" }
    }

    /// The answer in one or two sentences.
    pub fn sentence(&self, study: &SystemStudy) -> String {
        let TrackRequest { parameter, window: (from, to), .. } = &self.request;
        let changes: Vec<String> = self
            .tracked
            .thresholds
            .iter()
            .filter(|found| found.verdicts[0] != found.verdicts[1])
            .map(|found| {
                let motion = oscillating(study.units(), found.eigenvalue.im.abs());
                let how = match found.change {
                    StabilityChange::Hopf if found.verdicts[1] == Verdict::Stable => {
                        format!("where a motion {motion} ceases to grow")
                    }
                    StabilityChange::Hopf => format!("where a motion {motion} begins to grow"),
                    StabilityChange::Divergence => "by divergence, without oscillation".to_owned(),
                    StabilityChange::Coalescence => format!("where two motions {motion} merge"),
                    StabilityChange::Jump => "by a jump".to_owned(),
                };
                let at = self.value(study, found.value);
                format!("{} at {parameter} = {at}, {how}", found.verdicts[1].name())
            })
            .collect();
        let by = if self.averaged { "By averaging, steady" } else { "Steady" };
        let mut sentence = if changes.is_empty() {
            let known = self.verdicts().into_iter().map(|(verdict, from, to)| {
                let to = self.value(study, to);
                format!("{verdict} from {parameter} = {} to {to}", digits(from))
            });
            let known = known.collect::<Vec<_>>().join(", ");
            let unknown = if self.tracked.unknown.is_empty() {
                "no threshold was found".to_owned()
            } else {
                let to = self.value(study, *to);
                format!("elsewhere between {} and {to} there is no answer", digits(*from))
            };
            format!("{by} sliding is {known}; {unknown}.")
        } else {
            format!("{by} sliding becomes {}.", changes.join("; "))
        };
        if !self.curves.is_empty() {
            let count = self.curves.len();
            let _ = write!(sentence, " Found {count} curve{} of thresholds.", plural(count));
        }
        sentence
    }

    /// The verdicts over the window, each with its first and last value; a single value in between is not listed.
    fn verdicts(&self) -> Vec<(&'static str, f64, f64)> {
        let mut ranges: Vec<(&'static str, f64, f64)> = Vec::new();
        for point in self.tracked.pieces.iter().flatten() {
            let verdict = point.growth.verdict().name();
            match ranges.last_mut() {
                Some((before, _, to)) if *before == verdict => *to = point.value,
                _ => ranges.push((verdict, point.value, point.value)),
            }
        }
        if ranges.len() > 1 {
            ranges.retain(|(_, from, to)| from < to);
        }
        ranges
    }

    /// A value of the parameter with its unit.
    pub(crate) fn value(&self, study: &SystemStudy, value: f64) -> String {
        let unit = study.unit_of(&self.request.parameter).filter(|unit| *unit != "1");
        format!("{}{}", digits(value), unit.map_or(String::new(), |unit| format!(" {unit}")))
    }

    /// As JSON.
    pub fn json(&self, study: &SystemStudy) -> Json {
        let mut fields = Fields::of_system(study.units());
        let TrackRequest { parameter, window: (from, to), along } = &self.request;
        let unit = study.unit_of(parameter).unwrap_or("1");
        fields
            .plain("ok", true)
            .plain("sentence", self.sentence(study))
            .plain("protocol", self.protocol())
            .plain("parameter", parameter.clone())
            .measured("from", unit, *from)
            .measured("to", unit, *to);
        let points: usize = self.tracked.pieces.iter().map(Vec::len).sum();
        fields.plain("points", points);
        fields.plain("covered", self.tracked.unknown.is_empty()).plain("resumes", self.resumes());
        fields.nested("at_from", self.at_from(study));
        let found = self.tracked.thresholds.iter().map(|found| put(study, unit, found));
        let found: Vec<Fields> = found.collect();
        // The name of the list in the answer about a belt, and that of a system.
        fields.list("local", found.clone()).list("thresholds", found);
        if let Some((path, (first, last))) = along {
            let other = study.unit_of(path).unwrap_or("1");
            fields.plain("along", path.clone()).measured("between", other, vec![*first, *last]);
            let curves = self.curves.iter().map(|curve| put_curve(study, [unit, other], curve));
            fields.list("curves", curves.collect::<Vec<_>>());
        }
        let unknown = self.tracked.unknown.iter();
        let unknown =
            unknown.map(|range| json!({ "from": range.from, "to": range.to, "why": range.why }));
        fields.plain("unknown", unknown.collect::<Vec<Json>>());
        fields.plain("warnings", self.warnings(study));
        fields.finish()
    }

    /// Whether there is an answer at the last value again, after a range without one.
    fn resumes(&self) -> bool {
        let last = self.tracked.pieces.last().and_then(|piece| piece.last());
        let reached = last.is_some_and(|point| point.value >= self.request.window.1);
        reached && !self.tracked.unknown.is_empty()
    }

    /// The verdict at the first value of the window.
    fn at_from(&self, study: &SystemStudy) -> Fields {
        let mut fields = Fields::of_system(study.units());
        let from = self.request.window.0;
        let first = self.tracked.pieces.first().and_then(|piece| piece.first());
        match (first, self.tracked.unknown.first()) {
            (Some(point), _) if point.value <= from => {
                fields.plain("steady_sliding", point.growth.verdict().name());
            }
            (_, Some(range)) => {
                fields.unknown("steady_sliding", range.why.clone());
            }
            _ => {
                fields.unknown("steady_sliding", "the eigenvalues are not known there");
            }
        }
        fields
    }

    /// Warnings: those of the study, and ranges without an answer.
    fn warnings(&self, study: &SystemStudy) -> Vec<String> {
        let unknown = self.tracked.unknown.iter().map(|range| {
            let parameter = &self.request.parameter;
            let to = self.value(study, range.to);
            if range.from == range.to {
                format!("at {parameter} = {to} there is no answer: {}", range.why)
            } else {
                let from = digits(range.from);
                format!("from {parameter} = {from} to {to} there is no answer: {}", range.why)
            }
        });
        study.warnings().iter().cloned().chain(unknown).collect()
    }

    /// Growth rate and frequency of every branch over the parameter.
    pub fn dataset(&self, study: &SystemStudy) -> Dataset {
        let points: Vec<_> = self.tracked.pieces.iter().flatten().collect();
        let branches = points.first().map_or(0, |point| point.eigenvalues.len());
        let values = points.iter().map(|point| point.value).collect();
        let every = |pick: fn(&num_complex::Complex64) -> f64| -> Vec<f64> {
            points.iter().flat_map(|point| point.eigenvalues.iter().map(pick)).collect()
        };
        let parameter = &self.request.parameter;
        let branches = (0..branches).map(|index| index as f64).collect();
        let frequency = study.units().unit(Quantity::FrequencyRatio).unwrap_or("1");
        let rate = if study.units() == SystemUnits::None { "1" } else { "1/s" };
        Dataset::of(&study.into(), "stability")
            .fact(format!("parameter: {parameter}"))
            .with_axis(Array::new("parameter", study.unit_of(parameter).unwrap_or("1"), values))
            .with_axis(Array::new("branch", "1", branches))
            .with(Array::new("growth_rate", rate, every(|z| z.re)))
            .with(Array::new("frequency", frequency, every(|z| z.im)))
    }

    /// The curves along the second parameter, one row per point; `None` without one.
    pub fn dataset_of_curves(&self, study: &SystemStudy) -> Option<Dataset> {
        let (path, _) = self.request.along.as_ref()?;
        let parameter = &self.request.parameter;
        let points = || {
            let curves = self.curves.iter().enumerate();
            curves.flat_map(|(curve, all)| all.points.iter().map(move |point| (curve, point)))
        };
        let numbered = || (0_u8..).zip(StabilityChange::ALL);
        let code = |change: StabilityChange| numbered().find(|(_, other)| *other == change);
        let codes: Vec<u8> = points()
            .filter_map(|(_, (_, found))| code(found.change))
            .map(|(code, _)| code)
            .collect();
        let names = numbered().map(|(code, change)| (code, change.name())).collect();
        let rows = (0..points().count()).map(|index| index as f64).collect();
        let curves = points().map(|(curve, _)| curve as f64).collect();
        let unit = |path: &str| study.unit_of(path).unwrap_or("1");
        let along = points().map(|(_, (at, _))| *at).collect();
        let values = points().map(|(_, (_, found))| found.value).collect();
        let dataset = Dataset::of(&study.into(), "stability")
            .fact(self.sentence(study))
            .with_axis(Array::new("point", "1", rows))
            .with(Array::new("curve", "1", curves))
            .with(Array::of_words("kind", names, &codes))
            .with(Array::new(path.as_str(), unit(path), along))
            .with(Array::new(parameter.as_str(), unit(parameter), values));
        Some(dataset)
    }
}

/// One threshold; `unit` is that of the parameter.
fn put(study: &SystemStudy, unit: &str, found: &ThresholdOfStability) -> Fields {
    let mut fields = Fields::of_system(study.units());
    fields
        .measured("value", unit, found.value)
        .measured("error", unit, found.error)
        .plain("kind", found.change.name())
        .number("frequency", Quantity::FrequencyRatio, found.eigenvalue.im.abs())
        .plain("was", found.verdicts[0].name())
        .plain("becomes", found.verdicts[1].name());
    fields
}

/// One curve: its points as columns. The kind and the verdicts are those of all its points.
fn put_curve(study: &SystemStudy, [unit, along]: [&str; 2], curve: &StabilityCurve) -> Fields {
    let column = |of: &dyn Fn(&ThresholdOfStability) -> f64| -> Vec<f64> {
        curve.points.iter().map(|(_, found)| of(found)).collect()
    };
    let mut fields = Fields::of_system(study.units());
    if let Some((_, first)) = curve.points.first() {
        fields
            .plain("kind", first.change.name())
            .plain("was", first.verdicts[0].name())
            .plain("becomes", first.verdicts[1].name());
    }
    let positions: Vec<f64> = curve.points.iter().map(|(at, _)| *at).collect();
    let frequencies = column(&|found| found.eigenvalue.im.abs());
    fields
        .measured("value", unit, column(&|found| found.value))
        .measured("along", along, positions)
        .measured("error", unit, column(&|found| found.error))
        .numbers("frequency", Quantity::FrequencyRatio, &frequencies);
    fields
}
