//! A finished map: its numbers and their summary, as JSON and as a dataset.

use std::collections::BTreeMap;
use std::time::Duration;

use quell_model::units::Quantity;
use serde_json::{Map as Object, Value as Json, json};

use crate::dataset::{Array, Dataset};
use crate::run::system::in_units;
use crate::status::Status;
use crate::sweep::{Content, Data, Plan, VariableArrays};
use crate::words::plural;

/// A finished map.
#[derive(Clone, Debug)]
pub struct FinishedMap {
    pub(super) plan: Plan,
    pub(super) arrays: Vec<Data>,
    /// Points that were already in the store.
    pub resumed: usize,
    /// Damaged chunks of the store that were recomputed.
    pub damaged: usize,
    /// How long it took.
    pub elapsed: Duration,
}

/// A value and its point.
#[derive(Clone, Debug, PartialEq)]
pub struct Extreme {
    /// The value, in SI if the study is in SI.
    pub value: f64,
    /// Values of the axes there.
    pub place: Vec<f64>,
}

/// Summary of a variable over the map.
#[derive(Clone, Debug)]
pub struct Summary {
    /// Smallest value, the first of equal ones; `None` for words, or if no value is known.
    pub least: Option<Extreme>,
    /// Largest value.
    pub most: Option<Extreme>,
    /// Number of points of each word, in the order of the codes; empty for numbers.
    pub words: Vec<(&'static str, usize)>,
    /// Number of points of each status.
    pub states: BTreeMap<Status, usize>,
}

impl FinishedMap {
    /// What was computed.
    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    /// Status of a variable at a point.
    pub fn status(&self, entry: &VariableArrays, point: usize) -> Status {
        match &self.arrays[entry.status] {
            Data::Codes(codes) => Status::of_code(codes[point]).unwrap_or(Status::Missing),
            Data::Numbers(_) => Status::Missing,
        }
    }

    /// Value of a variable at a point, in the units of the study; for a word its code.
    pub fn number(&self, entry: &VariableArrays, point: usize) -> Option<f64> {
        let known = self.status(entry, point).has_number();
        known.then(|| match &self.arrays[entry.value] {
            Data::Numbers(values) => values[point],
            Data::Codes(codes) => f64::from(codes[point]),
        })
    }

    /// Summary of each variable, in the order of the sheet's entries.
    pub fn summaries(&self) -> Vec<Summary> {
        self.plan.sheet().entries().iter().map(|entry| self.summary(entry)).collect()
    }

    fn summary(&self, entry: &VariableArrays) -> Summary {
        let grid = self.plan.grid();
        let mut states: BTreeMap<Status, usize> = BTreeMap::new();
        let mut least: Option<(f64, usize)> = None;
        let mut most = least;
        let numbers = self.plan.sheet().fields()[entry.value].content == Content::Numbers;
        for point in 0..grid.len() {
            *states.entry(self.status(entry, point)).or_default() += 1;
            let Some(value) = self.number(entry, point).filter(|_| numbers) else {
                continue;
            };
            if least.is_none_or(|(lowest, _)| value < lowest) {
                least = Some((value, point));
            }
            if most.is_none_or(|(highest, _)| value > highest) {
                most = Some((value, point));
            }
        }
        let content = &self.plan.sheet().fields()[entry.value].content;
        let words = match (content, &self.arrays[entry.value]) {
            (Content::Codes(meanings), Data::Codes(codes)) => {
                let mut counts = [0_usize; 256];
                for code in codes {
                    counts[usize::from(*code)] += 1;
                }
                let counted =
                    meanings.iter().map(|(code, word)| (*word, counts[usize::from(*code)]));
                counted.filter(|(_, count)| *count > 0).collect()
            }
            _ => Vec::new(),
        };
        let extreme = |found: Option<(f64, usize)>| {
            found.map(|(value, point)| Extreme { value, place: grid.values_at(point) })
        };
        Summary { least: extreme(least), most: extreme(most), words, states }
    }

