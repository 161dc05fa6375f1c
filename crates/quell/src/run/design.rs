//! `design`: the least dither that is quiet over a box of operating points, under limits.

use std::fmt::Write as _;

use quell_design::least_dither::{
    BeltPlant, DesignObjective, DesignPoint, DesignProblem, Designed, FeasibleDesign,
    InfeasibleDesign, LimitedQuantity, MARGIN, NoDesign, OperatingPoint, Plant, design,
};
use quell_dynamics::simulation::within;
use quell_model::parameter::design::LIMITS;
use quell_model::units::Quantity;
use quell_model::{Belt, Dither, Waveform};
use rayon::prelude::*;
use serde_json::Value as Json;

use super::varied::Named;
use super::waveforms::label;
use crate::complaint::{Complaint, Failure, Fault, Origin};
use crate::contact_state::refused_of_belt;
use crate::effort::STEPS_OF_MANY_SEARCHES;
use crate::fields::Fields;
use crate::run::system::in_units;
use crate::study::{BeltStudy, Design, DesignRange, SystemStudy};
use crate::words::{digits, in_words};

/// A limit binds if at least this share of it is used.
const BINDS: f64 = 0.9999;

/// Points of the schedule over a box of one coordinate.
const SCHEDULE: usize = 97;

/// Shares of a limit at which the frontier is evaluated.
const FRONTIER: [f64; 9] = [0.5, 0.6, 0.7, 0.8, 0.9, 1.0, 1.2, 1.5, 2.0];

/// A number of the study that a design chooses or ranges over.
#[derive(Clone, Debug, PartialEq)]
pub struct DesignNumber {
    /// Path as it was written.
    pub path: String,
    /// Value of the named key that corresponds to 1 in the equations.
    pub per_unit: f64,
    /// Smallest and largest value, in numbers of the equations.
    pub range: (f64, f64),
}

/// The least dither of a study.
#[derive(Clone, Debug)]
pub struct LeastDitherFound {
    /// The amplitude.
    pub amplitude: DesignNumber,
    /// The other numbers that are chosen.
    pub others: Vec<DesignNumber>,
    /// The box of operating points.
    pub over: Vec<DesignNumber>,
    /// The answer of each waveform, in the order of the study.
    pub waveforms: Vec<(Waveform, Designed)>,
    /// The waveform of the answer: the best feasible one, or the first.
    pub best: usize,
    /// The least amplitude at single operating points of a box of one coordinate, by averaging: a schedule in place of one dither.
    pub schedule: Vec<(f64, Option<f64>)>,
}

/// A study with a design: its units and what it requests.
pub trait StudyWithDesign {
    /// The table `[design]`.
    fn asked(&self) -> Option<&Design>;

    /// An empty answer in the units of the study.
    fn fields(&self) -> Fields;

    /// A quantity of the equations with its unit.
    fn in_words(&self, quantity: Quantity, value: f64) -> String;
}

impl StudyWithDesign for BeltStudy {
    fn asked(&self) -> Option<&Design> {
        self.design()
    }

    fn fields(&self) -> Fields {
        Fields::new(self.scales())
    }

    fn in_words(&self, quantity: Quantity, value: f64) -> String {
        in_words(self, quantity, value)
    }
}

impl StudyWithDesign for SystemStudy {
    fn asked(&self) -> Option<&Design> {
        self.design()
    }

    fn fields(&self) -> Fields {
        Fields::of_system(self.units())
    }

    fn in_words(&self, quantity: Quantity, value: f64) -> String {
        in_units(self.units(), quantity, value)
    }
}

/// The numbers that a design chooses and over which it ranges.
#[derive(Clone, Debug)]
pub(crate) struct DesignNumbers {
    pub(crate) amplitude: DesignNumber,
    pub(crate) others: Vec<DesignNumber>,
    pub(crate) over: Vec<DesignNumber>,
}

