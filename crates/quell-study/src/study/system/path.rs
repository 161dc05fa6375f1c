//! Paths of a study of a system, such as `contact.pad.friction.coefficient` or `system.stiffness[0][1]`.
//!
//! A path is followed through the document: entries of lists are named by an index, contacts also by their name, and a
//! single entry needs neither.

use std::fmt::Write as _;

use quell_model::parameter::DITHER_AMPLITUDE;
use quell_model::units::Quantity;

use super::found::{FoundPath, PathStep, node_at};
use super::walk::follow;
use crate::complaint::{Complaint, Fault};
use crate::study::address::{NumberAddress, units_of};
use crate::study::document::{Node, Table, Value};
use crate::study::reader::{KeyUnit, Reader, WantedNumber};

/// Finds the number that a path names in a document.
///
/// # Errors
/// The nearest existing path, if any is close enough.
pub(in crate::study) fn resolve_in(
    document: &Table,
    path: &str,
) -> Result<NumberAddress, Option<String>> {
    let found = follow(document, path).map_err(|lost| lost.nearest)?;
    if !found.is_number {
        return Err(None);
    }
    let mut number = String::new();
    let last = found.steps.len().saturating_sub(1);
    for (place, step) in found.steps.iter().enumerate() {
        match (step, found.parameter) {
            (PathStep::Key(_), Some(parameter)) if place == last => {
                let _ = write!(number, ".{}", parameter.key());
            }
            (PathStep::Key(name), _) => {
                let _ = write!(number, ".{name}");
            }
            (PathStep::Index(index), _) => {
                let _ = write!(number, "[{index}]");
            }
        }
    }
    let unit = unit(document, &found);
    Ok(NumberAddress {
        number,
        about: found.about,
        symbol: found.parameter.map(|parameter| parameter.symbol),
        quantity: found.quantity,
        unit: unit.unwrap_or("1"),
        measured_in: unit.or((found.quantity == Some(Quantity::Ratio)).then_some("1")),
    })
}

/// The dither, counted from 0, whose amplitude a path names as a peak force; `None` for any other number.
pub(in crate::study) fn amplitude_of(document: &Table, path: &str) -> Option<usize> {
    let (dither, key) = amplitude_key(document, path)?;
    DITHER_AMPLITUDE.keys().any(|known| known == key).then_some(dither)
}

/// The dither, counted from 0, whose amplitude a path names by any key, and the key.
pub(super) fn amplitude_key(document: &Table, path: &str) -> Option<(usize, String)> {
    let found = follow(document, path).ok()?;
    let (PathStep::Key(last), steps) = found.steps.split_last()? else { return None };
    if found.parameter.map(|parameter| parameter.path) != Some(DITHER_AMPLITUDE.path) {
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

/// The unit to which values of a path are converted.
pub(in crate::study) fn measured_in(document: &Table, path: &str) -> Option<&'static str> {
    resolve_in(document, path).ok()?.measured_in
}

/// The unit of the key of a number, if it has one.
fn unit(document: &Table, found: &FoundPath) -> Option<&'static str> {
    let quantity = found.quantity?;
    match (found.unit(), quantity.si_unit()) {
        (KeyUnit::Suffix(unit), _) => Some(unit),
        (KeyUnit::Ratio, _) => None,
        (KeyUnit::Study, _) => units_of(document).unit(quantity).or(quantity.own_unit()),
    }
}

/// Sets the value of a path.
///
/// # Errors
/// A path that does not exist, with the nearest one.
pub(in crate::study) fn set(
    document: &mut Table,
    path: &str,
    node: &Node,
) -> Result<(), Box<Complaint>> {
    let found = match follow(document, path) {
        Ok(found) => found,
        Err(lost) => {
            let fault = if lost.allowed.is_some() { Fault::Conflict } else { Fault::Unknown };
            let allowed =
                lost.allowed.unwrap_or_else(|| "the keys listed by `quell schema`".to_owned());
            let complaint = Complaint::new(fault, path, node.origin, node.given(), allowed);
            return Err(Box::new(complaint.suggesting(lost.nearest)));
        }
    };
    let Some((last, steps)) = found.steps.split_last() else { return Ok(()) };
    let mut at = Place::Table(document);
    for step in steps {
        let Some(next) = at.inside(step, node) else { return Ok(()) };
        at = next;
    }
    match (at, last) {
        (Place::Table(table), PathStep::Key(name)) => {
            for sibling in &found.replaces {
                if sibling != name {
                    table.remove(sibling);
                }
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
    Ok(())
}

/// The number at a path, in the unit of its key; `None` if the study has none there.
pub(super) fn number(document: &Table, reader: &mut Reader, path: &str) -> Option<f64> {
    let found = follow(document, path).ok().filter(|found| found.is_number)?;
    let mut value = |node: &Node, unit: KeyUnit| {
        let wanted = WantedNumber { unit, ..WantedNumber::finite(found.quantity) };
        reader.quantity(String::new, node, wanted)
    };
    let Some(PathStep::Key(last)) = found.steps.last() else {
        return value(found.node(document)?, KeyUnit::Study);
    };
    // The number may be given by another key in another unit, or have a default.
    let others = found.replaces.iter().filter(|name| *name != last);
    let equal = [last].into_iter().chain(others).find_map(|name| {
        let mut steps = found.steps.clone();
        steps.pop();
        steps.push(PathStep::Key(name.clone()));
        value(node_at(document, &steps)?, found.unit_of(name))
    });
    let of_one = match found.quantity {
        Some(quantity) => reader.units().in_equations(1.0, quantity, found.unit())?,
        None => 1.0,
    };
    let optional = ["normal_stiffness", "normal_damping", "phase"];
    let default = found.parameter.is_some_and(|known| optional.contains(&known.key()));
    equal.map(|value| value / of_one).or(default.then_some(0.0))
}

/// A value of the document that is changed.
enum Place<'d> {
    Table(&'d mut Table),
    List(&'d mut Vec<Node>),
}

impl<'d> Place<'d> {
    /// The value inside; a missing table is created.
    fn inside(self, step: &PathStep, node: &Node) -> Option<Self> {
        let value: &'d mut Value = match (self, step) {
            (Self::Table(table), PathStep::Key(name)) => {
                if !table.has(name) {
                    let value = Value::Table(Table::default());
                    table.set(name, Node { value, origin: node.origin });
                }
                &mut table.get_mut(name)?.value
            }
            (Self::List(list), PathStep::Index(index)) => &mut list.get_mut(*index)?.value,
            _ => return None,
        };
        match value {
            Value::Table(table) => Some(Self::Table(table)),
            Value::List(list) => Some(Self::List(list)),
            _ => None,
        }
    }
}
