//! `design`: the least dither that is quiet over a box of operating points, under limits.

mod answer;
mod drive;
mod frontier;
mod schedule;
mod sensitivity;

pub(crate) use answer::quantity_of;
pub use sensitivity::{AmplitudeRate, DesignSensitivity};

use std::f64::consts::TAU;

use quell_design::actuator::Actuator;
use quell_design::least_dither::{
    BeltPlant, DesignProblem, DesignStart, Designed, LimitedQuantity, OperatingPoint, Plant,
    ScheduledDither, SystemAtPoint, SystemPlant, design,
};
use quell_dynamics::simulation::within;
use quell_linear::averaging::DitheredSystem;
use quell_model::disc::DiscDither;
use quell_model::profile::{Profile, Wave};
use quell_model::units::Quantity;
use quell_model::{Belt, Dither, Parametrisation, System, Waveform};
use rayon::prelude::*;
use serde_json::Value as Json;

use super::varied::Named;
use crate::complaint::{Complaint, Failure, Fault, Origin};
use crate::contact_state::{averaged_without_states, refused_of_belt};
use crate::effort::STEPS_OF_MANY_SEARCHES;
use crate::fields::Fields;
use crate::run::system::in_units;
use crate::study::vocabulary::resolve;
use crate::study::{BeltStudy, Design, DesignRange, DiscStudy, SystemStudy, SystemUnits};
use crate::words::{digits, in_words};

/// Points of the schedule over a box of one coordinate.
const SCHEDULE: usize = 33;

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
    /// The exact least dither at single operating points of a box of one coordinate: a schedule in place of one dither; or why it has
    /// no points.
    pub schedule: Result<Vec<ScheduledDither>, String>,
    /// Why the averages, which do not know the states of contacts, differ from those with them at the least dither.
    pub without_state: Vec<String>,
    /// For a disc whose box is a range of speeds, the exact thresholds in amplitude at speeds of the range, with the dither of the
    /// answer.
    pub tongues: Vec<(f64, Vec<f64>)>,
    /// How the least amplitude depends on the numbers of the study, or why that is unknown.
    pub sensitivity: Result<DesignSensitivity, String>,
}

impl DesignNumber {
    /// Smallest and largest value in the unit of the path.
    pub(super) fn range_in_units(&self) -> (f64, f64) {
        (self.range.0 * self.per_unit, self.range.1 * self.per_unit)
    }
}

/// A study with a design: its units and what it requests.
pub trait StudyWithDesign: Sync {
    /// The table `[design]`.
    fn asked(&self) -> Option<&Design>;

    /// The table `[actuator]`.
    fn actuator(&self) -> Option<&Actuator>;

    /// An empty answer in the units of the study.
    fn fields(&self) -> Fields;

    /// A quantity of the equations with its unit.
    fn in_words(&self, quantity: Quantity, value: f64) -> String;

    /// How frequencies are written.
    fn frequency_scale(&self) -> FrequencyScale;

    /// The quantity of the amplitude that is chosen.
    fn quantity_of_amplitude(&self) -> Quantity {
        Quantity::Force
    }

    /// The document of the study after its changes.
    fn document(&self) -> Json;

    /// The number at a path, in the unit of its key; `None` where the study has none there.
    fn number_at(&self, path: &str) -> Option<f64>;

    /// The unit of the number at a path; `1` without a unit.
    fn unit_at(&self, path: &str) -> String;

    /// The equations with numbers set in order as by `--set`, and another waveform of the dither that is designed.
    ///
    /// # Errors
    /// Why the study cannot take these numbers, or has no equations of motion.
    fn system_with(&self, waveform: &Waveform, numbers: &[(&str, f64)]) -> Result<System, String>;

    /// What a reader of the answer must know about the dither of the study.
    fn warnings_about_design(&self) -> Vec<String> {
        Vec::new()
    }
}

/// How frequencies of a study are written.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrequencyScale {
    /// Of one in the equations.
    pub factor: f64,
    /// The unit after a number, with a space; empty for a pure number.
    pub unit: &'static str,
    /// What the number is called.
    pub noun: &'static str,
}

