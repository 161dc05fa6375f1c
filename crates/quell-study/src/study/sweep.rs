//! `[[sweep]]`: the axes of a map.

use quell_input::complaint::{Complaint, Fault, Origin};
use quell_input::document::{Node, Table, Value};
use quell_model::parameter::Bounds;
use serde_json::Value as Json;

use super::address::NumberAddress;
use super::path;
use super::reader::Reader;
use super::vocabulary::{Choice, MOST_POINTS, Section, join};

/// One axis of a map. Its values are in the unit of the key it names.
#[derive(Clone, Debug, PartialEq)]
pub struct Sweep {
    /// Path of the number that is varied, as it was written.
    pub path: String,
    /// The number it names.
    pub target: NumberAddress,
    /// Spacing of the values.
    pub axis: Axis,
}

/// The values of an axis.
#[derive(Clone, Debug, PartialEq)]
pub enum Axis {
    /// `points` values in equal steps, both ends included.
    Linear {
        /// First value.
        from: f64,
        /// Last value.
        to: f64,
        /// Number of values.
        points: usize,
    },
    /// `points` values in equal ratios, both ends included.
    Logarithmic {
        /// First value.
        from: f64,
        /// Last value.
        to: f64,
        /// Number of values.
        points: usize,
    },
    /// These values.
    Values(Vec<f64>),
}

impl Axis {
    /// Number of values.
    pub fn len(&self) -> usize {
        match self {
            Self::Linear { points, .. } | Self::Logarithmic { points, .. } => *points,
            Self::Values(values) => values.len(),
        }
    }

    /// Whether it has no values; never true in a checked study.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Value `index`; indices beyond the last give the last value. Both ends are exact.
    pub fn value(&self, index: usize) -> f64 {
        let last = self.len().saturating_sub(1);
        match self {
            Self::Values(values) => values[index.min(last)],
            Self::Linear { from, to, .. } | Self::Logarithmic { from, to, .. } if index >= last => {
                if last == 0 {
                    *from
                } else {
                    *to
                }
            }
            Self::Linear { from, .. } | Self::Logarithmic { from, .. } if index == 0 => *from,
            Self::Linear { from, to, .. } => from + (to - from) * (index as f64 / last as f64),
            Self::Logarithmic { from, to, .. } => {
                from * libm::exp(libm::log(to / from) * (index as f64 / last as f64))
            }
        }
    }

    /// Every value in order.
    pub fn values(&self) -> impl Iterator<Item = f64> {
        (0..self.len()).map(|index| self.value(index))
    }

    /// The smallest and largest values: if these are allowed, all are.
    pub(super) fn extremes(&self) -> Vec<f64> {
        let values = || self.values();
        match self {
            Self::Values(_) => {
                let lowest = values().fold(f64::INFINITY, f64::min);
                let highest = values().fold(f64::NEG_INFINITY, f64::max);
                vec![lowest, highest]
            }
            _ => vec![self.value(0), self.value(usize::MAX)],
        }
    }
}

/// Replaces the axes of a study.
pub(super) fn replace(root: &mut Table, axes: &[Table]) {
    let entry = |table: &Table| Node { value: Value::Table(table.clone()), origin: Origin::Whole };
    let list = axes.iter().map(entry).collect();
    root.remove("sweep");
    root.set("sweep", Node { value: Value::List(list), origin: Origin::Whole });
}

/// Changes of a study with other axes, as `path=value`.
pub(super) fn changes(earlier: &[String], axes: &[Table]) -> Vec<String> {
    let earlier = earlier.iter().filter(|change| !change.starts_with("sweep"));
    let new = axes.iter().enumerate().flat_map(|(index, axis)| {
        axis.iter().map(move |(key, node)| format!("sweep[{index}].{key}={}", node.given()))
    });
    earlier.cloned().chain(new).collect()
}

/// Reads every `[[sweep]]`; `None` if one of them is invalid.
pub(super) fn read(reader: &mut Reader, root: &Table) -> Option<Vec<Sweep>> {
    let Some(node) = root.get("sweep") else {
        return Some(Vec::new());
    };
    let Value::List(list) = &node.value else {
        reader.wrong("sweep", node, format!("tables [[sweep]]; got {}", node.kind()));
        return None;
    };
    let mut sweeps: Vec<Option<Sweep>> = Vec::new();
    for (index, node) in list.iter().enumerate() {
        let prefix = format!("sweep[{index}]");
        let sweep = one(reader, root, node, &prefix);
        if let Some(sweep) = &sweep
            && let Some(earlier) = sweeps
                .iter()
                .flatten()
                .position(|earlier| earlier.target.number == sweep.target.number)
        {
            let allowed = format!("sweep[{earlier}] already varies {}", sweep.path);
            let key = join(&prefix, "parameter");
            reader.complain(Complaint::new(
                Fault::Conflict,
                key,
                node.origin,
                sweep.path.clone(),
                allowed,
            ));
        }
        sweeps.push(sweep);
    }
    sweeps.into_iter().collect()
}

