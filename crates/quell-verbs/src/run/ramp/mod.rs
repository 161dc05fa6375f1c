//! `bifurcation --ramp`: one run in which a drive, a load or the amplitude of a dither changes slowly, compared with the exact
//! thresholds of the steady study.
//!
//! A run follows the response of the moment with a delay: vibration begins beyond the threshold, by more the faster the ramp, and
//! where responses coexist it ends at another value than it begins at. The thresholds are those of the base response at constant
//! values, of a system without dither those of steady sliding, over the values that the ramp passes. Other numbers are those of the
//! moment of the largest value.

mod courses;

use std::fmt::Write as _;

use quell_dynamics::orbit::{NoOrbit, OrbitVerdict};
use quell_model::profile::Knots;
use quell_model::units::Quantity;
use quell_numerics::interval::RealInterval;
use quell_numerics::order::ascending_by;
use quell_numerics::roots::{Closeness, find_root};
use serde_json::Value as Json;

use super::manoeuvre::{
    Manoeuvre, SampledMotion, VibrationInterval, VibrationLevel, VibrationLimits, vibration_levels,
};
use crate::complaint::{Complaint, Failure, Fault, Origin};
use crate::dataset::Dataset;
use crate::fields::Fields;
use crate::reasons::reasons;
use crate::run::system::in_units;
use crate::study::SystemStudy;

pub use courses::run;

/// Thresholds are searched from this share of the largest value on: there is no sliding at rest.
const LEAST: f64 = 1e-3;

/// A vibration from the start on counts if it lasts longer than this many natural periods.
const TRANSIENT: f64 = 2.0;

/// Switches that a sentence names one by one.
const MOST_SWITCHES: usize = 6;

reasons! {
    /// Why the thresholds over a ramp are unknown.
    pub enum NoRampThresholds {
        /// The steady study was refused, or its thresholds were.
        Failed(Failure),
        /// The base response was not found.
        NoOrbit(NoOrbit),
        ;
        /// Every value of the ramp is zero or negative.
        NoPositiveValues => "the ramp has no positive values",
        /// The base response ends.
        NotCovered => "the base response does not exist over the whole ramp",
    }
}

/// What a ramp changes.
#[derive(Clone, Debug, PartialEq)]
pub struct RampCourse {
    /// Path of the number in the steady study.
    pub path: String,
    /// In words.
    pub words: String,
    /// Its quantity.
    pub quantity: Quantity,
    /// Its course.
    pub knots: Knots,
    /// What the values of the course are multiplied by.
    factor: f64,
}