/// The table `[design]` of a study with a dither.
///
/// # Errors
/// A complaint about what is missing.
pub(crate) fn asked(study: &dyn StudyWithDesign, has_dither: bool) -> Result<&Design, Failure> {
    let (key, allowed) = match study.asked() {
        Some(design) if has_dither => return Ok(design),
        Some(_) => {
            ("dither", "given: its direction, frequency and waveform are where the design begins")
        }
        None => (
            "design",
            "a table [design] with minimise, vary, from and to: what is to be small, and over which numbers",
        ),
    };
    Err(Complaint::new(Fault::Missing, key, Origin::Whole, Json::Null, allowed).into())
}

/// The complaint about `vary` without the amplitude of one dither.
pub(crate) fn without_amplitude(asked: &Design, allowed: String) -> Failure {
    let given: Vec<&str> = asked.vary.iter().map(|range| range.path.as_str()).collect();
    Complaint::new(Fault::Value, "design.vary", Origin::Whole, given, allowed).into()
}

/// The least dither of a belt.
///
/// # Errors
/// A complaint about a study without `[design]` or a number in it; a contact with a state.
pub fn run(study: &BeltStudy) -> Result<LeastDitherFound, Failure> {
    refused_of_belt(study, "design")?;
    let belt = study.belt();
    let asked = asked(study, !belt.dithers().is_empty())?;
    let (vary, over) = (numbers(study, "vary", &asked.vary)?, numbers(study, "over", &asked.over)?);
    let own = belt.dither_path(0, "amplitude");
    let is_own = |path: &str| path == own || path == "dither.amplitude";
    let (amplitude, others): (Vec<_>, Vec<_>) =
        vary.into_iter().partition(|(path, _)| is_own(path));
    let [(_, amplitude)] = amplitude.as_slice() else {
        let allowed = format!(
            "a list with {own}, the amplitude of the first dither, once: the least one is sought"
        );
        return Err(without_amplitude(asked, allowed));
    };
    let paths = |numbers: &[(String, DesignNumber)]| -> Vec<String> {
        numbers.iter().map(|(path, _)| path.clone()).collect()
    };
    let (over_paths, other_paths) = (paths(&over), paths(&others));
    let plant = |waveform: &Waveform| -> Result<BeltPlant, Failure> {
        let belt = with_waveform(belt, waveform).map_err(|why| failed(why.to_string()))?;
        let (over, others) = (over_paths.clone(), other_paths.clone());
        Ok(BeltPlant { belt, over, others, start: asked.start })
    };
    let plants: Vec<(Waveform, BeltPlant)> = asked
        .waveforms
        .iter()
        .map(|waveform| Ok((waveform.clone(), plant(waveform)?)))
        .collect::<Result<_, Failure>>()?;
    let only = |numbers: Vec<(String, DesignNumber)>| -> Vec<DesignNumber> {
        numbers.into_iter().map(|(_, number)| number).collect()
    };
    let numbers =
        DesignNumbers { amplitude: amplitude.clone(), others: only(others), over: only(over) };
    Ok(least_dither(asked, numbers, &plants))
}

/// The least dither of the waveforms of a study, each with its structure.
pub(crate) fn least_dither<P: Plant + Sync>(
    asked: &Design,
    numbers: DesignNumbers,
    plants: &[(Waveform, P)],
) -> LeastDitherFound {
    let DesignNumbers { amplitude, others, over } = numbers;
    let ranges = |numbers: &[DesignNumber]| -> Vec<(f64, f64)> {
        numbers.iter().map(|number| number.range).collect()
    };
    let (box_ranges, other_ranges) = (ranges(&over), ranges(&others));
    let designed = |(waveform, plant): &(Waveform, P)| {
        let problem = DesignProblem {
            plant,
            objective: asked.minimise,
            amplitude: amplitude.range,
            others: &other_ranges,
            over: &box_ranges,
            limits: &asked.limits,
            start: asked.start,
        };
        (waveform.clone(), within(STEPS_OF_MANY_SEARCHES, || design(problem)))
    };
    let waveforms: Vec<(Waveform, Designed)> = plants.par_iter().map(designed).collect();
    let value = |designed: &Designed| match &designed.answer {
        Ok(found) => found.critical.objective.clone().unwrap_or(f64::INFINITY),
        Err(_) => f64::INFINITY,
    };
    let best = (0..waveforms.len())
        .min_by(|a, b| value(&waveforms[*a].1).total_cmp(&value(&waveforms[*b].1)))
        .unwrap_or(0);
    let schedule = match (&plants.get(best), box_ranges.as_slice(), &waveforms[best].1.answer) {
        (Some((_, plant)), [range], Ok(found)) => {
            schedule(plant, *range, &found.critical.others, amplitude.range)
        }
        _ => Vec::new(),
    };
    LeastDitherFound { amplitude, others, over, waveforms, best, schedule }
}

