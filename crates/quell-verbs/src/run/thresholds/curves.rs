//! `thresholds --along`: curves of the thresholds of a base response in two parameters, and the boundaries of averaging.

use quell_dynamics::orbit::{
    CurvesFound, OpenLine, SystemAt, ThresholdCurve, ThresholdCurveEnd, ThresholdKind,
    ThresholdPlane, threshold_curves,
};
use quell_linear::averaging::{Averaging, Becomes, DitheredSystem, critical_amplitudes};
use quell_model::units::Quantity;
use quell_model::{RefusedNumbers, System};
use quell_numerics::interval::RealInterval;
use serde_json::{Value as Json, json};

use super::super::slip::SlipReached;
use crate::complaint::{Complaint, Failure};
use crate::dataset::{Array, Dataset};
use crate::document::given_number;
use crate::fields::Fields;
use crate::run::criticality;
use crate::run::system::of_runs::beyond_laws;
use crate::run::system::start::state_columns;
use crate::run::system::tracked::{TrackRequest, understood};
use crate::run::system::{failed, has_equations, value_at};
use crate::study::SystemStudy;
use crate::words::{plural, quantity_at, quantity_is};

/// Lines across the second parameter on which the search for curves starts.
const LINES: u32 = 5;

/// Minimum number of points of a curve across a window.
const POINTS: u32 = 100;

/// Intervals of the second parameter between evaluations of averaging.
const AVERAGED: u32 = 120;

/// Options of threshold curves.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CurvesRequest {
    /// Path of the parameter whose thresholds are followed.
    pub parameter: String,
    /// Its window, first and last value in the unit of that key.
    pub window: RealInterval,
    /// Path of the parameter along which they are followed, likewise.
    pub along: String,
    /// Its window, likewise.
    pub between: RealInterval,
}

/// A boundary of averaging in the same plane: (second parameter, amplitude), both in the units of their keys.
#[derive(Clone, Debug, PartialEq)]
pub struct AveragedBoundary {
    /// Whether this is averaging in the limit R → ∞, instead of finite-R averaging, which has the structure's own fast motion.
    pub limit: bool,
    /// Points; a boundary is broken where it does not exist.
    pub pieces: Vec<Vec<(f64, f64)>>,
}

