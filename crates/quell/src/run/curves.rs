//! `thresholds --along`: curves of local thresholds in two parameters, and the boundaries of averaging.

use quell_dynamics::orbit::curve::{CurvesFound, Open, OpenLine, ParameterPlane, curves};
pub use quell_dynamics::orbit::curve::{ThresholdCurve, ThresholdCurveEnd, ThresholdCurvePoint};
use quell_dynamics::simulation::within;
use quell_linear::averaging::{AveragingOptions, Becomes, CriticalAmplitude, critical_amplitudes};
use quell_model::Belt;
use quell_model::units::Quantity;
use serde_json::{Value as Json, json};

use super::criticality;
use super::thresholds::{ThresholdKind, refused};
use super::varied::{Named, ascending};
use crate::complaint::{Complaint, Failure};
use crate::contact_state::refused_of_belt;
use crate::dataset::{Array, Dataset};
use crate::effort::STEPS_OF_MANY_SEARCHES;
use crate::fields::Fields;
use crate::range::SlipMet;
use crate::study::BeltStudy;
use crate::words::plural;

/// Lines across the second parameter on which the search for curves starts.
pub(super) const LINES: u32 = 5;

/// Minimum number of points of a curve across a window.
pub(super) const POINTS: u32 = 100;

/// Intervals of the second parameter between evaluations of averaging.
const AVERAGED: u32 = 120;

/// Options of threshold curves.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CurvesRequest {
    /// Path of the parameter whose thresholds are followed; an SI key is allowed in a study in SI.
    pub parameter: String,
    /// Its window, first and last value in the unit of that key.
    pub window: (f64, f64),
    /// Path of the parameter along which they are followed, likewise.
    pub along: String,
    /// Its window, likewise.
    pub between: (f64, f64),
}

/// A boundary of averaging in the same plane: (second parameter, amplitude), both in the numbers of the equations.
#[derive(Clone, Debug, PartialEq)]
pub struct AveragedBoundary {
    /// Whether this is averaging in the limit R → ∞, instead of finite-R averaging, which has the structure's own fast motion.
    pub limit: bool,
    /// Points; a boundary is broken where it does not exist.
    pub pieces: Vec<Vec<(f64, f64)>>,
}

impl AveragedBoundary {
    /// The critical amplitudes over a window of the second parameter at `steps` intervals, one boundary after another: those
    /// towards stability and towards instability are separate curves.
    pub(super) fn along(
        limit: bool,
        (first, last): (f64, f64),
        steps: u32,
        boundaries: &[&dyn Fn(f64) -> Option<f64>],
    ) -> Self {
        let mut pieces: Vec<Vec<(f64, f64)>> = Vec::new();
        for amplitude in boundaries {
            let mut piece = Vec::new();
            for k in 0..=steps {
                let along = first + (last - first) * f64::from(k) / f64::from(steps);
                match amplitude(along) {
                    Some(amplitude) => piece.push((along, amplitude)),
                    None if piece.is_empty() => {}
                    None => pieces.push(std::mem::take(&mut piece)),
                }
            }
            if !piece.is_empty() {
                pieces.push(piece);
            }
        }
        Self { limit, pieces }
    }
}

/// Why a curve ends inside its windows, in words; `None` if it does not.
pub(super) fn why_it_ends(end: ThresholdCurveEnd) -> Option<&'static str> {
    match end {
        ThresholdCurveEnd::Window | ThresholdCurveEnd::Closed => None,
        ThresholdCurveEnd::Grazing => Some("beyond it the response grazes or changes its events"),
        ThresholdCurveEnd::Resonance => {
            Some("its pair of multipliers becomes real (a resonance 1 : 1 or 1 : 2)")
        }
        ThresholdCurveEnd::SameVerdict => Some("beyond it the grazing changes no verdict"),
        ThresholdCurveEnd::Crossing => Some("another threshold crosses it, and comes first beyond"),
        ThresholdCurveEnd::Lost => Some("it was lost"),
    }
}