/// The least amplitude at single operating points, by averaging.
fn schedule(
    plant: &dyn Plant,
    (low, high): (f64, f64),
    others: &[f64],
    range: (f64, f64),
) -> Vec<(f64, Option<f64>)> {
    let at = |point: f64| {
        let place = OperatingPoint { point: &[point], others };
        let quiet = plant.averaged(place, range).ok()?;
        // The quiet amplitudes that reach up to the largest one: smaller quiet amplitudes may be followed by loud ones.
        quiet.intervals().last().map(|(least, _)| *least)
    };
    super::evenly((low, high), SCHEDULE).into_iter().map(|point| (point, at(point))).collect()
}

/// The belt with another waveform of its first dither.
fn with_waveform(belt: &Belt, waveform: &Waveform) -> Result<Belt, quell_model::InvalidValues> {
    let mut dithers: Vec<Dither> = belt.dithers().to_vec();
    dithers[0].waveform = waveform.clone();
    let (damping, load, velocity) =
        (belt.damping_ratio(), belt.normal_load(), belt.belt_velocity());
    Ok(Belt::new(damping, load, velocity, belt.friction().clone(), dithers)?.in_si(belt.scales()))
}

/// Numbers of `[design]` with their paths in the equations. Both ends of every range must give valid studies.
fn numbers(
    study: &BeltStudy,
    key: &str,
    ranges: &[DesignRange],
) -> Result<Vec<(String, DesignNumber)>, Failure> {
    let mut found = Vec::new();
    let mut wrong: Vec<Complaint> = Vec::new();
    let placed = |complaint: Complaint, path: &str| Complaint {
        key: format!("design.{key}"),
        origin: Origin::Whole,
        allowed: format!("{path}: {}", complaint.allowed),
        ..complaint
    };
    for range in ranges {
        let named = match Named::new(study, "[design]", &range.path) {
            Ok(named) => named,
            Err(complaint) => {
                wrong.push(placed(*complaint, &range.path));
                continue;
            }
        };
        for value in [range.from, range.to] {
            let refused = named.unable(study, ("[design]", value));
            wrong.extend(refused.map(|complaint| placed(complaint, &range.path)));
        }
        let number = DesignNumber {
            path: range.path.clone(),
            per_unit: 1.0 / named.of(1.0),
            range: (named.of(range.from), named.of(range.to)),
        };
        found.push((named.path.clone(), number));
    }
    if wrong.is_empty() { Ok(found) } else { Err(wrong.into()) }
}

fn failed(why: String) -> Failure {
    Failure::Failed { key: "design".to_owned(), why }
}

/// The quantity of an objective.
pub(crate) fn quantity_of(objective: DesignObjective) -> Quantity {
    match objective {
        DesignObjective::Amplitude => Quantity::Force,
        DesignObjective::Stroke => Quantity::Displacement,
        DesignObjective::Velocity => Quantity::Velocity,
        DesignObjective::Power => Quantity::Power,
        DesignObjective::FrictionLoss => Quantity::Ratio,
    }
}

/// The quantity of a limit.
fn quantity_of_limit(limited: LimitedQuantity) -> Quantity {
    let parameter = LIMITS.iter().find(|parameter| parameter.key() == limited.name());
    parameter.map_or(Quantity::Ratio, |parameter| parameter.quantity)
}

