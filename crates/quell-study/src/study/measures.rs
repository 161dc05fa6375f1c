//! Numbers with units in the document: `amplitude_n = "5.7kN"` is converted to 5700.
//!
//! The unit of a number is that of its key. Other texts are left unchanged, and the reader rejects them.

use quell_model::units::measure;

use super::document::{Node, Table, Value};
use super::sweep::AxisTarget;
use super::system::{keys, path};
use super::vocabulary::{self, Section};

/// Converts texts with units under numeric keys to numbers in the unit of the key; the ends and values of an axis
/// are in the unit of the key that it varies.
pub(super) fn resolve(root: &mut Table) {
    resolve_distributions(root);
    if keys::is_described(root) {
        resolve_axes(root);
        return;
    }
    for section in Section::ALL {
        for table in tables(root, *section) {
            resolve_table(table, *section);
        }
    }
}

/// The numbers of distributions are in the unit of the key that they are of, except the deviation of a logarithm.
fn resolve_distributions(root: &mut Table) {
    if !root.has("uncertainty") {
        return;
    }
    let paths = root.clone();
    for table in tables_of(root, "uncertainty") {
        resolve_inside(table, "", &paths);
    }
}

/// The distributions in a table of paths, which may be tables inside each other.
fn resolve_inside(table: &mut Table, prefix: &str, paths: &Table) {
    for (name, node) in table.iter_mut() {
        let path = vocabulary::join(prefix, name);
        let Value::Table(inner) = &mut node.value else { continue };
        let Ok(target) = AxisTarget::resolve(paths, &path) else {
            resolve_inside(inner, &path, paths);
            continue;
        };
        let Some(unit) = target.measured_in() else { continue };
        for (kind, node) in inner.iter_mut() {
            match &mut node.value {
                Value::List(list) if kind == "lognormal" => {
                    list.iter_mut().take(1).for_each(|node| resolve_node(node, unit));
                }
                _ => resolve_node(node, unit),
            }
        }
    }
}

/// The axes of a study of a system, whose other numbers its own reader converts.
fn resolve_axes(root: &mut Table) {
    if !root.has("sweep") {
        return;
    }
    let paths = root.clone();
    for table in tables(root, Section::Sweep) {
        let unit = match table.get("parameter").map(|node| &node.value) {
            Some(Value::Text(named)) => path::measured_in(&paths, named),
            _ => None,
        };
        let Some(unit) = unit else { continue };
        for (_, node) in table.iter_mut().filter(|(name, _)| *name != "points") {
            resolve_node(node, unit);
        }
    }
}

fn resolve_table(table: &mut Table, section: Section) {
    let axis = varied(table, section);
    for (name, node) in table.iter_mut() {
        let unit = match (section, vocabulary::key(section, name)) {
            (Section::Sweep, _) if name != "points" => axis,
            (Section::Constants, _) => Some("1"),
            (_, Some(key)) => key.measured_in(),
            _ => None,
        };
        if let Some(unit) = unit {
            resolve_node(node, unit);
        }
    }
}

/// Unit of the key that an axis varies.
fn varied(table: &Table, section: Section) -> Option<&'static str> {
    let Value::Text(path) = &table.get("parameter").filter(|_| section == Section::Sweep)?.value
    else {
        return None;
    };
    vocabulary::resolve(path).ok()?.key.measured_in()
}

fn resolve_node(node: &mut Node, unit: &'static str) {
    match &mut node.value {
        Value::Text(text) if measure::has_unit(text) => {
            if let Ok(number) = measure::read(text, Some(unit)) {
                node.value = Value::Number(number);
            }
        }
        Value::List(list) => list.iter_mut().for_each(|node| resolve_node(node, unit)),
        _ => {}
    }
}

/// The tables of a section.
fn tables(root: &mut Table, section: Section) -> Vec<&mut Table> {
    tables_of(root, section.path())
}

/// The tables at a path.
fn tables_of<'t>(root: &'t mut Table, path: &str) -> Vec<&'t mut Table> {
    let mut within = vec![root];
    for name in path.split('.').filter(|name| !name.is_empty()) {
        let nodes = within.into_iter().filter_map(|table| table.get_mut(name));
        within = nodes.flat_map(listed).collect();
    }
    within
}

/// A table, or each table of a list.
fn listed(node: &mut Node) -> Vec<&mut Table> {
    match &mut node.value {
        Value::Table(table) => vec![table],
        Value::List(list) => list
            .iter_mut()
            .filter_map(|node| match &mut node.value {
                Value::Table(table) => Some(table),
                _ => None,
            })
            .collect(),
        _ => Vec::new(),
    }
}