impl FrequencyScale {
    /// In hertz, where a frequency of the equations has a value in hertz.
    fn new(hertz: Option<f64>, noun: &'static str) -> Self {
        match hertz {
            Some(factor) => Self { factor, unit: " Hz", noun: "frequency" },
            None => Self { factor: 1.0, unit: "", noun },
        }
    }

    /// A frequency of the equations.
    pub(crate) fn of(self, frequency: f64) -> f64 {
        self.factor * frequency
    }

    /// With its unit.
    pub(crate) fn with_unit(self, frequency: f64) -> String {
        format!("{}{}", digits(self.of(frequency)), self.unit)
    }

    /// With its unit, or with a noun where it has none.
    pub(crate) fn with_noun(self, frequency: f64) -> String {
        if self.unit.is_empty() {
            format!("the {} {}", self.noun, self.with_unit(frequency))
        } else {
            self.with_unit(frequency)
        }
    }
}

impl StudyWithDesign for BeltStudy {
    fn actuator(&self) -> Option<&Actuator> {
        self.actuator()
    }

    fn asked(&self) -> Option<&Design> {
        self.design()
    }

    fn fields(&self) -> Fields {
        Fields::new(self.scales())
    }

    fn in_words(&self, quantity: Quantity, value: f64) -> String {
        in_words(self, quantity, value)
    }

    fn frequency_scale(&self) -> FrequencyScale {
        let hertz = self.scales().map(|scales| scales.si_per_unit(Quantity::FrequencyRatio));
        FrequencyScale::new(hertz, "frequency ratio")
    }

    fn document(&self) -> Json {
        Self::document(self)
    }

    fn number_at(&self, path: &str) -> Option<f64> {
        number_in(&Self::document(self), path)
    }

    fn unit_at(&self, path: &str) -> String {
        let unit = resolve(path).map_or("1", |address| address.key.unit_in_words());
        if unit.is_empty() { "1".to_owned() } else { unit.to_owned() }
    }

    fn system_with(&self, waveform: &Waveform, numbers: &[(&str, f64)]) -> Result<System, String> {
        let study = self.at(numbers.iter().copied()).map_err(|why| why.to_string())?;
        let belt = with_waveform(study.belt(), waveform).map_err(|why| why.to_string())?;
        Ok(belt.system())
    }
}

impl StudyWithDesign for SystemStudy {
    fn actuator(&self) -> Option<&Actuator> {
        self.actuator()
    }

    fn asked(&self) -> Option<&Design> {
        self.design()
    }

    fn fields(&self) -> Fields {
        Fields::of_system(self.units())
    }

    fn in_words(&self, quantity: Quantity, value: f64) -> String {
        in_units(self.units(), quantity, value)
    }

    fn frequency_scale(&self) -> FrequencyScale {
        let hertz = (self.units() != SystemUnits::None).then_some(1.0 / TAU);
        FrequencyScale::new(hertz, "angular frequency")
    }

    fn document(&self) -> Json {
        Self::document(self)
    }

    fn number_at(&self, path: &str) -> Option<f64> {
        self.number(path)
    }

    fn unit_at(&self, path: &str) -> String {
        self.unit_of(path).unwrap_or("1").to_owned()
    }

    fn system_with(&self, waveform: &Waveform, numbers: &[(&str, f64)]) -> Result<System, String> {
        let amplitude = self
            .asked()
            .and_then(|asked| asked.vary.iter().find_map(|range| self.dither_of(&range.path)));
        let system = self.system_at(numbers).map_err(|why| why.to_string())?;
        Ok(system_with_waveform(system, amplitude.unwrap_or(0), waveform))
    }
}

impl StudyWithDesign for DiscStudy {
    /// The dither of a disc varies its friction; no actuator of it is described.
    fn actuator(&self) -> Option<&Actuator> {
        None
    }

    fn asked(&self) -> Option<&Design> {
        self.design()
    }

    /// The amplitude is relative to the friction, and has no SI value.
    fn fields(&self) -> Fields {
        Fields::new(None)
    }

    fn in_words(&self, _: Quantity, value: f64) -> String {
        digits(value)
    }

    fn frequency_scale(&self) -> FrequencyScale {
        FrequencyScale::new(None, "frequency ratio")
    }