impl LeastDitherFound {
    /// The waveform of the answer.
    pub fn waveform(&self) -> &Waveform {
        &self.waveforms[self.best].0
    }

    /// The answer of that waveform.
    pub fn answer(&self) -> &Designed {
        &self.waveforms[self.best].1
    }

    /// A dither by the paths of the study.
    fn by_path(&self, amplitude: f64, others: &[f64]) -> Json {
        let all = [&self.amplitude].into_iter().chain(&self.others);
        let values = [amplitude].into_iter().chain(others.iter().copied());
        let values = all
            .zip(values)
            .map(|(number, value)| (number.path.clone(), Json::from(value * number.per_unit)));
        values.collect::<serde_json::Map<_, _>>().into()
    }

    /// An operating point by the paths of the study.
    fn point_by_path(&self, point: &[f64]) -> Json {
        let values = self.over.iter().zip(point);
        let values = values
            .map(|(number, value)| (number.path.clone(), Json::from(value * number.per_unit)));
        values.collect::<serde_json::Map<_, _>>().into()
    }

    /// An operating point in words; empty where the study has one alone.
    fn point_in_words(&self, point: &[f64]) -> String {
        let values = self.over.iter().zip(point);
        let words: Vec<String> = values
            .map(|(number, value)| format!("{} = {}", number.path, digits(value * number.per_unit)))
            .collect();
        if words.is_empty() { String::new() } else { format!(" at {}", words.join(", ")) }
    }

    /// The answer in a few sentences.
    pub fn sentence(&self, study: &dyn StudyWithDesign) -> String {
        let waveform = label(self.waveform());
        let force = |value: f64| study.in_words(Quantity::Force, value);
        let chosen = |others: &[f64]| -> String {
            let values = self.others.iter().zip(others);
            values.fold(String::new(), |mut text, (number, value)| {
                let _ = write!(text, ", {} = {}", number.path, digits(value * number.per_unit));
                text
            })
        };
        match &self.answer().answer {
            Ok(found) => {
                let critical = &found.critical;
                let decides = match &critical.worst {
                    Some(worst) if !worst.is_empty() => {
                        format!("; it is decided{}", self.point_in_words(worst))
                    }
                    _ => String::new(),
                };
                let binding = self.binding(critical);
                let binds = if binding.is_empty() {
                    String::new()
                } else {
                    format!("; {} at the limit", binding.join(", "))
                };
                let largest = found.verified.iter().map(|at| at.multiplier).fold(0.0, f64::max);
                let loss = found.friction_loss.as_ref().map_or(String::new(), |(loss, point)| {
                    let change = if *loss < 0.0 { "gains" } else { "loses" };
                    format!(
                        " The mean friction {change} at most {} %{}.",
                        digits(100.0 * loss.abs()),
                        self.point_in_words(point)
                    )
                });
                format!(
                    "The least dither that is quiet in the whole range is a {waveform} of amplitude {}{}{decides}{binds}. At {} it is \
                     verified by exact responses at {} operating points: the largest multiplier is {}.{loss}",
                    force(critical.amplitude),
                    chosen(&critical.others),
                    force(found.verified_amplitude),
                    found.verified.len(),
                    digits(largest)
                )
            }
            Err(none) => {
                let covered = none.covered.as_ref().map_or(String::new(), |part| {
                    let path = self.over.first().map_or("", |number| number.path.as_str());
                    let per_unit = self.over.first().map_or(1.0, |number| number.per_unit);
                    format!(
                        " One {waveform} of amplitude {}{} suffices for {path} from {} to {}.",
                        force(part.amplitude),
                        chosen(&part.others),
                        digits(part.ends.0 * per_unit),
                        digits(part.ends.1 * per_unit)
                    )
                });
                format!(
                    "No allowed dither is quiet in the whole range: {}.{covered}",
                    self.why(study, none)
                )
            }
        }
    }

