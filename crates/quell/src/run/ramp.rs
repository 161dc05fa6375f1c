//! `bifurcation --ramp`: one run in which the drive, the load or the amplitude of the dither changes slowly, compared with the exact
//! thresholds of the steady study.
//!
//! A run follows the response of the moment with a delay: vibration begins beyond the threshold, by more the faster the ramp, and
//! where responses coexist it ends at another value than it begins at. The thresholds are those of the base response at constant
//! values ([`local`]), over the values that the ramp passes.

use std::fmt::Write as _;

use quell_dynamics::orbit::threshold::{BranchEnding, NoThresholds, Threshold, local};
use quell_dynamics::simulation::{Sample, within};
use quell_model::Belt;
use quell_model::parameter::{BELT_VELOCITY, NORMAL_LOAD};
use quell_model::profile::Knots;
use quell_model::units::Quantity;
use serde_json::Value as Json;

use super::manoeuvre::{Manoeuvre, VibrationInterval};
use super::simulate::{self, NATURAL_PERIOD, Options, Simulation};
use super::thresholds::side;
use crate::complaint::{Complaint, Failure, Fault, Origin};
use crate::contact_state::refused_of_belt;
use crate::dataset::Dataset;
use crate::effort::STEPS_OF_MANY_SEARCHES;
use crate::fields::Fields;
use crate::study::BeltStudy;
use crate::words::in_words;

/// Minimum number of continuation steps over the values of the ramp.
const STEPS: u32 = 40;

/// Thresholds are searched from this share of the largest value on: there is no sliding at rest.
const LEAST: f64 = 1e-3;

/// A vibration from the start on counts if it lasts longer than two natural periods.
const TRANSIENT: f64 = 2.0 * NATURAL_PERIOD;

/// What a ramp changes.
#[derive(Clone, Debug, PartialEq)]
pub struct Ramped {
    /// Path of the number in the steady study.
    pub path: String,
    /// In words.
    pub words: &'static str,
    /// Its quantity.
    pub quantity: Quantity,
    /// Its course.
    pub course: Knots,
    /// What the values of the course are multiplied by.
    factor: f64,
}

impl Ramped {
    /// The only thing in a study that varies by knots.
    ///
    /// # Errors
    /// A complaint if nothing varies, several things do, or an oscillation takes part.
    fn of(belt: &Belt) -> Result<Self, Box<Complaint>> {
        let mut found = Vec::new();
        let mut oscillates = false;
        let given = [
            (belt.drive(), BELT_VELOCITY, "belt velocity"),
            (belt.load(), NORMAL_LOAD, "normal load"),
        ];
        for (profile, parameter, words) in given {
            let Some(profile) = profile else { continue };
            oscillates |= !profile.waves().is_empty();
            if let Some(course) = profile.knots() {
                found.push(Self {
                    path: parameter.path.to_owned(),
                    words,
                    quantity: parameter.quantity,
                    course: course.clone(),
                    factor: 1.0,
                });
            }
        }
        for (index, dither) in belt.dithers().iter().enumerate() {
            if let Some(envelope) = &dither.envelope {
                found.push(Self {
                    path: belt.dither_path(index, "amplitude"),
                    words: "dither amplitude",
                    quantity: Quantity::Force,
                    course: envelope.clone(),
                    factor: dither.amplitude,
                });
            }
        }
        let count = found.len();
        match found.pop() {
            Some(only) if count == 1 && !oscillates && !only.course.is_constant() => Ok(only),
            _ => {
                let allowed = "given for a study in which one drive, load or envelope changes by knots and nothing else varies";
                let origin = Origin::Argument("--ramp");
                Err(Box::new(Complaint::new(
                    Fault::Conflict,
                    "--ramp",
                    origin,
                    Json::Null,
                    allowed,
                )))
            }
        }
    }

    /// The value at a time.
    pub fn value(&self, time: f64) -> f64 {
        self.factor * self.course.value(time)
    }

    /// Least and largest value.
    pub fn range(&self) -> (f64, f64) {
        let (least, largest) = self.course.range();
        (self.factor * least, self.factor * largest)
    }
}

