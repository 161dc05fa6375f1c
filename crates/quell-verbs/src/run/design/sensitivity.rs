//! How the least amplitude of a design depends on every number of the study, in the units of the study.

use quell_design::least_dither::{DesignStart, LeastAmplitude, LeastAmplitudeSensitivity};
use quell_model::{RefusedNumbers, System, Waveform};
use quell_numerics::interval::RealInterval;
use quell_numerics::order::descending_by;
use serde_json::Value as Json;

use super::found::{AmplitudeRate, DesignNumber, DesignSensitivity, LeastDitherFound};
use super::study_with_design::StudyWithDesign;
use super::unknown::{MOST_NUMBERS, NoAmplitudeRate, NoDesignSensitivity};
use crate::fields::Fields;
use crate::words::{digits, quantity_at};

/// Relative change by which a number is tried: whether the equations contain it, and whether it may vary.
const TRIED: f64 = 1e-3;

/// Tables of a study that do not describe its equations.
const APART: [&str; 7] = ["schema", "title", "sweep", "design", "uncertainty", "observe", "solver"];

/// Every number that a document writes, by its path; entries of lists with a name by their name.
fn written(document: &Json) -> Vec<String> {
    let mut paths = Vec::new();
    for (name, value) in document.as_object().into_iter().flatten() {
        if !APART.contains(&name.as_str()) {
            below(name, value, &mut paths);
        }
    }
    paths
}

fn below(path: &str, value: &Json, paths: &mut Vec<String>) {
    match value {
        Json::Object(table) => {
            for (name, value) in table {
                below(&format!("{path}.{name}"), value, paths);
            }
        }
        Json::Array(list) => {
            for (index, value) in list.iter().enumerate() {
                let name = value.get("name").and_then(Json::as_str);
                let named =
                    name.filter(|_| !path.contains('.')).map(|name| format!("{path}.{name}"));
                let alone = list.len() == 1 && value.is_object();
                let own = if alone { path.to_owned() } else { format!("{path}[{index}]") };
                below(&named.unwrap_or(own), value, paths);
            }
        }
        Json::Number(_) | Json::String(_) => paths.push(path.to_owned()),
        Json::Null | Json::Bool(_) => {}
    }
}

/// The study at its least dither, and one number changed.
struct AtLeast<'a> {
    study: &'a dyn StudyWithDesign,
    waveform: &'a Waveform,
    /// The amplitude, the other design variables and the operating point.
    set: Vec<(&'a str, f64)>,
}

/// A number of the study: its path, its value, and whether it can vary or why not.
type StudyNumber = (String, f64, Result<(), NoAmplitudeRate>);

impl AtLeast<'_> {
    fn with(&self, path: &str, value: f64) -> Result<System, RefusedNumbers> {
        let mut numbers = self.set.clone();
        numbers.push((path, value));
        self.study.system_with(self.waveform, &numbers)
    }

    /// The numbers that the equations contain, with their values: those of the design at their chosen values, then the others that the
    /// study writes. A number that cannot vary comes with the reason.
    fn numbers(&self) -> Result<Vec<StudyNumber>, NoDesignSensitivity> {
        let base = self.study.system_with(self.waveform, &self.set)?;
        let (amplitude, chosen) =
            self.set.split_first().ok_or(NoDesignSensitivity::NothingChosen)?;
        let louder = self.with(amplitude.0, amplitude.1 * (1.0 + TRIED))?;
        let mut found: Vec<StudyNumber> = Vec::new();
        let add = |path: &str, value: f64, found: &mut Vec<StudyNumber>| {
            let moved = self.with(path, value * (1.0 + TRIED));
            match moved.or_else(|_| self.with(path, value * (1.0 - TRIED))) {
                Ok(moved) if moved != base && moved != louder => {
                    found.push((path.to_owned(), value, Ok(())));
                }
                Ok(_) => {}
                Err(why) => found.push((path.to_owned(), value, Err(why.into()))),
            }
        };
        for (path, value) in chosen.iter().filter(|(_, value)| *value != 0.0) {
            add(path, *value, &mut found);
        }
        for path in written(&self.study.document()) {
            let known = found.iter().any(|(known, ..)| *known == path);
            let Some(value) = self.study.number_at(&path) else { continue };
            // A number that the design chooses has another value here, under any key.
            let is_chosen = || self.with(&path, value).is_ok_and(|same| same != base);
            if value != 0.0 && !known && path != amplitude.0 && !is_chosen() {
                add(&path, value, &mut found);
            }
        }
        Ok(found)
    }
}