    /// Why there is no dither.
    fn why(&self, study: &dyn StudyWithDesign, none: &InfeasibleDesign) -> String {
        match &none.why {
            NoDesign::NeverQuiet { point } => format!(
                "no amplitude from {} to {} of those that the other operating points need is quiet{}",
                study.in_words(Quantity::Force, self.amplitude.range.0),
                study.in_words(Quantity::Force, self.amplitude.range.1),
                self.point_in_words(point)
            ),
            NoDesign::Limit { quantity, used, point } => {
                let at = point.as_ref().map_or(String::new(), |point| self.point_in_words(point));
                format!("{} would be {} times its limit{at}", quantity.name(), digits(*used))
            }
            NoDesign::Failed { point, why } => format!("{why}{}", self.point_in_words(point)),
        }
    }

    /// What decides: the names of the limits that are used wholly, and the end of a range.
    fn binding(&self, critical: &DesignPoint) -> Vec<String> {
        let used = critical.used.iter();
        let limits = used.filter(|(_, used)| used.as_ref().is_ok_and(|used| *used >= BINDS));
        let mut binding: Vec<String> =
            limits.map(|(quantity, _)| quantity.name().to_owned()).collect();
        for (number, value) in self.others.iter().zip(&critical.others) {
            if *value == number.range.0 || *value == number.range.1 {
                binding.push(number.path.clone());
            }
        }
        if critical.worst.is_none() {
            binding.push(self.amplitude.path.clone());
        }
        binding
    }

    /// Warnings: waveforms without an answer, and minima that were searched.
    pub fn warnings(&self, study: &dyn StudyWithDesign) -> Vec<String> {
        let mut warnings = Vec::new();
        for (waveform, designed) in &self.waveforms {
            if let (Err(none), true) = (&designed.answer, self.waveforms.len() > 1) {
                warnings.push(format!(
                    "{}: no allowed dither: {}",
                    label(waveform),
                    self.why(study, none)
                ));
            }
        }
        if let Ok(found) = &self.answer().answer
            && let (Ok(exact), Ok(averaged)) =
                (&found.critical.objective, &found.averaged.objective)
            && (exact / averaged - 1.0).abs() > 0.1
        {
            warnings.push(format!(
                "the exact least dither differs from that of averaging by {} %: the dither is not much faster than the vibration",
                digits(100.0 * (exact / averaged - 1.0).abs())
            ));
        }
        warnings
    }

    /// As JSON.
    pub fn json(&self, study: &dyn StudyWithDesign) -> Json {
        let asked = study.asked();
        let minimise = asked.map_or(DesignObjective::Amplitude, |asked| asked.minimise);
        let mut fields = study.fields();
        fields.plain("ok", true).plain("sentence", self.sentence(study));
        fields.plain("feasible", self.answer().answer.is_ok());
        fields.plain("waveform", self.waveform().name()).plain("minimise", minimise.name());
        match &self.answer().answer {
            Ok(found) => self.put_feasible(&mut fields, study, found, minimise),
            Err(none) => self.put_infeasible(&mut fields, study, none),
        }
        let basins = self.answer().basins.iter().map(|basin| {
            let mut inner = study.fields();
            inner.plain("parameters", self.by_path(basin.amplitude, &basin.others));
            inner.number("objective", quantity_of(minimise), basin.objective);
            inner
        });
        fields.list("basins", basins.collect::<Vec<_>>());
        let rows = self.waveforms.iter().map(|(waveform, designed)| {
            let mut inner = study.fields();
            inner.plain("waveform", waveform.name()).plain("feasible", designed.answer.is_ok());
            let objective = match &designed.answer {
                Ok(found) => found.critical.objective.clone(),
                Err(none) => Err(self.why(study, none)),
            };
            inner.known("objective", quantity_of(minimise), objective);
            inner
        });
        fields.list("waveforms", rows.collect::<Vec<_>>());
        fields.plain("warnings", self.warnings(study));
        fields.finish()
    }

