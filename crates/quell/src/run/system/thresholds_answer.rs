//! The answer of `thresholds` of a dithered system in sentences and JSON.

use quell_dynamics::motion::orbit::{
    MOST_PERIODS, MotionThreshold, MotionThresholds as Local, RunOutcome, RunSwitches,
};
use quell_dynamics::orbit::OrbitVerdict;
use quell_dynamics::orbit::threshold::{BranchEnding, ThresholdKind};
use quell_model::units::Quantity;
use serde_json::Value as Json;

use super::curves::{kind_in_words, put_contacts};
use super::in_units;
use super::start::{state_names, state_quantity};
use super::thresholds::MotionThresholdsFound;
use super::thresholds::STEPS_TRIED;
use crate::dataset::{Array, Dataset};
use crate::fields::Fields;
use crate::run::criticality;
use crate::run::thresholds::side;
use crate::study::SystemStudy;
use crate::words::{capital, digits, plural};

/// Word of the ending of a branch.
fn ending_name(ending: BranchEnding) -> &'static str {
    match ending {
        BranchEnding::Covered => "covered",
        BranchEnding::TurnedBack { .. } => "turned-back",
        BranchEnding::LostTurning { .. } | BranchEnding::Lost { .. } => "lost",
        BranchEnding::Touch { .. } => "grazing",
    }
}

/// The last value of a branch that does not cover the window.
fn end_of(ending: BranchEnding) -> Option<f64> {
    match ending {
        BranchEnding::Covered => None,
        BranchEnding::TurnedBack { at }
        | BranchEnding::Touch { at }
        | BranchEnding::Lost { at } => Some(at),
        BranchEnding::LostTurning { furthest, .. } => Some(furthest),
    }
}

impl MotionThresholdsFound {
    /// A value of the parameter with its unit.
    pub fn value(&self, study: &SystemStudy, value: f64) -> String {
        let unit = study.unit_of(&self.request.parameter).filter(|unit| *unit != "1");
        format!("{}{}", digits(value), unit.map_or(String::new(), |unit| format!(" {unit}")))
    }