/// A moment at which the run begins or ceases to vibrate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RampSwitch {
    /// Time, found to within half a natural period.
    pub time: f64,
    /// The value of the ramp then.
    pub value: f64,
    /// Whether vibration ends.
    pub to_quiet: bool,
}

/// A ramp and the thresholds that it passes.
#[derive(Clone, Debug)]
pub struct Ramp {
    /// What changes.
    pub ramped: Ramped,
    /// The run to the last knot.
    pub run: Simulation,
    /// When it begins and ceases to vibrate.
    pub switches: Vec<RampSwitch>,
    /// Exact thresholds of the base response at constant values, ascending, or why they are unknown.
    pub thresholds: Result<Vec<Threshold>, String>,
}

/// Runs a ramp from the first knot, or τ = 0, to the last.
///
/// # Errors
/// A complaint about a study that is no ramp; as [`simulate::run`].
pub fn run(study: &BeltStudy) -> Result<Ramp, Failure> {
    refused_of_belt(study, "bifurcation --ramp")?;
    let ramped = Ramped::of(study.belt())?;
    let until = ramped.course.times().last().copied().unwrap_or_default();
    let options = Options { samples: true, ..Options::default() };
    let run = simulate::run(study, until, options)?;
    let switches = run.manoeuvre.as_ref().map(|found| switches(found, &ramped)).unwrap_or_default();
    let thresholds = thresholds(study, &ramped);
    Ok(Ramp { ramped, run, switches, thresholds })
}

/// When a run begins and ceases to vibrate. A vibration that the start itself excites, and that has decayed within
/// [`TRANSIENT`], is no part of the ramp.
fn switches(found: &Manoeuvre, ramped: &Ramped) -> Vec<RampSwitch> {
    let (begin, end) = found.whole;
    let is_transient =
        |interval: &&VibrationInterval| interval.from <= begin && interval.to <= begin + TRANSIENT;
    let switch = |time: f64, to_quiet| RampSwitch { time, value: ramped.value(time), to_quiet };
    let of = |interval: &VibrationInterval| {
        let begins = (interval.from > begin).then(|| switch(interval.from, false));
        let ends = (interval.to < end).then(|| switch(interval.to, true));
        [begins, ends].into_iter().flatten().collect::<Vec<_>>()
    };
    found.vibration.iter().filter(|interval| !is_transient(interval)).flat_map(of).collect()
}

/// Thresholds of the steady belt over the values of the ramp.
fn thresholds(study: &BeltStudy, ramped: &Ramped) -> Result<Vec<Threshold>, String> {
    let (least, largest) = ramped.range();
    let from = least.max(LEAST * largest);
    if from >= largest {
        return Err("the ramp has no positive values".to_owned());
    }
    let belt = study.belt().steady_at(0.0).map_err(|why| why.to_string())?;
    let first = belt.with(&ramped.path, from).map_err(|why| why.to_string())?;
    let found =
        within(STEPS_OF_MANY_SEARCHES, || local(&first, &ramped.path, from, largest, STEPS));
    let found = found.map_err(|why| match why {
        NoThresholds::Invalid { value } => format!("the value {value} is not allowed"),
        NoThresholds::Start(why) => format!("no base response at the least value: {why}"),
        NoThresholds::Lost { at } => format!("the continuation lost the base response at {at}"),
    })?;
    if found.ending != BranchEnding::Covered && found.thresholds.is_empty() {
        return Err("the base response does not exist over the whole ramp".to_owned());
    }
    Ok(found.thresholds)
}

impl Ramp {
    /// The samples of the run.
    pub fn samples(&self) -> &[Sample] {
        self.run.samples.as_deref().unwrap_or_default()
    }

    /// The threshold next to a value.
    pub fn nearest(&self, value: f64) -> Option<&Threshold> {
        let known = self.thresholds.as_ref().ok()?.iter();
        known.min_by(|a, b| (a.value - value).abs().total_cmp(&(b.value - value).abs()))
    }