    fn put_feasible(
        &self,
        fields: &mut Fields,
        study: &dyn StudyWithDesign,
        found: &FeasibleDesign,
        minimise: DesignObjective,
    ) {
        let FeasibleDesign { critical, averaged, verified_amplitude, verified, friction_loss } =
            found;
        fields
            .plain("critical", self.by_path(critical.amplitude, &critical.others))
            .plain("parameters", self.by_path(*verified_amplitude, &critical.others))
            .plain("averaged", self.by_path(averaged.amplitude, &averaged.others))
            .known("objective", quantity_of(minimise), critical.objective.clone())
            .plain("binding", self.binding(critical));
        match &critical.worst {
            Some(worst) => fields.plain("worst", self.point_by_path(worst)),
            None => fields.unknown("worst", "the smallest allowed amplitude is quiet everywhere"),
        };
        fields.number("margin", Quantity::Ratio, MARGIN);
        let start = study.asked().map_or("local", |asked| asked.start.name());
        let mut inner = study.fields();
        inner.plain("protocol", start);
        if let Some(first) = verified.first() {
            inner.number("multiplier", Quantity::Ratio, first.multiplier);
            inner.plain("point", self.point_by_path(&first.point));
        }
        inner.plain("operating_points", verified.len());
        fields.nested("verified", inner);
        fields.known(
            "friction_loss",
            Quantity::Ratio,
            friction_loss.as_ref().map(|(loss, _)| *loss).map_err(Clone::clone),
        );
        let used = critical.used.iter().map(|(quantity, used)| {
            let mut inner = study.fields();
            inner.plain("limit", quantity.name()).known("used", Quantity::Ratio, used.clone());
            inner
        });
        fields.list("limits", used.collect::<Vec<_>>());
        fields.list("frontier", self.frontier(study));
    }

    fn put_infeasible(
        &self,
        fields: &mut Fields,
        study: &dyn StudyWithDesign,
        none: &InfeasibleDesign,
    ) {
        let why = self.why(study, none);
        for name in ["critical", "averaged", "objective"] {
            fields.unknown(name, why.clone());
        }
        if let NoDesign::NeverQuiet { point } | NoDesign::Limit { point: Some(point), .. } =
            &none.why
        {
            fields.plain("worst", self.point_by_path(point));
        }
        match &none.covered {
            Ok(part) => {
                let number = self.over.first();
                let (path, per_unit) =
                    number.map_or(("", 1.0), |number| (number.path.as_str(), number.per_unit));
                let ends = [part.ends.0 * per_unit, part.ends.1 * per_unit];
                fields.plain("covered", serde_json::json!({ path: ends }));
                fields.plain("parameters", self.by_path(part.amplitude, &part.others));
            }
            Err(why) => {
                fields.unknown("covered", why.clone()).unknown("parameters", why.clone());
            }
        }
    }

    /// The objective against each limit, from the choices that were tried by averaging.
    fn frontier(&self, study: &dyn StudyWithDesign) -> Vec<Fields> {
        let Some(asked) = study.asked() else { return Vec::new() };
        let mut rows = Vec::new();
        for (place, (quantity, limit)) in asked.limits.iter().enumerate() {
            for share in FRONTIER {
                let keeps = |point: &&DesignPoint| {
                    point.used.iter().enumerate().all(|(number, (_, used))| {
                        let most = if number == place { share } else { 1.0 };
                        used.as_ref().is_ok_and(|used| *used <= most)
                    })
                };
                let answer = self.answer();
                let tried = answer.tried.iter().filter(keeps);
                let least = tried
                    .filter_map(|point| point.objective.clone().ok())
                    .fold(f64::INFINITY, f64::min);
                let mut inner = study.fields();
                inner.plain("limit", quantity.name());
                let value = if *quantity == LimitedQuantity::MinimumNormalLoad {
                    limit / share
                } else {
                    limit * share
                };
                inner.number("value", quantity_of_limit(*quantity), value);
                let least = if least.is_finite() {
                    Ok(least)
                } else {
                    Err("no choice keeps this limit".to_owned())
                };
                inner.known("objective", quantity_of(asked.minimise), least);
                rows.push(inner);
            }
        }
        rows
    }
}