    /// The outcome of a run in words. A dither in the band of the vibration itself cannot quench it.
    pub fn words(&self, outcome: &RunOutcome) -> &'static str {
        match (outcome.is_in_step(), self.in_band) {
            (Some(true), false) => "quenched",
            (Some(true), true) => "in step with the dither",
            (Some(false), false) => "not quenched",
            (Some(false), true) => "not in step with the dither",
            (None, _) => "unknown",
        }
    }

    /// The name of the motion that is followed.
    pub fn subject(&self) -> &'static str {
        if self.request.near.is_some() { "the periodic motion" } else { "the base response" }
    }

    /// Where the motion is stable, and where runs change, in a few sentences.
    pub fn sentence(&self, study: &SystemStudy) -> String {
        let mut sentences = vec![match &self.local {
            Ok(local) => self.of_local(study, local),
            Err(why) => {
                let from = self.value(study, self.request.window.0);
                let path = &self.request.parameter;
                format!("At {path} = {from} there is no base response: {why}.")
            }
        }];
        if self.resumes {
            let to = self.value(study, self.request.window.1);
            sentences.push(format!(
                "At {} = {to} a base response exists again: begin the range beyond the gap to find its thresholds.",
                self.request.parameter
            ));
        }
        let runs = self.runs.iter();
        sentences.extend(
            runs.map(|(protocol, switches)| self.of_run(study, &protocol.words(study), switches)),
        );
        sentences.join(" ")
    }

    fn of_local(&self, study: &SystemStudy, local: &Local) -> String {
        let path = &self.request.parameter;
        let (from, to) = self.request.window;
        let subject = self.subject();
        let first = local
            .branch
            .first()
            .map_or("unknown", |point| OrbitVerdict::of(point.radius, 0.0).name());
        let furthest = end_of(local.ending);
        let change = |threshold: &MotionThreshold| {
            let criticality = threshold.first_lyapunov.map_err(|why| why.to_string());
            let kind = kind_in_words(study, threshold.kind, &threshold.contacts)
                + &criticality::clause(&criticality, ", ", "")
                + &criticality::opening_clause(&threshold.fold, ", ", path);
            let at = format!("at {path} = {} ({kind})", self.value(study, threshold.value));
            match (threshold.was, threshold.becomes) {
                (Some(_), Some(verdict)) => format!("becomes {} {at}", verdict.name()),
                _ if threshold.kind == ThresholdKind::Fold => format!("turns back {at}"),
                _ => format!("ends {at}"),
            }
        };
        let changes: Vec<String> = local.thresholds.iter().map(change).collect();
        let whole = capital(subject);
        let mut text = if changes.is_empty() {
            let until = self.value(study, furthest.unwrap_or(to));
            format!("{whole} is {first} at every {path} from {} to {until}", digits(from))
        } else {
            format!(
                "{whole} is {first} at {path} = {} and {}",
                self.value(study, from),
                changes.join(", ")
            )
        };
        if changes.is_empty() && furthest.is_none() {
            text += " (no threshold in this range)";
        }
        let ends_there = local.thresholds.last().is_some_and(|last| {
            (last.was.is_none() || last.becomes.is_none())
                && furthest.is_some_and(|at| (at - last.value).abs() <= 1e-6 * at.abs())
        });
        match furthest.filter(|_| !ends_there) {
            Some(at) => format!(
                "{text}. It could not be followed beyond {path} = {}.",
                self.value(study, at)
            ),
            None => format!("{text}."),
        }
    }

    fn of_run(&self, study: &SystemStudy, start: &str, switches: &RunSwitches) -> String {
        let path = &self.request.parameter;
        let (from, to) = self.request.window;
        let first = self.words(&switches.first);
        let ramp = match self.request.ramp {
            0.0 => String::new(),
            ramp => {
                let time = in_units(study.units(), Quantity::Time, ramp);
                format!(" with the dither ramped up over {time}")
            }
        };
        let start = &format!("{start}{ramp}");
        if switches.changes.is_empty() {
            let to = self.value(study, to);
            return format!(
                "A run {start} is {first} at every {path} from {} to {to}.",
                digits(from)
            );
        }
        let changes = switches.changes.iter().map(|change| {
            let error = match change.kind {
                Some(kind) => format!(" ({})", kind.name()),
                None => format!(" ± {}", digits(change.error)),
            };
            let value = self.value(study, change.value);
            format!("{} from {path} = {value}{error} on", self.words(&change.becomes))
        });
        let changes = changes.collect::<Vec<_>>().join(", ");
        format!("A run {start} is {first} at {path} = {}, {changes}.", self.value(study, from))
    }

    /// Warnings: those of the study, and values at which the outcome of a run is unknown.
    pub fn warnings(&self, study: &SystemStudy) -> Vec<String> {
        let path = &self.request.parameter;
        let unknown = self.runs.iter().filter_map(|(protocol, switches)| {
            let (value, why) = switches.unknown.first()?;
            let more = match switches.unknown.len() - 1 {
                0 => String::new(),
                more => format!("; it is also unknown at {more} more value{}", plural(more)),
            };
            let (start, value) = (protocol.words(study), self.value(study, *value));
            Some(format!(
                "the outcome of the run {start} at {path} = {value} is unknown: {why}{more}"
            ))
        });
        study.warnings().iter().cloned().chain(unknown).collect()
    }

    /// As JSON.
    pub fn json(&self, study: &SystemStudy) -> Json {
        let (from, to) = self.request.window;
        let unit = study.unit_of(&self.request.parameter).unwrap_or("1");
        let mut fields = Fields::of_system(study.units());
        fields
            .plain("ok", true)
            .plain("sentence", self.sentence(study))
            .plain("protocol", "local: Floquet multipliers of the periodic motion")
            .plain("parameter", self.request.parameter.clone())
            .measured("from", unit, from)
            .measured("to", unit, to)
            .plain("state_names", state_names(study.system()))
            .plain("resumes", self.resumes);
        match &self.local {
            Ok(local) => {
                fields
                    .plain("covered", local.ending == BranchEnding::Covered)
                    .plain("ending", ending_name(local.ending));
                if let Some(at) = end_of(local.ending) {
                    fields.measured("furthest", unit, at);
                }
                let found = local.thresholds.iter().map(|found| put(study, unit, found));
                let found: Vec<Fields> = found.collect();
                // The name of the list in the answer about a belt, and that of a system.
                fields.list("local", found.clone()).list("thresholds", found);
            }
            Err(why) => {
                fields.plain("covered", false).unknown("ending", why.to_string());
                fields.list("local", Vec::new()).list("thresholds", Vec::new());
            }
        }
        self.put_runs(&mut fields, study, unit);
        fields.plain("warnings", self.warnings(study));
        fields.finish()
    }

    fn put_runs(&self, fields: &mut Fields, study: &SystemStudy, unit: &str) {
        let mut at_from = Fields::of_system(study.units());
        if let Ok(local) = &self.local
            && let Some(point) = local.branch.first()
        {
            at_from.plain("verdict", OrbitVerdict::of(point.radius, 0.0).name());
        }
        for (protocol, switches) in &self.runs {
            at_from.plain(protocol.name(), self.words(&switches.first));
            let changes = switches.changes.iter().map(|change| {
                let mut inner = Fields::of_system(study.units());
                inner
                    .measured("value", unit, change.value)
                    .measured("error", unit, change.error)
                    .plain("becomes", self.words(&change.becomes));
                match change.kind {
                    Some(kind) => inner.plain("kind", kind.name()),
                    None => inner.unknown("kind", "the run changes to another motion there"),
                };
                inner
            });
            fields.list(protocol.name(), changes);
        }
        fields.nested("at_from", at_from);
        if !self.runs.is_empty() {
            fields.plain("values_tried", STEPS_TRIED + 1).plain("most_periods", MOST_PERIODS);
            if self.request.ramp > 0.0 {
                fields.number("ramp", Quantity::Time, self.request.ramp);
            }
        }
    }
}