impl RampCourse {
    /// The only thing in a study that varies by knots.
    ///
    /// # Errors
    /// A complaint if nothing varies, several things do, or an oscillation takes part.
    fn only(mut found: Vec<Self>, oscillates: bool) -> Result<Self, Box<Complaint>> {
        let count = found.len();
        match found.pop() {
            Some(only) if count == 1 && !oscillates && !only.knots.is_constant() => Ok(only),
            _ => {
                let varies = match count {
                    0 => "nothing does in this one".to_owned(),
                    1 => "in this one it is constant, or an oscillation takes part".to_owned(),
                    count => format!("{count} of them do in this one"),
                };
                let allowed = format!(
                    "given for a study in which one drive, load or envelope changes by knots and nothing else varies; {varies}"
                );
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
        self.factor * self.knots.value(time)
    }

    /// Least and largest value.
    pub fn range(&self) -> RealInterval {
        let RealInterval { lower: least, upper: largest } = self.knots.range();
        RealInterval::new(self.factor * least, self.factor * largest)
    }

    /// The times at which it passes a value, and whether it rises there. Between two knots it is monotone.
    fn passes(&self, value: f64) -> Vec<(f64, bool)> {
        let pieces = self.knots.times().windows(2).filter_map(|ends| {
            let (low, high) = (ends[0], ends[1]);
            let rises = self.value(low) < value;
            if rises == (self.value(high) < value) {
                return None;
            }
            let off = |time: f64| self.value(time) - value;
            let root = find_root(off, low, high, Closeness::default()).ok()?;
            Some((root.location, rises))
        });
        pieces.collect()
    }

    /// The time of the last knot.
    fn until(&self) -> f64 {
        self.knots.times().last().copied().unwrap_or_default()
    }

    /// The time of the knot with the largest value.
    fn time_of_largest(&self) -> f64 {
        let knots = self.knots.times().iter().zip(self.knots.values());
        knots.max_by(|a, b| a.1.total_cmp(b.1)).map_or(0.0, |(time, _)| *time)
    }

    /// The values over which thresholds are searched.
    fn searched(&self) -> Result<RealInterval, NoRampThresholds> {
        let RealInterval { lower: least, upper: largest } = self.range();
        let from = least.max(LEAST * largest);
        if from >= largest {
            return Err(NoRampThresholds::NoPositiveValues);
        }
        Ok(RealInterval::new(from, largest))
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

/// A moment at which a ramp passes a value where the stability of the steady study changes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RampCrossing {
    /// Time.
    pub time: f64,
    /// The value.
    pub value: f64,
    /// Whether the base response becomes stable in the direction in which the ramp moves.
    pub to_quiet: bool,
}

/// A value at which the stability of the steady study changes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RampThreshold {
    /// The value of the ramp.
    pub value: f64,
    /// Name of the bifurcation.
    pub kind: &'static str,
    /// What the response is beyond it.
    pub becomes: &'static str,
}

/// The observed motion along a ramp.
#[derive(Clone, Debug)]
pub struct RampedMotion {
    /// Times of equal steps.
    pub times: Vec<f64>,
    /// The observed displacement.
    pub displacement: Vec<f64>,
    /// The observed velocity; `None` of first-order equations.
    pub velocity: Option<Vec<f64>>,
    /// The natural period.
    pub period: f64,
    /// The period of the slowest dither, whose motion is no vibration.
    pub fast: Option<f64>,
}

impl RampedMotion {
    /// The slow vibration over time.
    pub fn levels(&self) -> Vec<VibrationLevel> {
        let [first, second, ..] = self.times[..] else { return Vec::new() };
        let displacement = &self.displacement;
        let sampled = SampledMotion { start: first, step: second - first, displacement };
        vibration_levels(sampled, self.period, self.fast)
    }
}

/// A ramp and the thresholds that it passes.
#[derive(Clone, Debug)]
pub struct Ramp {
    /// What changes.
    pub ramped: RampCourse,
    /// When the run vibrates.
    pub manoeuvre: Option<Manoeuvre>,
    /// Time at the end of the run.
    pub until: f64,
    /// The motion.
    pub motion: RampedMotion,
    /// When it begins and ceases to vibrate.
    pub switches: Vec<RampSwitch>,
    /// Exact thresholds at constant values, ascending, or why they are unknown.
    pub thresholds: Result<Vec<RampThreshold>, NoRampThresholds>,
    /// Warnings about the run.
    pub warnings: Vec<String>,
}

impl Ramp {
    /// The levels from which vibration counts, and below which it has ended.
    pub fn limits(&self) -> Option<VibrationLimits> {
        self.manoeuvre.as_ref().and_then(|manoeuvre| manoeuvre.limits)
    }

    fn new(
        ramped: RampCourse,
        (manoeuvre, until): (Option<Manoeuvre>, f64),
        motion: RampedMotion,
        thresholds: Result<Vec<RampThreshold>, NoRampThresholds>,
        warnings: Vec<String>,
    ) -> Self {
        let transient = TRANSIENT * motion.period;
        let found = manoeuvre.as_ref();
        let switches = found.map(|found| switches(found, &ramped, transient)).unwrap_or_default();
        Self { ramped, manoeuvre, until, motion, switches, thresholds, warnings }
    }

    /// The moments at which the ramp passes a threshold, in order.
    fn crossings(&self) -> Vec<RampCrossing> {
        let known = self.thresholds.iter().flatten();
        let mut crossings: Vec<RampCrossing> = known
            .flat_map(|threshold| {
                let above = threshold.becomes;
                let is_known = [OrbitVerdict::Stable, OrbitVerdict::Unstable]
                    .iter()
                    .any(|verdict| verdict.name() == above);
                let passed = is_known.then(|| self.ramped.passes(threshold.value));
                passed.into_iter().flatten().map(move |(time, rises)| RampCrossing {
                    time,
                    value: threshold.value,
                    to_quiet: (above == OrbitVerdict::Stable.name()) == rises,
                })
            })
            .collect();
        ascending_by(&mut crossings, |a| a.time);
        crossings
    }

    /// The threshold that belongs to a switch: the last one before it if the base response changes there as the run does at the
    /// switch, which is late then; else the next one that does so, before which the run jumps early.
    ///
    /// # Errors
    /// Why none belongs to it.
    pub fn threshold_of(&self, switch: &RampSwitch) -> Result<RampCrossing, &'static str> {
        let crossings = self.crossings();
        let (before, after) =
            crossings.split_at(crossings.partition_point(|crossing| crossing.time <= switch.time));
        let is_alike = |crossing: &&RampCrossing| crossing.to_quiet == switch.to_quiet;
        let found = before.last().filter(is_alike).or_else(|| after.iter().find(is_alike)).copied();
        found.ok_or(if self.thresholds.as_ref().is_ok_and(|known| !known.is_empty()) {
            "the ramp passes no threshold at which the base response changes like this"
        } else {
            "no exact threshold is known over the ramp"
        })
    }

    fn switch_in_words(&self, switch: &RampSwitch, in_its_unit: impl Fn(f64) -> String) -> String {
        let becomes = if switch.to_quiet { "ceases" } else { "begins" };
        let mut text = format!("{becomes} to vibrate at {}", in_its_unit(switch.value));
        if let Ok(threshold) = self.threshold_of(switch) {
            let order = if threshold.time <= switch.time { "after" } else { "before" };
            let _ = write!(text, " ({order} the exact threshold {})", in_its_unit(threshold.value));
        }
        text
    }

    /// What happens along the ramp, in a few sentences.
    pub fn sentence(&self, study: &SystemStudy) -> String {
        let in_words = |quantity, value| in_units(study.units(), quantity, value);
        let RampCourse { words, quantity, .. } = &self.ramped;
        let in_its_unit = |value: f64| in_words(*quantity, value);
        let RealInterval { lower: least, upper: largest } = self.ramped.range();
        let mut text = format!(
            "While the {words} moves between {} and {} until {}, ",
            in_its_unit(least),
            in_its_unit(largest),
            in_words(Quantity::Time, self.ramped.until())
        );
        let transient = TRANSIENT * self.motion.period;
        let vibrates = self.manoeuvre.as_ref().is_some_and(|found| {
            found.vibration.iter().any(|interval| interval.to > found.whole.lower + transient)
        });
        let named = self.switches.iter().take(MOST_SWITCHES);
        let mut each: Vec<String> =
            named.map(|switch| self.switch_in_words(switch, in_its_unit)).collect();
        if let further @ 1.. = self.switches.len().saturating_sub(MOST_SWITCHES) {
            each.push(format!("and so on, {further} more times"));
        }
        let what = "the system";
        let _ = match (each.as_slice(), vibrates) {
            ([], true) => write!(text, "{what} vibrates all the time."),
            ([], false) => write!(text, "{what} does not vibrate."),
            (some, _) => write!(text, "{what} {}.", some.join(", ")),
        };
        if let Err(why) = &self.thresholds {
            let _ = write!(text, " The exact thresholds are unknown: {why}.");
        }
        text
    }

    /// As JSON.
    pub fn json(&self, study: &SystemStudy) -> Json {
        let empty = || Fields::in_units(study.units());
        let quantity = self.ramped.quantity;
        let mut fields = empty();
        let RealInterval { lower: least, upper: largest } = self.ramped.range();
        fields
            .plain("ok", true)
            .plain("sentence", self.sentence(study))
            .plain("parameter", self.ramped.path.as_str())
            .number("least", quantity, least)
            .number("largest", quantity, largest)
            .number("until", Quantity::Time, self.until);
        let switches = self.switches.iter().map(|switch| {
            let mut inner = empty();
            inner
                .number("time", Quantity::Time, switch.time)
                .number("value", quantity, switch.value)
                .plain("becomes", if switch.to_quiet { "quiet" } else { "vibrating" });
            let threshold = self.threshold_of(switch);
            let time = threshold.map(|found| found.time);
            inner.known("threshold", quantity, threshold.map(|found| found.value)).known(
                "threshold_time",
                Quantity::Time,
                time,
            );
            inner
        });
        fields.list("switches", switches.collect::<Vec<_>>());
        match &self.thresholds {
            Ok(known) => {
                let each = known.iter().map(|threshold| {
                    let mut inner = empty();
                    inner
                        .number("value", quantity, threshold.value)
                        .plain("kind", threshold.kind)
                        .plain("becomes", threshold.becomes);
                    inner
                });
                fields.list("thresholds", each.collect::<Vec<_>>());
            }
            Err(why) => {
                fields.unknown("thresholds", why);
            }
        }
        if let Some(found) = &self.manoeuvre {
            fields.nested("manoeuvre", found.fields(empty));
        }
        fields.plain("warnings", self.warnings.clone());
        fields.finish()
    }

    /// The value of the ramp and the motion over time.
    pub fn dataset(&self, study: &SystemStudy) -> Dataset {
        let RampedMotion { times, displacement, velocity, .. } = &self.motion;
        let values = times.iter().map(|time| self.ramped.value(*time)).collect();
        let dataset = Dataset::of(&study.into(), "bifurcation: ramp")
            .fact(self.sentence(study))
            .axis("time", Quantity::Time, times.clone())
            .array("value", self.ramped.quantity, values)
            .array("displacement", Quantity::Displacement, displacement.clone());
        match velocity {
            Some(velocity) => dataset.array("velocity", Quantity::Velocity, velocity.clone()),
            None => dataset,
        }
    }
}

/// When a run begins and ceases to vibrate. A vibration that the start itself excites, and that has decayed within a time
/// `transient`, is no part of the ramp.
fn switches(found: &Manoeuvre, ramped: &RampCourse, transient: f64) -> Vec<RampSwitch> {
    let RealInterval { lower: begin, upper: end } = found.whole;
    let is_transient =
        |interval: &&VibrationInterval| interval.from <= begin && interval.to <= begin + transient;
    let switch = |time: f64, to_quiet| RampSwitch { time, value: ramped.value(time), to_quiet };
    let of = |interval: &VibrationInterval| {
        let begins = (interval.from > begin).then(|| switch(interval.from, false));
        let ends = (interval.to < end).then(|| switch(interval.to, true));
        [begins, ends].into_iter().flatten().collect::<Vec<_>>()
    };
    found.vibration.iter().filter(|interval| !is_transient(interval)).flat_map(of).collect()
}
