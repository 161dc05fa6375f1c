//! The answer of `thresholds` as data.

use quell_dynamics::attractor::RunOutcome;
use quell_dynamics::orbit::{
    BranchEnding, MotionSignature, OrbitVerdict, SignatureChange, Threshold,
};
use quell_dynamics::response::BAND_END;
use quell_model::units::Quantity;
use quell_numerics::interval::RealInterval;
use serde_json::Value as Json;

use super::curves::put_contacts;
use super::{TRIED, Thresholds, side};
use crate::dataset::{Array, Dataset};
use crate::fields::Fields;
use crate::run::criticality::{self, NoLyapunovCoefficient};
use crate::run::system::attractor::put_state;
use crate::run::system::of_runs::beyond_laws;
use crate::run::system::start::state_columns;
use crate::run::system::{value_at, value_closely_at};
use crate::study::SystemStudy;
use crate::words::{plural, quantity_at, quantity_is};

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
pub(super) fn end_of(ending: BranchEnding) -> Option<f64> {
    match ending {
        BranchEnding::Covered => None,
        BranchEnding::TurnedBack { at }
        | BranchEnding::Touch { at }
        | BranchEnding::Lost { at } => Some(at),
        BranchEnding::LostTurning { furthest, .. } => Some(furthest),
    }
}

impl Thresholds {
    /// A value of the parameter with its unit.
    pub fn value(&self, study: &SystemStudy, value: f64) -> String {
        value_at(study, &self.request.parameter, value)
    }

    /// The outcome of a run in words. A dither in the band of the vibration itself cannot quench it.
    pub fn words(&self, outcome: &RunOutcome) -> &'static str {
        match (outcome.is_quiet(), self.in_band) {
            (Some(true), false) => "quenched",
            (Some(true), true) => "in step with the dither",
            (Some(false), false) => "not quenched",
            (Some(false), true) => "not in step with the dither",
            (None, _) => "unknown",
        }
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
                "the outcome of the run {start} at the {} is unknown: {why}{more}",
                quantity_is(path, &value)
            ))
        });
        let in_band = (self.in_band && !self.runs.is_empty()).then(|| {
            format!(
                "the dither repeats itself at or below {BAND_END} times the frequency of the vibration, in its band: a run in step with it still \
                 vibrates; `response` gives the remaining amplitude"
            )
        });
        let least = self.silent.iter().copied().fold(f64::INFINITY, f64::min);
        let most = self.silent.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let silent = (!self.silent.is_empty()).then(|| {
            let (least, most) = (self.value(study, least), self.value(study, most));
            format!(
                "at values of the {} between {least} and {most} no squeal was found without dither: the run from the undithered limit \
                 cycle starts from steady sliding there",
                quantity_at(path)
            )
        });
        let beyond = beyond_laws(study, |contact| self.slip[contact]);
        let gaps = self.local.iter().flat_map(|local| &local.gaps).map(|gap| {
            let closely = |value| value_closely_at(study, path, value);
            let ([low, high], grazing) = (gap.ends().map(closely), closely(gap.grazing));
            format!(
                "between {low} and {high} of the {}, next to the grazing at {grazing}, no response was found",
                quantity_at(path)
            )
        });
        study
            .warnings()
            .iter()
            .cloned()
            .chain(gaps)
            .chain(silent)
            .chain(beyond)
            .chain(in_band)
            .chain(unknown)
            .collect()
    }

    /// As JSON.
    pub fn json(&self, study: &SystemStudy) -> Json {
        let RealInterval { lower: from, upper: to } = self.request.window;
        let unit = study.unit_of(&self.request.parameter).unwrap_or("1");
        let mut fields = Fields::in_units(study.units());
        fields
            .plain("ok", true)
            .plain("sentence", self.sentence(study))
            .plain("protocol", "local: Floquet multipliers of the periodic motion")
            .plain("parameter", self.request.parameter.clone())
            .measured("from", unit, from)
            .measured("to", unit, to)
            .plain("state_names", study.system().state_names())
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
                fields.list("local", found);
                let changes = local.changes.iter().map(|change| put_change(study, unit, change));
                fields.list("signature_changes", changes);
                let gaps = local.gaps.iter().map(|gap| {
                    let [low, high] = gap.ends();
                    let mut inner = Fields::in_units(study.units());
                    inner.measured("from", unit, low).measured("to", unit, high);
                    inner
                });
                fields.list("gaps", gaps);
            }
            Err(why) => {
                fields.plain("covered", false).unknown("ending", why.to_string());
                for name in ["local", "signature_changes", "gaps"] {
                    fields.list(name, Vec::new());
                }
            }
        }
        self.put_runs(&mut fields, study, unit);
        fields.plain("warnings", self.warnings(study));
        fields.finish()
    }

    fn put_runs(&self, fields: &mut Fields, study: &SystemStudy, unit: &str) {
        let mut at_from = Fields::in_units(study.units());
        let first = self.local.as_ref().map(|local| local.branch.first());
        match first {
            Ok(Some(point)) => at_from.plain("verdict", OrbitVerdict::of(point.radius, 0.0).name()),
            Ok(None) => at_from.unknown("verdict", "no response was followed"),
            Err(why) => at_from.unknown("verdict", why.to_string()),
        };
        for (protocol, switches) in &self.runs {
            at_from.plain(protocol.name(), self.words(&switches.first));
            let changes = switches.changes.iter().map(|change| {
                let mut inner = Fields::in_units(study.units());
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
            fields.plain("values_tried", TRIED + 1);
            if self.request.ramp > 0.0 {
                fields.number("ramp", Quantity::Time, self.request.ramp);
            }
        }
    }
}

/// One change of the events.
fn put_change(study: &SystemStudy, unit: &str, change: &SignatureChange) -> Fields {
    let words = |side: &Option<MotionSignature>| events_in_words(study, side.as_ref());
    let mut inner = Fields::in_units(study.units());
    inner
        .measured("value", unit, change.value)
        .plain("below", words(&change.below))
        .plain("above", words(&change.above));
    inner
}

/// The events of a response in words; "none" where there is no response.
pub fn events_in_words(study: &SystemStudy, side: Option<&MotionSignature>) -> String {
    let names: Vec<String> =
        study.system().contacts.iter().map(|contact| contact.name.clone()).collect();
    side.map_or_else(|| "none".to_owned(), |events| events.words(&names))
}

/// One threshold; `unit` is that of the parameter.
fn put(study: &SystemStudy, unit: &str, found: &Threshold) -> Fields {
    let mut fields = Fields::in_units(study.units());
    fields
        .measured("value", unit, found.value)
        .measured("error", unit, found.error)
        .plain("kind", found.kind.name())
        .plain("was", side(found.was))
        .plain("becomes", side(found.becomes));
    put_state(&mut fields, study, &found.state);
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
    let found = found.first_lyapunov.map_err(NoLyapunovCoefficient::from);
    criticality::put(&mut fields, length, &found);
    fields
}

impl Thresholds {
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
        let states: Vec<&[f64]> = branch.iter().map(|point| point.state.as_slice()).collect();
        Some(state_columns(dataset, study, &states))
    }
}