    /// Warnings about the study and the result.
    pub fn warnings(&self) -> Vec<String> {
        let study = self.plan.grid().study();
        let mut warnings = match study.disc() {
            Ok(disc) => disc.warnings().to_vec(),
            Err(_) => study.system().warnings().to_vec(),
        };
        let entries = self.plan.sheet().entries();
        if let Some(settled) = entries.iter().find(|entry| entry.variable.name == "settled") {
            let points = 0..self.plan.grid().len();
            let not = points.filter(|point| self.number(settled, *point) == Some(0.0)).count();
            if not > 0 {
                let have = if not == 1 { "has" } else { "have" };
                warnings.push(format!(
                    "{not} of {} points {have} not settled (see `settled`): `response --settle` has one point after a longer time",
                    self.plan.grid().len()
                ));
            }
        }
        let doubtful = [Status::Opens, Status::BeyondRange, Status::WithoutState];
        warnings.extend(doubtful.into_iter().filter_map(|status| self.points_with(status)));
        if self.damaged > 0 {
            warnings.push(recomputed(self.damaged));
        }
        warnings
    }

    /// A warning about the points at which some value has a status.
    fn points_with(&self, status: Status) -> Option<String> {
        let entries = self.plan.sheet().entries();
        let all = self.plan.grid().len();
        let at = |point: &usize| entries.iter().any(|entry| self.status(entry, *point) == status);
        let count = (0..all).filter(at).count();
        (count > 0).then(|| {
            let name = status.name();
            format!(
                "{count} of {all} points: {}{}; the status there is {name}",
                status.about(),
                if status == Status::BeyondRange { self.ranges() } else { String::new() },
            )
        })
    }

    /// The ranges of the friction laws for the study's own values.
    fn ranges(&self) -> String {
        let study = self.plan.grid().study().system();
        let ranges = study.system().contacts.iter().filter_map(|contact| {
            let (range, law) = (contact.friction.range()?, contact.friction.kind().name());
            let upper = in_units(study.units(), Quantity::Velocity, range.upper);
            Some(format!("{law} up to {upper} ({})", range.limit))
        });
        let ranges: Vec<String> = ranges.collect();
        format!(", of the study itself {}", ranges.join(" and "))
    }

    /// As JSON: arrays nested like the axes.
    pub fn json(&self) -> Json {
        let mut object = self.facts();
        let grid = self.plan.grid();
        let shape = grid.shape();
        let fields = self.plan.sheet().fields();
        for entry in self.plan.sheet().entries() {
            let values = (0..grid.len()).map(|point| self.cell(entry, point));
            object[fields[entry.value].name.as_str()] = nested(&shape, values.collect());
            let states = (0..grid.len()).map(|point| self.status(entry, point).name().into());
            object[fields[entry.status].name.as_str()] = nested(&shape, states.collect());
        }
        object
    }

    /// As JSON without the arrays: axes, units, and how many points are known.
    pub fn facts(&self) -> Json {
        let grid = self.plan.grid();
        let mut object = Object::new();
        object.insert("ok".into(), true.into());
        let axes: Vec<Json> = grid
            .axes()
            .iter()
            .map(|axis| {
                json!({
                    "parameter": axis.path,
                    "name": axis.name,
                    "unit": axis.unit,
                    "values": axis.values,
                })
            })
            .collect();
        object.insert("axes".into(), axes.into());
        object.insert("shape".into(), grid.shape().into());
        object.insert("points".into(), grid.len().into());
        let (mut units, mut why, mut counts) = (Object::new(), Object::new(), Object::new());
        let summaries = self.summaries();
        for (entry, summary) in self.plan.sheet().entries().iter().zip(&summaries) {
            let fields = self.plan.sheet().fields();
            for array in [entry.value, entry.status] {
                let field = &fields[array];
                if !field.unit.is_empty() {
                    units.insert(field.name.clone(), field.unit.clone().into());
                }
            }
            let states: Object<String, Json> = summary
                .states
                .iter()
                .map(|(status, count)| (status.name().to_owned(), (*count).into()))
                .collect();
            counts.insert(entry.variable.name.to_owned(), states.into());
            let reasons = reasons(summary);
            if !reasons.is_empty() {
                why.insert(entry.variable.name.to_owned(), reasons.into());
            }
        }
        object.insert("counts".into(), counts.into());
        object.insert("units".into(), units.into());
        object.insert("why".into(), why.into());
        object.insert("resumed_points".into(), self.resumed.into());
        object.insert("warnings".into(), self.warnings().into());
        object.into()
    }

