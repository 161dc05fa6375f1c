//! Paths of a study, such as `contact.pad.friction.coefficient`, `dither[1].amplitude` or `system.stiffness[0][1]`.
//!
//! A path is followed through the document and the table of keys: entries of lists are named by an index, contacts also by
//! their name, and a single entry needs neither.

mod entries;
mod found;
mod walk;

use std::fmt::Write as _;

use quell_input::complaint::{Complaint, Fault};
use quell_input::document::{Node, Table, Value};
use quell_input::said::{Mention, Said};
use quell_model::parameter::DITHER_AMPLITUDE;

use super::address::{NumberAddress, units_of};
use super::reader::{Reader, WantedNumber};
use super::vocabulary::{DocumentKind, Key, KeyUnit, Role};
pub(super) use found::{FoundPath, LostPath};
use found::{PathStep, node_at};
pub(super) use walk::{follow, is_factor};

/// A key with the index of its table in a list.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Address {
    /// The key.
    pub key: &'static Key,
    /// Index of the entry of a list, such as `[[dither]]`, from 0, if given.
    pub index: Option<usize>,
}

/// The key that a path such as `dither[1].amplitude_n` names in studies of a kind, whichever entries their lists have.
///
/// # Errors
/// The nearest existing path, if any is close enough.
pub fn key_at(path: &str, kind: DocumentKind) -> Result<Address, Option<String>> {
    let found = walk::follow_keys(path, kind).map_err(|lost| lost.nearest)?;
    let index = found.steps.iter().find_map(|step| match step {
        PathStep::Index(index) => Some(*index),
        PathStep::Key(_) => None,
    });
    Ok(Address { key: found.key, index })
}

/// The path that gives the same number in a study with units: a frequency ratio is given in hertz, and other paths are unchanged.
pub fn with_unit(path: &str) -> String {
    match path.strip_suffix("frequency_ratio") {
        Some(table) => format!("{table}frequency_hz"),
        None => path.to_owned(),
    }
}

/// Finds the number that a path names in a document.
///
/// # Errors
/// What is wrong with the path.
pub(super) fn resolve(document: &Table, path: &str) -> Result<NumberAddress, LostPath> {
    let found = follow(document, path)?;
    if !found.is_number {
        return Err(LostPath::default());
    }
    let key = found.key;
    // A force gives the number of the law that its coefficient gives.
    let given = match key.role {
        Role::FrictionForce(parameter, _) => Some(parameter),
        _ => key.parameter(),
    };
    let mut number = String::new();
    let last = found.steps.len().saturating_sub(1);
    for (place, step) in found.steps.iter().enumerate() {
        let _ = match (step, given) {
            (PathStep::Key(_), Some(parameter)) if place == last => {
                write!(number, ".{}", parameter.key())
            }
            (PathStep::Key(name), _) => write!(number, ".{name}"),
            (PathStep::Index(index), _) => write!(number, "[{index}]"),
        };
    }
    let units = units_of(document);
    Ok(NumberAddress {
        number,
        about: key.about,
        symbol: key.symbol(),
        quantity: key.quantity(),
        unit: key.unit_in_words(DocumentKind::of(document), units),
        measured_in: key.measured_in(units),
    })
}

/// The unit to which a value of a path with a unit is converted, an entry of a list included; `None` where none can be.
pub(super) fn measured_in(document: &Table, path: &str) -> Option<&'static str> {
    follow(document, path).ok()?.key.measured_in(units_of(document))
}

/// The dither, counted from 0, whose amplitude a path names as a peak force; `None` for any other number.
pub(in crate::study) fn amplitude_of(document: &Table, path: &str) -> Option<usize> {
    let (dither, key) = amplitude_key(document, path)?;
    DITHER_AMPLITUDE.keys().any(|known| known == key).then_some(dither)
}

/// The dither, counted from 0, whose amplitude a path names by any key, and the key.
pub(in crate::study) fn amplitude_key(document: &Table, path: &str) -> Option<(usize, String)> {
    let found = follow(document, path).ok()?;
    let (PathStep::Key(last), steps) = found.steps.split_last()? else { return None };
    if found.key.parameter().map(|parameter| parameter.path) != Some(DITHER_AMPLITUDE.path) {
        return None;
    }
    match steps {
        [PathStep::Key(table)] if table == "dither" => Some((0, last.clone())),
        [PathStep::Key(table), PathStep::Index(index)] if table == "dither" => {
            Some((*index, last.clone()))
        }
        _ => None,
    }
}