    fn quantity_of_amplitude(&self) -> Quantity {
        Quantity::Ratio
    }

    fn warnings_about_design(&self) -> Vec<String> {
        match self.disc().dither() {
            DiscDither::None | DiscDither::Normal { .. } => Vec::new(),
            DiscDither::Tangential { .. } => vec![
                "tangential dither removes the mean friction at every amplitude: dither.amplitude is that of the force that remains, \
                 not of an actuator, and its least value is the quietest; disc.load.slip_ratio gives the force that an actuator needs"
                    .to_owned(),
            ],
        }
    }

    fn document(&self) -> Json {
        Self::document(self)
    }

    fn number_at(&self, _: &str) -> Option<f64> {
        None
    }

    fn unit_at(&self, _: &str) -> String {
        "1".to_owned()
    }

    fn system_with(&self, _: &Waveform, _: &[(&str, f64)]) -> Result<System, String> {
        Err("derivatives are computed of belts and systems, whose thresholds are those of periodic motions".to_owned())
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
/// A complaint about a study without `[design]` or a number in it; runs from afar of a contact with a state.
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
    if !belt.has_contact_state() {
        return Ok(least_dither(study, asked, numbers, &plants));
    }
    is_local(asked, "a contact with a state of its own")?;
    let systems: Vec<(Waveform, Box<SystemAtPoint<'_>>)> = plants
        .iter()
        .map(|(waveform, plant)| {
            let at = move |point: OperatingPoint<'_>, value: f64| plant.system(point, value);
            (waveform.clone(), Box::new(at) as Box<SystemAtPoint<'_>>)
        })
        .collect();
    Ok(least_dither_of_systems(study, asked, numbers, &systems, (0, &[1.0])))
}

/// Rejects runs from afar, which the designs of systems do not judge.
///
/// # Errors
/// A complaint about the start.
pub(crate) fn is_local(asked: &Design, of: &str) -> Result<(), Failure> {
    if asked.start == DesignStart::Local {
        return Ok(());
    }
    let allowed = format!(
        "\"local\": for {of} the base response and its multipliers decide; `thresholds --from-rest` and `--from-squeal` judge runs \
         from afar"
    );
    let name = asked.start.name();
    Err(Complaint::new(Fault::Conflict, "design.start", Origin::Whole, name, allowed).into())
}

/// The least dither of the waveforms of a study, each with its system; `input` is that of the dither, `observe` the row over the
/// coordinates whose response is reported.
pub(crate) fn least_dither_of_systems(
    study: &dyn StudyWithDesign,
    asked: &Design,
    numbers: DesignNumbers,
    systems: &[(Waveform, Box<SystemAtPoint<'_>>)],
    (input, observe): (usize, &[f64]),
) -> LeastDitherFound {
    let plants: Vec<(Waveform, SystemPlant<'_>)> = systems
        .iter()
        .map(|(waveform, at)| (waveform.clone(), SystemPlant { at: at.as_ref(), input, observe }))
        .collect();
    let found = least_dither(study, asked, numbers, &plants);
    let without_state = without_state(&found, systems[found.best].1.as_ref());
    LeastDitherFound { without_state, ..found }
}

/// Why the averages of a design, which do not know the states of contacts, differ from those with them at its least dither.
fn without_state(found: &LeastDitherFound, at: &SystemAtPoint<'_>) -> Vec<String> {
    let Ok(feasible) = &found.answer().answer else { return Vec::new() };
    let critical = &feasible.critical;
    let middle = || found.over.iter().map(|over| 0.5 * (over.range.0 + over.range.1)).collect();
    let point: Vec<f64> = critical.worst.clone().unwrap_or_else(middle);
    let place = OperatingPoint { point: &point, others: &critical.others };
    let Ok(system) = at(place, critical.amplitude) else { return Vec::new() };
    let average = DitheredSystem::new(&system).and_then(|prepared| prepared.average());
    average.map(|average| averaged_without_states(&system, &average.contacts)).unwrap_or_default()
}

/// The least dither of the waveforms of a study, each with its structure.
pub(crate) fn least_dither<P: Plant + Sync>(
    study: &dyn StudyWithDesign,
    asked: &Design,
    numbers: DesignNumbers,
    plants: &[(Waveform, P)],
) -> LeastDitherFound {
    let DesignNumbers { amplitude, others, over } = numbers;
    let ranges = |numbers: &[DesignNumber]| -> Vec<(f64, f64)> {
        numbers.iter().map(|number| number.range).collect()
    };
    let (box_ranges, other_ranges) = (ranges(&over), ranges(&others));
    let actuator = study.actuator();
    let of_actuator = actuator.map(Actuator::limits).into_iter().flatten();
    let of_actuator = of_actuator.map(|limit| (LimitedQuantity::Actuator(limit), 1.0));
    let limits: Vec<_> = asked.limits.iter().copied().chain(of_actuator).collect();
    let problem = |plant| DesignProblem {
        plant,
        objective: asked.minimise,
        amplitude: amplitude.range,
        others: &other_ranges,
        over: &box_ranges,
        limits: &limits,
        actuator,
        start: asked.start,
    };
    let designed = plants.par_iter().map(|(waveform, plant)| {
        (waveform.clone(), within(STEPS_OF_MANY_SEARCHES, || design(problem(plant))))
    });
    let waveforms: Vec<(Waveform, Designed)> = designed.collect();
    let value = |designed: &Designed| match &designed.answer {
        Ok(found) => found.critical.objective.clone().unwrap_or(f64::INFINITY),
        Err(_) => f64::INFINITY,
    };
    let best = (0..waveforms.len())
        .min_by(|a, b| value(&waveforms[*a].1).total_cmp(&value(&waveforms[*b].1)))
        .unwrap_or(0);
    let schedule = match (plants.get(best), box_ranges.as_slice(), &waveforms[best].1.answer) {
        _ if asked.start != DesignStart::Local => {
            Err("runs from a start are judged only where they decide".to_owned())
        }
        (Some((_, plant)), [range], Ok(found)) => {
            Ok(schedule(problem(plant), *range, &found.critical.others))
        }
        (_, [_], _) => Err("no dither is allowed".to_owned()),
        _ => Err("the box of operating points has not exactly one coordinate".to_owned()),
    };
    let (without_state, tongues) = (Vec::new(), Vec::new());
    let sensitivity = Err("no dither is allowed".to_owned());
    let found = LeastDitherFound {
        amplitude,
        others,
        over,
        waveforms,
        best,
        schedule,
        without_state,
        tongues,
        sensitivity,
    };
    let sensitivity = found.sensitivity_of(study);
    LeastDitherFound { sensitivity, ..found }
}

/// The exact least dithers along a box of one coordinate.
fn schedule(problem: DesignProblem<'_>, range: (f64, f64), others: &[f64]) -> Vec<ScheduledDither> {
    let at = |point: f64| within(STEPS_OF_MANY_SEARCHES, || problem.scheduled(&[point], others));
    super::evenly(range, SCHEDULE).into_par_iter().map(at).collect()
}

/// The number at a path of a document; `None` where it has no number there.
fn number_in(document: &Json, path: &str) -> Option<f64> {
    let pointer = path.replace(['.', '['], "/").replace(']', "");
    let whole = document.pointer(&format!("/{pointer}")).and_then(Json::as_f64);
    // The path of an only entry has no index.
    whole.or_else(|| {
        let (table, rest) = pointer.split_once('/')?;
        document.pointer(&format!("/{table}/0/{rest}")).and_then(Json::as_f64)
    })
}

/// The system with another waveform of one dither.
pub(crate) fn system_with_waveform(
    mut system: System,
    input: usize,
    waveform: &Waveform,
) -> System {
    if let Some(input) = system.inputs.get_mut(input)
        && let [wave] = input.profile.waves()
        && wave.waveform != *waveform
    {
        let wave = Wave { waveform: waveform.clone(), ..wave.clone() };
        input.profile = Profile::constant(input.profile.mean()).with(wave);
    }
    system
}

/// The belt with another waveform of its first dither.
fn with_waveform(belt: &Belt, waveform: &Waveform) -> Result<Belt, quell_model::InvalidValues> {
    let mut dithers: Vec<Dither> = belt.dithers().to_vec();
    dithers[0].waveform = waveform.clone();
    belt.dithered_by(dithers)
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