    /// The value at a point in JSON: a number, a word, or null if unknown.
    fn cell(&self, entry: &VariableArrays, point: usize) -> Json {
        match (&self.plan.sheet().fields()[entry.value].content, &self.arrays[entry.value]) {
            (Content::Codes(meanings), Data::Codes(codes)) => {
                let found = meanings.iter().find(|(code, _)| *code == codes[point]);
                found.map_or(Json::Null, |(_, word)| (*word).into())
            }
            _ => self.number(entry, point).map_or(Json::Null, Json::from),
        }
    }

    /// As a dataset: one row per point.
    pub fn dataset(&self) -> Dataset {
        let mut dataset = Dataset::of(self.plan.grid().study(), "map");
        for axis in self.plan.grid().axes() {
            let values = axis.values.clone();
            dataset = dataset.with_axis(Array::new(axis.name.clone(), axis.unit, values));
        }
        for (entry, summary) in self.plan.sheet().entries().iter().zip(self.summaries()) {
            for (status, _) in summary.states.iter().filter(|(status, _)| **status != Status::Known)
            {
                dataset = dataset.fact(format!(
                    "{}: {} means {}",
                    entry.variable.name,
                    status.name(),
                    status.about()
                ));
            }
        }
        for (field, data) in self.plan.sheet().fields().iter().zip(&self.arrays) {
            let array = match (data, &field.content) {
                (Data::Codes(codes), Content::Codes(words)) => {
                    Array::of_words(field.name.clone(), words.clone(), codes)
                }
                (Data::Numbers(values), _) => {
                    Array::new(field.name.clone(), field.unit.clone(), values.clone())
                }
                (Data::Codes(_), Content::Numbers) => continue,
            };
            dataset = dataset.with(array);
        }
        dataset
    }
}

/// The warning about damaged chunks of a store that were recomputed.
pub(super) fn recomputed(chunks: usize) -> String {
    let were = if chunks == 1 { "was" } else { "were" };
    format!(
        "recomputed {chunks} chunk{} of the store that {were} truncated or changed",
        plural(chunks)
    )
}

/// Why numbers of a variable are null, one sentence for all of them.
fn reasons(summary: &Summary) -> String {
    let unknown = summary.states.iter().filter(|(status, _)| !status.has_number());
    let reasons: Vec<String> = unknown
        .map(|(status, count)| {
            format!("{} ({count} point{}): {}", status.name(), plural(*count), status.about())
        })
        .collect();
    reasons.join("; ")
}

/// A list in row-major order as lists of lists.
fn nested(shape: &[usize], mut values: Vec<Json>) -> Json {
    for length in shape.iter().skip(1).rev() {
        let mut rows = Vec::with_capacity(values.len() / length.max(&1));
        let mut rest = values.into_iter().peekable();
        while rest.peek().is_some() {
            rows.push(Json::Array(rest.by_ref().take(*length).collect()));
        }
        values = rows;
    }
    values.into()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_are_nested_like_the_axes() {
        let flat: Vec<Json> = (0..12).map(Json::from).collect();
        let json = nested(&[2, 3, 2], flat.clone());
        assert_eq!(json, json!([[[0, 1], [2, 3], [4, 5]], [[6, 7], [8, 9], [10, 11]]]));
        assert_eq!(nested(&[12], flat.clone()), Json::Array(flat));
    }
}