/// Sets the value of a path.
///
/// # Errors
/// A path that does not exist, with the nearest one.
pub(super) fn set(document: &mut Table, path: &str, node: &Node) -> Result<(), Box<Complaint>> {
    let found = follow(document, path).map_err(|lost| {
        let keys = Said::from("the keys that ").mention(Mention::Schema).text(" lists");
        let unknown = (Fault::Unknown, keys);
        Box::new(lost.complaint(path, (node.origin, node.given()), unknown))
    })?;
    put(document, &found, node);
    Ok(())
}

/// Puts a value at the end of a path that was followed through this document.
pub(super) fn put(document: &mut Table, found: &FoundPath, node: &Node) {
    let Some((last, steps)) = found.steps.split_last() else { return };
    let mut at = Place::Table(document);
    for (place, step) in steps.iter().enumerate() {
        let in_list = matches!(found.steps[place + 1], PathStep::Index(_));
        let Some(next) = at.inside(step, in_list, node) else { return };
        at = next;
    }
    match (at, last) {
        (Place::Table(table), PathStep::Key(name)) => {
            for sibling in &found.replaces {
                table.remove(sibling.name);
            }
            table.set(name, node.clone());
        }
        (Place::List(list), PathStep::Index(index)) => {
            if let Some(entry) = list.get_mut(*index) {
                *entry = node.clone();
            }
        }
        _ => {}
    }
}

/// The number at a path, in the unit of its key; `None` if the study has none there.
pub(super) fn number(document: &Table, reader: &mut Reader, path: &str) -> Option<f64> {
    let found = follow(document, path).ok().filter(|found| found.is_number)?;
    let quantity = found.key.quantity();
    let mut value = |node: &Node, unit: KeyUnit| {
        let wanted = WantedNumber { unit, ..WantedNumber::finite(quantity) };
        reader.quantity(String::new, node, wanted)
    };
    let Some(PathStep::Key(last)) = found.steps.last() else {
        return value(found.node(document)?, found.key.key_unit());
    };
    // The number may be given by another key in another unit, or have a default.
    let own = (last.as_str(), found.key.key_unit());
    let in_another_unit = |key: &Key| matches!(key.role, Role::Number(_) | Role::Twin(..));
    let others =
        found.replaces.iter().filter(|key| in_another_unit(found.key) && in_another_unit(key));
    let others = others.map(|key| (key.name, key.key_unit()));
    let equal = [own].into_iter().chain(others).find_map(|(name, unit)| {
        let mut steps = found.steps.clone();
        steps.pop();
        steps.push(PathStep::Key(name.to_owned()));
        value(node_at(document, &steps)?, unit)
    });
    let of_one = match quantity {
        Some(quantity) => reader.units().in_equations(1.0, quantity, found.key.key_unit())?,
        None => 1.0,
    };
    let optional = ["normal_stiffness", "normal_damping", "phase"];
    let default = found.key.parameter().is_some_and(|known| optional.contains(&known.key()));
    equal.map(|value| value / of_one).or(default.then_some(0.0))
}

/// A value of the document that is changed.
enum Place<'d> {
    Table(&'d mut Table),
    List(&'d mut Vec<Node>),
}

impl<'d> Place<'d> {
    /// The value inside: a table, or a list where an entry of it is changed. A missing one is created.
    fn inside(self, step: &PathStep, in_list: bool, node: &Node) -> Option<Self> {
        let origin = node.origin;
        let fresh = || Node { value: Value::Table(Table::default()), origin };
        let value: &'d mut Value = match (self, step) {
            (Self::Table(table), PathStep::Key(name)) => {
                if !table.has(name) {
                    let value = Value::List(Vec::new());
                    table.set(name, if in_list { Node { value, origin } } else { fresh() });
                }
                &mut table.get_mut(name)?.value
            }
            (Self::List(list), PathStep::Index(index)) => {
                if *index == list.len() {
                    list.push(fresh());
                }
                &mut list.get_mut(*index)?.value
            }
            _ => return None,
        };
        match value {
            Value::Table(table) => Some(Self::Table(table)),
            Value::List(list) => Some(Self::List(list)),
            _ => None,
        }
    }
}