    /// What happens along the ramp, in a few sentences.
    pub fn sentence(&self, study: &BeltStudy) -> String {
        let Ramped { words, quantity, course, .. } = &self.ramped;
        let in_its_unit = |value: f64| in_words(study, *quantity, value);
        let moment = |time: f64| in_words(study, Quantity::Time, time);
        let (least, largest) = self.ramped.range();
        let until = course.times().last().copied().unwrap_or_default();
        let mut text = format!(
            "While the {words} moves between {} and {} until {}, ",
            in_its_unit(least),
            in_its_unit(largest),
            moment(until)
        );
        let vibrates = self.run.manoeuvre.as_ref().is_some_and(|found| {
            found.vibration.iter().any(|interval| interval.to > found.whole.0 + TRANSIENT)
        });
        let each = self.switches.iter().map(|switch| {
            let becomes = if switch.to_quiet { "ceases" } else { "begins" };
            let mut text = format!("{becomes} to vibrate at {}", in_its_unit(switch.value));
            if let Some(threshold) = self.nearest(switch.value) {
                let _ =
                    write!(text, " (exact threshold next to it: {})", in_its_unit(threshold.value));
            }
            text
        });
        let each: Vec<String> = each.collect();
        let _ = match (each.as_slice(), vibrates) {
            ([], true) => write!(text, "the mass vibrates all the time."),
            ([], false) => write!(text, "the mass does not vibrate."),
            (some, _) => write!(text, "the mass {}.", some.join(", ")),
        };
        if let Err(why) = &self.thresholds {
            let _ = write!(text, " The exact thresholds are unknown: {why}.");
        }
        text
    }

    /// Warnings about the run.
    pub fn warnings(&self, study: &BeltStudy) -> Vec<String> {
        self.run.warnings(study)
    }

    /// As JSON.
    pub fn json(&self, study: &BeltStudy) -> Json {
        let empty = || Fields::new(study.scales());
        let quantity = self.ramped.quantity;
        let mut fields = empty();
        let (least, largest) = self.ramped.range();
        fields
            .plain("ok", true)
            .plain("sentence", self.sentence(study))
            .plain("parameter", self.ramped.path.as_str())
            .number("least", quantity, least)
            .number("largest", quantity, largest)
            .number("until", Quantity::Time, self.run.end.time);
        let switches = self.switches.iter().map(|switch| {
            let mut inner = empty();
            inner
                .number("time", Quantity::Time, switch.time)
                .number("value", quantity, switch.value)
                .plain("becomes", if switch.to_quiet { "quiet" } else { "vibrating" });
            let nearest = self.nearest(switch.value).map(|threshold| threshold.value);
            let why = "no exact threshold is known over the ramp".to_owned();
            inner.known("threshold", quantity, nearest.ok_or(why));
            inner
        });
        fields.list("switches", switches.collect::<Vec<_>>());
        match &self.thresholds {
            Ok(known) => {
                let each = known.iter().map(|threshold| {
                    let mut inner = empty();
                    inner
                        .number("value", quantity, threshold.value)
                        .plain("kind", threshold.kind.name())
                        .plain("becomes", side(threshold.becomes));
                    inner
                });
                fields.list("thresholds", each.collect::<Vec<_>>());
            }
            Err(why) => {
                fields.unknown("thresholds", why.as_str());
            }
        }
        if let Some(found) = &self.run.manoeuvre {
            fields.nested("manoeuvre", found.fields(empty));
        }
        fields.plain("warnings", self.warnings(study));
        fields.finish()
    }

    /// The value of the ramp and the motion over time.
    pub fn dataset(&self, study: &BeltStudy) -> Dataset {
        let column =
            |of: &dyn Fn(&Sample) -> f64| self.samples().iter().map(of).collect::<Vec<f64>>();
        Dataset::new(study, "bifurcation: ramp")
            .fact(self.sentence(study))
            .axis("time", Quantity::Time, column(&|sample| sample.time))
            .array("value", self.ramped.quantity, column(&|sample| self.ramped.value(sample.time)))
            .array("displacement", Quantity::Displacement, column(&|sample| sample.displacement))
            .array("velocity", Quantity::Velocity, column(&|sample| sample.velocity))
    }
}