/// Curves of thresholds.
#[derive(Clone, Debug, PartialEq)]
pub struct Curves {
    /// The request, in numbers of the equations.
    pub question: CurvesRequest,
    /// Both parameters as they were asked for.
    pub asked: [Named; 2],
    /// The curves.
    pub curves: Vec<ThresholdCurve>,
    /// Lines across the second parameter on which curves may be missing.
    pub open: Vec<OpenLine>,
    /// Boundaries of averaging, if the first parameter is the amplitude of the first dither.
    pub averaged: Vec<AveragedBoundary>,
}

/// The request in numbers of the equations.
///
/// # Errors
/// Every complaint about it at once.
fn understood(
    study: &BeltStudy,
    question: &CurvesRequest,
) -> Result<([Named; 2], CurvesRequest), Failure> {
    let parameter = Named::new(study, "--parameter", &question.parameter)?;
    let along = Named::new(study, "--along", &question.along)?;
    if parameter.is(&along) {
        let allowed = "a parameter other than --parameter";
        return Err(Complaint::option("--along", question.along.as_str(), allowed).into());
    }
    let (from, to) = question.window;
    let ends = [("--from", from), ("--to", to)];
    let across = [("--between", question.between.0), ("--between", question.between.1)];
    let mut wrong: Vec<Complaint> = ends
        .into_iter()
        .flat_map(|end| parameter.unable(study, end))
        .chain(across.into_iter().flat_map(|end| along.unable(study, end)))
        .collect();
    wrong.extend(ascending(from, to).err().map(|complaint| *complaint));
    wrong.extend(parameter.without_effect(study, "--parameter", (from, to)).filter(|_| from < to));
    let (first, last) = question.between;
    wrong.extend(along.without_effect(study, "--along", (first, last)).filter(|_| first < last));
    if first.is_nan() || last.is_nan() || first >= last {
        let given = format!("{first}:{last}");
        let allowed = "two numbers, the second above the first";
        wrong.push(Complaint::option("--between", given, allowed));
    }
    if !wrong.is_empty() {
        return Err(wrong.into());
    }
    let both = |named: &Named, (first, last)| (named.of(first), named.of(last));
    let (window, between) = (both(&parameter, question.window), both(&along, question.between));
    let paths = (parameter.path.clone(), along.path.clone());
    let request = CurvesRequest { window, between, parameter: paths.0, along: paths.1 };
    Ok(([parameter, along], request))
}

/// The problem on a line across the second parameter, as text.
fn line_in_words(study: &BeltStudy, [parameter, along]: &[Named; 2], line: &OpenLine) -> String {
    let place = along.words(study, line.along);
    let value = |value: f64| parameter.words(study, value);
    let along = along.key();
    format!("on the line {along} = {place}: {}", line.why.words(value))
}

/// The curves of a study.
///
/// # Errors
/// A complaint about a parameter or its window; [`Failure::Failed`] if no response exists at the beginning.
pub fn run(study: &BeltStudy, question: &CurvesRequest) -> Result<Curves, Failure> {
    refused_of_belt(study, "thresholds")?;
    within(STEPS_OF_MANY_SEARCHES, || found(study, question))
}

fn found(study: &BeltStudy, question: &CurvesRequest) -> Result<Curves, Failure> {
    let (asked, question) = understood(study, question)?;
    let at = |values: &[f64]| belt_at(study, &asked, values);
    let plane = ParameterPlane { at: &at, window: question.window, between: question.between };
    let CurvesFound { curves, open } =
        curves(study.belt(), plane, LINES, POINTS).map_err(|line| match line.why {
            Open::Begin(why) => refused(study, why, &question.parameter, "--from"),
            _ => Failure::Failed {
                key: "thresholds".to_owned(),
                why: line_in_words(study, &asked, &line),
            },
        })?;
    let averaged = averaged(study, &asked, &question);
    Ok(Curves { question, asked, curves, open, averaged })
}

/// The belt at numbers of the equations that both parameters give; `None` where it is none.
fn belt_at(study: &BeltStudy, [parameter, along]: &[Named; 2], values: &[f64]) -> Option<Belt> {
    let numbers = [along.set(values[1]), parameter.set(values[0])];
    Some(study.setup_at(&numbers).ok()?.belt().clone())
}