/// One threshold; `unit` is that of the parameter.
fn put(study: &SystemStudy, unit: &str, found: &MotionThreshold) -> Fields {
    let mut fields = Fields::of_system(study.units());
    fields
        .measured("value", unit, found.value)
        .measured("error", unit, found.error)
        .plain("kind", found.kind.name())
        .plain("was", side(found.was))
        .plain("becomes", side(found.becomes))
        .plain("state", found.state.clone());
    put_contacts(&mut fields, study, &found.contacts);
    let names = ["radius_below", "radius_above"];
    for (name, radius) in names.into_iter().zip(found.radii) {
        match radius {
            Some(radius) => fields.plain(name, radius),
            None => fields.unknown(name, "the motion does not exist on this side"),
        };
    }
    let length = study.units().unit(Quantity::Displacement).unwrap_or("1");
    criticality::put_fold(&mut fields, [unit, length], &found.fold);
    let found = found.first_lyapunov.map_err(|why| why.to_string());
    criticality::put(&mut fields, length, &found);
    fields
}

impl MotionThresholdsFound {
    /// The motions of the branch: parameter, modulus of the deciding multiplier and state.
    pub fn dataset(&self, study: &SystemStudy) -> Option<Dataset> {
        let branch = &self.local.as_ref().ok()?.branch;
        let path = &self.request.parameter;
        let unit = study.unit_of(path).unwrap_or("1");
        let rows = (0..branch.len()).map(|row| row as f64).collect();
        let dataset = Dataset::of(&study.into(), "thresholds")
            .fact(format!("parameter: {path}"))
            .with_axis(Array::new("point", "1", rows))
            .with(Array::new("parameter", unit, branch.iter().map(|point| point.value).collect()))
            .with(Array::new("radius", "1", branch.iter().map(|point| point.radius).collect()));
        let names = state_names(study.system()).into_iter().enumerate();
        Some(names.fold(dataset, |dataset, (place, name)| {
            let quantity = state_quantity(study.system(), place);
            let unit = quantity.and_then(|quantity| study.units().unit(quantity)).unwrap_or("1");
            let values = branch.iter().map(|point| point.state[place]).collect();
            dataset.with(Array::new(format!("state.{name}"), unit, values))
        }))
    }
}