impl AveragedBoundary {
    /// The critical amplitudes over a window of the second parameter, one boundary after another: those towards stability and towards
    /// instability are separate curves.
    fn along(
        limit: bool,
        window: RealInterval,
        boundaries: &[&dyn Fn(f64) -> Option<f64>],
    ) -> Self {
        let mut pieces: Vec<Vec<(f64, f64)>> = Vec::new();
        for amplitude in boundaries {
            let mut piece = Vec::new();
            for k in 0..=AVERAGED {
                let along = window.lower + window.width() * f64::from(k) / f64::from(AVERAGED);
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
fn why_it_ends(end: ThresholdCurveEnd) -> Option<&'static str> {
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
#[derive(Clone, Debug)]
pub struct Curves {
    /// The request, in the numbers of the study.
    pub request: CurvesRequest,
    /// The curves, and lines across the second parameter on which curves may be missing.
    pub found: CurvesFound,
    /// Boundaries of averaging, if the first parameter is the amplitude of the first dither.
    pub averaged: Vec<AveragedBoundary>,
    /// Largest slip speed that each contact reaches in the responses on the curves.
    pub slip: Vec<f64>,
}

/// The same parameters and windows for eigenvalues.
pub fn tracked(request: &CurvesRequest) -> TrackRequest {
    let CurvesRequest { parameter, window, along, between } = request.clone();
    TrackRequest { parameter, window, along: Some((along, between)) }
}

/// Whether some dither acts somewhere in the plane.
pub fn is_dithered_in(study: &SystemStudy, request: &CurvesRequest) -> bool {
    let RealInterval { lower: first, upper: last } = request.window;
    let RealInterval { lower: begin, upper: end } = request.between;
    let model = study.model();
    let corners = [(first, begin), (first, end), (last, begin), (last, end)];
    study.system().is_dithered()
        || corners.iter().any(|(value, along)| {
            let at = [(request.parameter.as_str(), *value), (request.along.as_str(), *along)];
            let numbers = model.numbers(&at).ok();
            numbers.and_then(|at| model.at(&at).ok()).is_some_and(|system| system.is_dithered())
        })
}

/// The curves of a study whose dither acts somewhere in the plane.
///
/// # Errors
/// Complaints about the request; [`Failure::Failed`] if no line has a base response to start from.
pub fn run(study: &SystemStudy, request: &CurvesRequest) -> Result<Curves, Failure> {
    has_equations(study, "thresholds")?;
    understood(study, &tracked(request))?;
    let (parameter, along) = (request.parameter.as_str(), request.along.as_str());
    let model = study.model();
    let ids = [model.parameter(parameter)?, model.parameter(along)?];
    let at = |values: &[f64]| -> Result<System, RefusedNumbers> {
        let numbers = [(ids[0].clone(), values[0]), (ids[1].clone(), values[1])];
        model.at(&numbers).map_err(RefusedNumbers::by_study)
    };
    let ends = [
        ("--from", request.window.lower, true),
        ("--to", request.window.upper, true),
        ("--between", request.between.lower, false),
        ("--between", request.between.upper, false),
    ];
    for (option, value, is_first) in ends {
        let values = if is_first {
            [value, request.between.middle()]
        } else {
            [request.window.middle(), value]
        };
        at(&values).map_err(|why| {
            let path = if is_first { parameter } else { along };
            let allowed = format!("a value that {path} can take: {why}");
            Complaint::option(option, given_number(value), allowed)
        })?;
    }
    let (window, between) = (request.window, request.between);
    let plane = ThresholdPlane { at: &at, window, between, points: POINTS };
    let found = threshold_curves(&plane, LINES)
        .map_err(|line| failed("thresholds", line_in_words(study, request, &line)))?;
    let averaged = averaged(study, request, &at);
    let mut slip = SlipReached::new(study.system());
    for point in found.curves.iter().flat_map(|curve| &curve.points) {
        if let Ok(system) = at(&[point.value, point.along]) {
            slip.add(&system, &point.state);
        }
    }
    Ok(Curves { request: request.clone(), found, averaged, slip: slip.largest() })
}

/// The boundaries of averaging; none if the first parameter is not the amplitude of the first dither.
fn averaged(
    study: &SystemStudy,
    request: &CurvesRequest,
    at: &SystemAt<'_>,
) -> Vec<AveragedBoundary> {
    let RealInterval { lower: least, upper: most } = request.window;
    // A peak force is in newtons under every key of a study with units.
    if study.dither_of(&request.parameter) != Some(0) {
        return Vec::new();
    }
    let boundary = |becomes: Becomes| {
        move |along: f64| {
            let system = at(&[most, along]).ok()?;
            let found = DitheredSystem::new(&system).ok()?.critical_amplitudes(0).ok()?;
            let first = found.iter().find(|critical| critical.becomes == becomes)?;
            Some(first.amplitude).filter(|amplitude| (least..=most).contains(amplitude))
        }
    };
    let [stable, unstable] = [boundary(Becomes::Stable), boundary(Becomes::Unstable)];
    // Averaging of systems has the fast motion of the structure itself.
    let found = AveragedBoundary::along(false, request.between, &[&stable, &unstable]);
    // That in the limit R → ∞ is known of one mass.
    let limit = |becomes: Becomes| {
        move |along: f64| {
            let system = at(&[most, along]).ok()?;
            let mass = system.one_mass()?;
            let found = critical_amplitudes(mass.belt(), Averaging::Limit).ok()?;
            let first = found.iter().find(|critical| critical.becomes == becomes)?;
            let own = mass.belt().dithers().first()?.amplitude;
            let amplitude = first.amplitude * most / own;
            Some(amplitude).filter(|amplitude| (least..=most).contains(amplitude))
        }
    };
    let [stable, unstable] = [limit(Becomes::Stable), limit(Becomes::Unstable)];
    let in_the_limit = AveragedBoundary::along(true, request.between, &[&stable, &unstable]);
    let is_empty = in_the_limit.pieces.is_empty();
    (!is_empty).then_some(in_the_limit).into_iter().chain([found]).collect()
}

/// The contacts of a study by their indices.
fn names<'s>(study: &'s SystemStudy, contacts: &[usize]) -> Vec<&'s str> {
    let all = &study.system().contacts;
    contacts.iter().filter_map(|contact| Some(all.get(*contact)?.name.as_str())).collect()
}

/// The kind of a threshold in words, with the contacts that graze or open there if the study has several.
pub fn kind_in_words(study: &SystemStudy, kind: ThresholdKind, contacts: &[usize]) -> String {
    let several = study.system().contacts.len() > 1;
    match names(study, contacts).as_slice() {
        [before @ .., last] if several && !before.is_empty() => {
            format!("{} ({} and {last})", kind.name(), before.join(", "))
        }
        [only] if several => format!("{} ({only})", kind.name()),
        _ => kind.name().to_owned(),
    }
}

/// Adds the contacts that graze or open at a threshold: all of them, and the first one.
pub(super) fn put_contacts(fields: &mut Fields, study: &SystemStudy, contacts: &[usize]) {
    let names: Vec<String> = names(study, contacts).into_iter().map(str::to_owned).collect();
    if let Some(first) = names.first() {
        fields.plain("contact", first.clone()).plain("contacts", names);
    }
}

fn line_in_words(study: &SystemStudy, request: &CurvesRequest, line: &OpenLine) -> String {
    let place = value_at(study, &request.along, line.along);
    let why = line.why.words(|value| value_at(study, &request.parameter, value));
    format!("on the line of the {}: {why}", quantity_is(&request.along, &place))
}

impl Curves {
    /// Total number of points.
    pub fn points(&self) -> usize {
        self.found.curves.iter().map(|curve| curve.points.len()).sum()
    }

    /// The kind of a curve in words, with its contact if there are several.
    pub fn kind(&self, study: &SystemStudy, curve: &ThresholdCurve) -> String {
        kind_in_words(study, curve.kind, &curve.contacts)
    }

    /// The curves and where they end inside the windows, in a few sentences.
    pub fn sentence(&self, study: &SystemStudy) -> String {
        let CurvesRequest {
            parameter,
            along,
            between: RealInterval { lower: first, upper: last },
            ..
        } = &self.request;
        let (from, to) = (value_at(study, along, *first), value_at(study, along, *last));
        let [parameter, along] = [parameter, along].map(|path| quantity_at(path));
        let count = self.found.curves.len();
        if count == 0 {
            return format!(
                "No threshold of the {parameter} was found on {LINES} lines across the {along} from {from} to {to}."
            );
        }
        format!(
            "Found {count} threshold curve{} of the {parameter} along the {along} from {from} to {to}, with {} point{} in total.",
            plural(count),
            self.points(),
            plural(self.points())
        )
    }

    /// Where the curves end inside the windows.
    pub fn notes(&self, study: &SystemStudy) -> Vec<String> {
        let along = &self.request.along;
        let mut notes = Vec::new();
        for curve in &self.found.curves {
            let ends =
                [(curve.points.first(), curve.ends[0]), (curve.points.last(), curve.ends[1])];
            for (point, end) in ends {
                if let (Some(point), Some(why)) = (point, why_it_ends(end)) {
                    let place = value_at(study, along, point.along);
                    let kind = self.kind(study, curve);
                    notes.push(format!(
                        "The {kind} curve ends at the {}: {why}.",
                        quantity_is(along, &place)
                    ));
                }
            }
        }
        notes
    }

    /// Warnings: those of the study, about slip beyond the ranges of the laws, and lines on which curves may be missing.
    pub fn warnings(&self, study: &SystemStudy) -> Vec<String> {
        let missing = self.found.open.iter().map(|line| {
            format!("curves may be missing {}", line_in_words(study, &self.request, line))
        });
        let beyond = beyond_laws(study, |contact| self.slip[contact]);
        study.warnings().iter().cloned().chain(beyond).chain(missing).collect()
    }

    /// As JSON.
    pub fn json(&self, study: &SystemStudy) -> Json {
        let CurvesRequest { parameter, along, window, between } = &self.request;
        let [unit, across] = [parameter, along].map(|path| study.unit_of(path).unwrap_or("1"));
        let object = || Fields::in_units(study.units());
        let curves = self.found.curves.iter().map(|curve| {
            let points = || curve.points.iter();
            let moduli: Vec<f64> = points().map(|point| point.radius).collect();
            let mut inner = object();
            inner.plain("kind", curve.kind.name());
            put_contacts(&mut inner, study, &curve.contacts);
            inner
                .measured("value", unit, points().map(|point| point.value).collect::<Vec<_>>())
                .measured("along", across, points().map(|point| point.along).collect::<Vec<_>>())
                .plain("state", points().map(|point| point.state.clone()).collect::<Vec<_>>())
                .numbers("multiplier_modulus", Quantity::Ratio, &moduli)
                .plain("ends", curve.ends.map(ThresholdCurveEnd::name).to_vec());
            let forms: Vec<_> = points().map(|point| point.form).collect();
            criticality::put_columns(&mut inner, curve.kind, &forms);
            inner
        });
        let averaged = self.averaged.iter().map(|boundary| {
            let points = || boundary.pieces.iter().flatten();
            let pairs: Vec<Json> = points().map(|(along, value)| json!([along, value])).collect();
            let mut inner = object();
            inner
                .plain("limit", boundary.limit)
                .plain("points", pairs)
                .measured("along", across, points().map(|point| point.0).collect::<Vec<_>>())
                .measured("value", unit, points().map(|point| point.1).collect::<Vec<_>>());
            inner
        });
        let mut fields = object();
        fields
            .plain("ok", true)
            .plain("sentence", self.sentence(study))
            .plain("protocol", "local: Floquet multipliers of the periodic motion")
            .plain("parameter", parameter.as_str())
            .measured("from", unit, window.lower)
            .measured("to", unit, window.upper)
            .plain("along", along.as_str())
            .measured("between", across, vec![between.lower, between.upper])
            .plain("state_names", study.system().state_names())
            .list("curves", curves)
            .list("averaged", averaged)
            .plain("warnings", self.warnings(study));
        fields.finish()
    }

    /// The points of all curves, one after another.
    pub fn dataset(&self, study: &SystemStudy) -> Dataset {
        let numbered = || (0_u8..).zip(ThresholdKind::ALL);
        let points = || {
            let curves = self.found.curves.iter().enumerate();
            curves.flat_map(|(number, curve)| {
                curve.points.iter().map(move |point| (number, curve.kind, point))
            })
        };
        let codes: Vec<u8> = points()
            .filter_map(|(_, kind, _)| numbered().find(|(_, other)| *other == kind))
            .map(|(code, _)| code)
            .collect();
        let names = numbered().map(|(code, kind)| (code, kind.name())).collect();
        let CurvesRequest { parameter, along, .. } = &self.request;
        let unit = |path: &str| study.unit_of(path).unwrap_or("1");
        let rows = (0..self.points()).map(|row| row as f64).collect();
        let dataset = Dataset::of(&study.into(), "thresholds")
            .fact(self.sentence(study))
            .with_axis(Array::new("point", "1", rows))
            .with(Array::new("curve", "1", points().map(|(number, ..)| number as f64).collect()))
            .with(Array::of_words("kind", names, &codes))
            .with(Array::new(
                along.as_str(),
                unit(along),
                points().map(|(.., point)| point.along).collect(),
            ))
            .with(Array::new(
                parameter.as_str(),
                unit(parameter),
                points().map(|(.., point)| point.value).collect(),
            ))
            .with(Array::new(
                "multiplier_modulus",
                "1",
                points().map(|(.., point)| point.radius).collect(),
            ));
        let states: Vec<&[f64]> = points().map(|(.., point)| point.state.as_slice()).collect();
        state_columns(dataset, study, &states)
    }
}