/// The boundaries of averaging; none if the first parameter is not the amplitude of the first dither. A boundary is broken
/// where averaging gives no result.
fn averaged(
    study: &BeltStudy,
    [_, along]: &[Named; 2],
    question: &CurvesRequest,
) -> Vec<AveragedBoundary> {
    let amplitude = ["dither.amplitude", "dither[0].amplitude"];
    if !amplitude.contains(&question.parameter.as_str()) {
        return Vec::new();
    }
    let inside = |critical: &CriticalAmplitude| {
        critical.amplitude >= question.window.0 && critical.amplitude <= question.window.1
    };
    [(true, AveragingOptions::LIMIT), (false, AveragingOptions::FINITE_R)]
        .into_iter()
        .map(|(limit, options)| {
            let boundary = |becomes: Becomes| {
                move |value: f64| {
                    let belt = along.belt_at(study, value)?;
                    let found = critical_amplitudes(&belt, options).ok()?;
                    let first = found.iter().find(|critical| critical.becomes == becomes)?;
                    Some(*first).filter(inside).map(|critical| critical.amplitude)
                }
            };
            let [stable, unstable] = [boundary(Becomes::Stable), boundary(Becomes::Unstable)];
            AveragedBoundary::along(limit, question.between, AVERAGED, &[&stable, &unstable])
        })
        .collect()
}

impl Curves {
    /// Total number of points.
    pub fn points(&self) -> usize {
        self.curves.iter().map(|curve| curve.points.len()).sum()
    }

    /// The result in one sentence.
    pub fn sentence(&self, study: &BeltStudy) -> String {
        let (first, last) = self.question.between;
        let [parameter, along] = &self.asked;
        let [first, last] = [first, last].map(|end| along.words(study, end));
        let (parameter, along) = (parameter.key(), along.key());
        match self.curves.len() {
            0 => format!(
                "No threshold of {parameter} was found on {LINES} lines across {along} from {first} to {last}."
            ),
            count => format!(
                "Found {count} threshold curve{} of {parameter} along {along} from {first} to {last}, with {} point{} in total.",
                plural(count),
                self.points(),
                plural(self.points())
            ),
        }
    }

    /// As JSON.
    pub fn json(&self, study: &BeltStudy) -> Json {
        let question = &self.question;
        let [value, along] = &self.asked;
        let put = |inner: &mut Fields, name: &str, named: &Named, numbers: &[f64]| {
            let own: Vec<f64> = numbers.iter().map(|number| named.value(*number).1).collect();
            inner.measured(name, named.value(0.0).0, own);
        };
        let object = || Fields::new(study.scales());
        let curves = self.curves.iter().map(|curve| {
            let column = |of: &dyn Fn(&ThresholdCurvePoint) -> f64| -> Vec<f64> {
                curve.points.iter().map(of).collect()
            };
            let mut inner = object();
            put(&mut inner, "value", value, &column(&|point| point.value));
            put(&mut inner, "along", along, &column(&|point| point.along));
            inner
                .plain("kind", curve.kind.name())
                .numbers(
                    "displacement",
                    Quantity::Displacement,
                    &column(&|point| point.state.displacement),
                )
                .numbers("velocity", Quantity::Velocity, &column(&|point| point.state.velocity))
                .numbers("multiplier_modulus", Quantity::Ratio, &column(&|point| point.radius))
                .plain("ends", curve.ends.map(ThresholdCurveEnd::name).to_vec());
            let forms: Vec<_> = curve.points.iter().map(|point| point.form).collect();
            criticality::put_columns(&mut inner, curve.kind, &forms);
            if let Some(ratios) = self.amplitude_ratios(study, curve) {
                inner.numbers("amplitude_ratio", Quantity::Velocity, &ratios);
            }
            inner
        });
        let averaged = self.averaged.iter().map(|boundary| {
            let points = || boundary.pieces.iter().flatten();
            let own = |(x, y): &(f64, f64)| json!([along.value(*x).1, value.value(*y).1]);
            let pairs: Vec<Json> = points().map(own).collect();
            let mut inner = object();
            inner.plain("limit", boundary.limit).plain("points", pairs);
            let (x, y): (Vec<f64>, Vec<f64>) = points().copied().unzip();
            put(&mut inner, "along", along, &x);
            put(&mut inner, "value", value, &y);
            inner
        });
        let mut fields = object();
        fields
            .plain("ok", true)
            .plain("sentence", self.sentence(study))
            .plain("parameter", value.key())
            .plain("along", along.key());
        value.put(&mut fields, "from", question.window.0);
        value.put(&mut fields, "to", question.window.1);
        put(&mut fields, "between", along, &[question.between.0, question.between.1]);
        fields
            .list("curves", curves)
            .list("averaged", averaged)
            .plain("warnings", self.warnings(study));
        fields.finish()
    }

