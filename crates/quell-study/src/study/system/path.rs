//! Paths of a study of a system, such as `contact.pad.friction.coefficient` or `system.stiffness[0][1]`.
//!
//! A path is followed through the document: entries of lists are named by an index, contacts also by their name, and a
//! single entry needs neither.

use std::fmt::Write as _;

use quell_model::parameter::DITHER_AMPLITUDE;
use quell_model::units::Quantity;

use super::found::{PathStep, node_at};
use super::numbers::{Numbers, WantedNumber};
use super::units::SystemUnits;
use super::walk::follow;
use crate::complaint::{Complaint, Fault};
use crate::study::document::{Node, Table, Value};

/// A number of a study of a system.
#[derive(Clone, Debug, PartialEq)]
pub struct SystemAddress {
    /// Its path with every index, the same for all ways to write it.
    pub path: String,
    /// Description, in one line.
    pub about: &'static str,
    /// Symbol in the equations, if it is a number of the registry.
    pub symbol: Option<&'static str>,
    /// Its quantity, if it has one.
    pub quantity: Option<Quantity>,
    /// Unit of its value; `1` without a unit.
    pub unit: &'static str,
    /// Whether a value of the path is in SI regardless of the units of the file.
    pub twin: bool,
}

/// Finds the number that a path names in a document.
///
/// # Errors
/// The nearest existing path, if any is close enough.
pub fn resolve_in(document: &Table, path: &str) -> Result<SystemAddress, Option<String>> {
    let found = follow(document, path).map_err(|lost| lost.nearest)?;
    if !found.is_number {
        return Err(None);
    }
    let mut canonical = String::new();
    for step in &found.steps {
        match step {
            PathStep::Key(name) if canonical.is_empty() => canonical.push_str(name),
            PathStep::Key(name) => {
                let _ = write!(canonical, ".{name}");
            }
            PathStep::Index(index) => {
                let _ = write!(canonical, "[{index}]");
            }
        }
    }
    Ok(SystemAddress {
        unit: unit(document, found.quantity, found.twin).unwrap_or("1"),
        path: canonical,
        about: found.about,
        symbol: found.parameter.map(|parameter| parameter.symbol),
        quantity: found.quantity,
        twin: found.twin,
    })
}

/// The dither, counted from 0, whose amplitude a path names as a peak force; `None` for any other number.
pub(in crate::study) fn amplitude_of(document: &Table, path: &str) -> Option<usize> {
    let (dither, key) = amplitude_key(document, path)?;
    let peak = DITHER_AMPLITUDE.si.iter().filter(|twin| !twin.rms).map(|twin| twin.key);
    [DITHER_AMPLITUDE.key()].into_iter().chain(peak).any(|known| known == key).then_some(dither)
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
    let found = follow(document, path).ok()?;
    match found.quantity {
        Some(Quantity::Ratio) => Some("1"),
        quantity => unit(document, quantity, found.twin),
    }
}

fn unit(document: &Table, quantity: Option<Quantity>, twin: bool) -> Option<&'static str> {
    let quantity = quantity?;
    if twin {
        return quantity.si_unit().map(|(unit, _)| unit);
    }
    let system = document.get("system").and_then(Node::table);
    let units = match system.and_then(|table| table.get("units")).map(|node| &node.value) {
        Some(Value::Text(name)) => SystemUnits::from_name(name).unwrap_or_default(),
        _ => SystemUnits::None,
    };
    units.unit(quantity)
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

/// The number at a path; `None` if the study has none there.
pub(super) fn number(document: &Table, numbers: &Numbers, path: &str) -> Option<f64> {
    let found = follow(document, path).ok().filter(|found| found.is_number)?;
    let wanted = WantedNumber { twin: found.twin, ..WantedNumber::finite(found.quantity) };
    let size = numbers.file_units(wanted);
    let node = found.node(document);
    if let Some(node) = node {
        return numbers.value(node, wanted).ok().map(|value| value / size);
    }
    // The number may be given by another key in other units, or have a default.
    let (Some(PathStep::Key(last)), Some(parameter)) = (found.steps.last(), found.parameter) else {
        return None;
    };
    for other in found.replaces.iter().filter(|name| *name != last) {
        let mut steps = found.steps.clone();
        steps.pop();
        steps.push(PathStep::Key(other.clone()));
        let twin = other != parameter.key();
        if let Some(node) = node_at(document, &steps) {
            let wanted = WantedNumber { twin, ..wanted };
            return numbers.value(node, wanted).ok().map(|value| value / size);
        }
    }
    let optional = ["normal_stiffness", "normal_damping", "phase"];
    optional.contains(&parameter.key()).then_some(0.0)
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