fn one(reader: &mut Reader, root: &Table, node: &Node, prefix: &str) -> Option<Sweep> {
    let Some(table) = node.table() else {
        reader.wrong(prefix, node, format!("a table; got {}", node.kind()));
        return None;
    };
    reader.unknown_keys(table, Section::Sweep, prefix);
    let named = parameter(reader, root, table, node, prefix);
    let unit = named.as_ref().and_then(|(_, target)| target.measured_in);
    let unit = unit.filter(|unit| *unit != "1").unwrap_or_default();
    let axis = axis(reader, table, node, prefix, unit);
    let (path, target) = named?;
    Some(Sweep { path, target, axis: axis? })
}

fn parameter(
    reader: &mut Reader,
    root: &Table,
    table: &Table,
    header: &Node,
    prefix: &str,
) -> Option<(String, NumberAddress)> {
    let key = join(prefix, "parameter");
    let Some(node) = table.get("parameter") else {
        let allowed = "the path of a number in the study, such as \"dither.amplitude\"";
        reader.complain(Complaint::new(Fault::Missing, key, header.origin, Json::Null, allowed));
        return None;
    };
    let path = reader.text(&key, node)?;
    match path::resolve(root, &path) {
        Ok(target) => Some((path, target)),
        Err(lost) => {
            let allowed = "the path of a number in the study, such as \"dither.amplitude\"";
            let given = (node.origin, Json::String(path));
            reader.complain(lost.complaint(key, given, (Fault::Value, allowed)));
            None
        }
    }
}

fn axis(
    reader: &mut Reader,
    table: &Table,
    header: &Node,
    prefix: &str,
    unit: &'static str,
) -> Option<Axis> {
    let spacing = match table.get("spacing") {
        Some(node) => reader.choice(&join(prefix, "spacing"), node, Choice::Spacing),
        None => Some("linear"),
    };
    if let Some(node) = table.get("values") {
        for name in ["from", "to", "points", "spacing"] {
            if let Some(other) = table.get(name) {
                let allowed = format!(
                    "give either {} or from, to and points, not both",
                    join(prefix, "values")
                );
                let key = join(prefix, name);
                reader.complain(Complaint::new(
                    Fault::Conflict,
                    key,
                    other.origin,
                    other.given(),
                    allowed,
                ));
            }
        }
        return values(reader, node, &join(prefix, "values"), unit).map(Axis::Values);
    }
    let logarithmic = spacing == Some("log");
    let bounds = if logarithmic { Bounds::POSITIVE } else { Bounds::FINITE };
    let mut end = |name: &str, bounds, whole: bool| {
        let key = join(prefix, name);
        let Some(node) = table.get(name) else {
            let allowed = "a number; or give values = […] instead of from, to and points";
            reader.complain(Complaint::new(
                Fault::Missing,
                key,
                header.origin,
                Json::Null,
                allowed,
            ));
            return None;
        };
        reader.within(&key, node, bounds, if whole { "" } else { unit }, whole)
    };
    let points = Bounds { upper: f64::from(MOST_POINTS), ..Bounds::at_least(2.0) };
    let (from, to, points) =
        (end("from", bounds, false), end("to", bounds, false), end("points", points, true));
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a whole number from 2 to MOST_POINTS"
    )]
    let (from, to, points) = (from?, to?, points? as usize);
    match spacing? {
        "log" => Some(Axis::Logarithmic { from, to, points }),
        _ => Some(Axis::Linear { from, to, points }),
    }
}

fn values(reader: &mut Reader, node: &Node, key: &str, unit: &'static str) -> Option<Vec<f64>> {
    let Value::List(list) = &node.value else {
        reader.wrong(key, node, format!("an array of numbers; got {}", node.kind()));
        return None;
    };
    if list.is_empty() {
        reader.wrong(key, node, "an array of at least one number");
        return None;
    }
    let numbers: Vec<Option<f64>> = list
        .iter()
        .enumerate()
        .map(|(index, node)| {
            reader.within(&format!("{key}[{index}]"), node, Bounds::FINITE, unit, false)
        })
        .collect();
    numbers.into_iter().collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_ends_come_out_exactly() {
        let linear = Axis::Linear { from: 0.05, to: 1.0, points: 20 };
        assert_eq!((linear.value(0), linear.value(19)), (0.05, 1.0));
        assert!((linear.value(1) - 0.1).abs() < 1e-15);
        let log = Axis::Logarithmic { from: 1e-3, to: 1e3, points: 7 };
        for (index, value) in log.values().enumerate() {
            let exact = 10f64.powi(i32::try_from(index).expect("small") - 3);
            assert!((value / exact - 1.0).abs() < 1e-14);
        }
    }

    #[test]
    fn extremes_bound_every_value() {
        let axis = Axis::Values(vec![3.0, -1.0, 2.0]);
        assert_eq!(axis.extremes(), [-1.0, 3.0]);
    }
}