    /// Warnings about lines on which curves may be missing.
    pub fn warnings(&self, study: &BeltStudy) -> Vec<String> {
        let warning = |line: &OpenLine| {
            format!("curves may be missing {}", line_in_words(study, &self.asked, line))
        };
        let mut slip = SlipMet::default();
        for point in self.curves.iter().flat_map(|curve| &curve.points) {
            if let Some(belt) = belt_at(study, &self.asked, &[point.value, point.along]) {
                slip.add_attractor(&belt, point.state);
            }
        }
        slip.warnings(study).into_iter().chain(self.open.iter().map(warning)).collect()
    }

    /// α = D/R of the first dither along a curve, if the first parameter is its amplitude.
    pub fn amplitude_ratios(&self, study: &BeltStudy, curve: &ThresholdCurve) -> Option<Vec<f64>> {
        if self.averaged.is_empty() {
            return None;
        }
        let ratio = study.belt().dithers().first()?.frequency_ratio;
        let along_ratio = ["dither.frequency_ratio", "dither[0].frequency_ratio"]
            .contains(&self.question.along.as_str());
        let of = |point: &ThresholdCurvePoint| {
            point.value / if along_ratio { point.along } else { ratio }
        };
        Some(curve.points.iter().map(of).collect())
    }

    /// The points of all curves, one after another.
    pub fn dataset(&self, study: &BeltStudy) -> Dataset {
        let numbered = || (0_u8..).zip(ThresholdKind::ALL);
        let code = |kind: ThresholdKind| {
            numbered().filter(move |(_, other)| *other == kind).map(|(code, _)| code)
        };
        let each = |of: &dyn Fn(&ThresholdCurvePoint) -> f64| -> Vec<f64> {
            self.curves.iter().flat_map(|curve| &curve.points).map(of).collect()
        };
        let per_curve = |of: &dyn Fn(usize) -> f64| -> Vec<f64> {
            let repeated =
                |(number, curve): (usize, &ThresholdCurve)| vec![of(number); curve.points.len()];
            self.curves.iter().enumerate().flat_map(repeated).collect()
        };
        let codes: Vec<u8> = self
            .curves
            .iter()
            .flat_map(|curve| curve.points.iter().flat_map(move |_| code(curve.kind)))
            .collect();
        let names = numbered().map(|(code, kind)| (code, kind.name()));
        let own = |named: &Named, numbers: Vec<f64>| {
            let values = numbers.into_iter().map(|number| named.value(number).1);
            Array::new(named.key(), named.value(0.0).0, values.collect())
        };
        let [parameter, along] = &self.asked;
        let numbers = (0..self.points()).map(|number| number as f64).collect();
        let mut dataset = Dataset::new(study, "thresholds")
            .fact(self.sentence(study))
            .with_axis(Array::new("point", "1", numbers))
            .with(Array::new("curve", "1", per_curve(&|number| number as f64)))
            .with(Array::of_words("kind", names.collect(), &codes))
            .with(own(along, each(&|point| point.along)))
            .with(own(parameter, each(&|point| point.value)));
        let ratios: Option<Vec<f64>> = self
            .curves
            .iter()
            .map(|curve| self.amplitude_ratios(study, curve))
            .collect::<Option<Vec<_>>>()
            .map(|all| all.concat());
        if let Some(ratios) = ratios {
            dataset = dataset.array("amplitude_ratio", Quantity::Velocity, ratios);
        }
        dataset
            .array("displacement", Quantity::Displacement, each(&|point| point.state.displacement))
            .array("velocity", Quantity::Velocity, each(&|point| point.state.velocity))
            .array("multiplier_modulus", Quantity::Ratio, each(&|point| point.radius))
    }
}