impl LeastDitherFound {
    /// The derivatives of the least amplitude with respect to the numbers of the study.
    pub(super) fn sensitivity_of(
        &self,
        study: &dyn StudyWithDesign,
    ) -> Result<DesignSensitivity, NoDesignSensitivity> {
        let found =
            self.answer().answer.as_ref().map_err(|_| NoDesignSensitivity::NothingAllowed)?;
        if study.asked().is_some_and(|asked| asked.start != DesignStart::Local) {
            return Err(NoDesignSensitivity::FromStart);
        }
        let critical = &found.critical;
        let worst = critical.worst.as_ref().ok_or(NoDesignSensitivity::QuietEverywhere)?;
        let in_units = |numbers: &[DesignNumber], values: &[f64]| -> Vec<f64> {
            numbers.iter().zip(values).map(|(number, value)| value * number.per_unit).collect()
        };
        let amplitude = critical.amplitude * self.amplitude.per_unit;
        let others = in_units(&self.others, &critical.others);
        let point = in_units(&self.over, worst);
        let over: Vec<RealInterval> = self.over.iter().map(DesignNumber::range_in_units).collect();
        let other_paths = self.others.iter().map(|number| number.path.as_str());
        let over_paths: Vec<&str> = self.over.iter().map(|number| number.path.as_str()).collect();
        let chosen: Vec<(&str, f64)> = other_paths.zip(others).collect();
        let mut set = vec![(self.amplitude.path.as_str(), amplitude)];
        set.extend(&chosen);
        set.extend(over_paths.iter().copied().zip(point.iter().copied()));
        let at_least = AtLeast { study, waveform: self.waveform(), set };
        let mut numbers = at_least.numbers()?;
        for (_, _, may_vary) in numbers.iter_mut().skip(MOST_NUMBERS) {
            *may_vary = Err(NoAmplitudeRate::BeyondMost);
        }
        let vary: Vec<(&str, f64)> = numbers
            .iter()
            .filter(|(_, _, may_vary)| may_vary.is_ok())
            .map(|(path, value, _)| (path.as_str(), *value))
            .collect();
        let at = |amplitude: f64, point: &[f64], values: &[f64]| {
            let mut set = vec![(self.amplitude.path.as_str(), amplitude)];
            set.extend(&chosen);
            set.extend(over_paths.iter().copied().zip(point.iter().copied()));
            let changed = vary.iter().zip(values).filter(|((_, own), value)| own != *value);
            set.extend(changed.map(|((path, _), value)| (*path, *value)));
            study.system_with(self.waveform(), &set)
        };
        let values: Vec<f64> = vary.iter().map(|(_, value)| *value).collect();
        let least =
            LeastAmplitude { at: &at, amplitude, point: &point, over: &over, numbers: &values };
        let LeastAmplitudeSensitivity { kind, meets, derivatives } = least.sensitivity()?;
        let mut derivatives = derivatives.into_iter();
        let rates = numbers.into_iter().map(|(path, value, may_vary)| {
            let rate = may_vary
                .and_then(|()| Ok(derivatives.next().ok_or(NoAmplitudeRate::NotComputed)??));
            AmplitudeRate { path, value, rate }
        });
        Ok(DesignSensitivity { kind, meets, amplitude, rates: rates.collect() })
    }

    /// Adds `sensitivity`, `sensitivity_relative` and `threshold`.
    pub(super) fn put_sensitivity(&self, fields: &mut Fields, study: &dyn StudyWithDesign) {
        let names = ["sensitivity", "sensitivity_relative"];
        let found = match &self.sensitivity {
            Ok(found) => found,
            Err(why) => {
                for name in names.into_iter().chain(["threshold"]) {
                    fields.unknown(name, why);
                }
                return;
            }
        };
        let scale = |rate: &AmplitudeRate| [1.0, rate.value / found.amplitude];
        for (place, name) in names.into_iter().enumerate() {
            let mut table = serde_json::Map::new();
            for rate in &found.rates {
                let value = rate.rate.as_ref().ok().map(|value| value * scale(rate)[place]);
                let value = value.filter(|value| value.is_finite());
                table.insert(rate.path.clone(), value.into());
                if value.is_none() {
                    let beyond = || "its value is beyond the range of numbers".to_owned();
                    let why = rate.rate.as_ref().err().map_or_else(beyond, ToString::to_string);
                    fields.why(&format!("{name}.{}", rate.path), why);
                }
            }
            let unit = match place {
                0 => format!("{} per unit of the number", study.unit_at(&self.amplitude.path)),
                _ => "1".to_owned(),
            };
            fields.measured(name, &unit, table);
        }
        let mut inner = study.fields();
        inner.plain("kind", found.kind.name());
        match found.meets {
            Some(other) => inner.plain("meets", other.name()),
            None => inner.unknown("meets", "no other threshold meets it there"),
        };
        fields.nested("threshold", inner);
    }

    /// The two numbers on which the least amplitude depends most, in a sentence; `None` where they are unknown.
    pub(super) fn sensitivity_in_words(&self) -> Option<String> {
        let found = self.sensitivity.as_ref().ok()?;
        let mut most: Vec<(&str, f64)> = found
            .rates
            .iter()
            .filter_map(|rate| {
                let relative = rate.rate.as_ref().ok()? * rate.value / found.amplitude;
                Some((rate.path.as_str(), relative))
            })
            .collect();
        descending_by(&mut most, |a| a.1.abs());
        let words: Vec<String> = most
            .iter()
            .take(2)
            .map(|(path, relative)| {
                let change = if *relative < 0.0 { "less" } else { "more" };
                format!("{} % {change} for 1 % more {}", digits(relative.abs()), quantity_at(path))
            })
            .collect();
        (!words.is_empty()).then(|| format!("It needs {}.", words.join(", and ")))
    }
}
