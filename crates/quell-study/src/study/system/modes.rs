//! Structures given by their modes: `[[system.mode]]`, `modes = "modes.csv"`, and several `[[system.component]]`.
//!
//! Modal coordinates have unit mass: with mass-normalised shapes as they are, with others after division by √(modal mass).
//! Rows of contacts and inputs name points, which the shapes turn into rows over the modal coordinates.

use std::sync::Arc;

use quell_input::complaint::{Complaint, Fault, Origin};
use quell_input::document::{Node, Table, Value};
use quell_input::modes_file::{self, ModeList, SystemMode};
use quell_model::parameter::system::{
    SYSTEM_MODAL_MASS, SYSTEM_MODE_DAMPING, SYSTEM_MODE_FREQUENCY,
};
use quell_model::system::{MassMatrix, Mechanical};
use quell_numerics::matrix::Matrix;
use serde_json::Value as Json;

use super::contact::listed;
use super::names::{MOST_COORDINATES, NAME, PREFIX, is_plain_name};
use super::rows::{RowBasis, ShapePoints};
use super::structure::{ReadStructure, force};
use crate::study::reader::{Reader, WantedNumber};
use crate::study::vocabulary::Section;
use crate::study::vocabulary::{Choice, join};
use crate::study::without_units::WithoutUnits;

/// Modes with the name of their component; without a name for a structure of one component.
type ModalComponent = (Option<String>, Arc<ModeList>);

/// Reads a structure given by its modes, in the study or in files.
pub(super) fn read(reader: &mut Reader, table: &Table, header: Origin) -> ReadStructure {
    let components = if table.has("component") {
        components(reader, table)
    } else {
        let list = list(reader, table, PREFIX, header);
        list.map(|list| vec![(None, list)])
    };
    let Some(components) = components else { return ReadStructure::default() };
    let count: usize = components.iter().map(|(_, list)| list.modes.len()).sum();
    if count > MOST_COORDINATES {
        let allowed = format!("at most {MOST_COORDINATES} modes in all; got {count}");
        reader.complain(Complaint::new(Fault::Value, PREFIX, header, count, allowed));
        return ReadStructure::default();
    }
    let basis = basis(&components, count);
    let modes = || components.iter().flat_map(|(_, list)| &list.modes);
    let diagonal = |entry: &dyn Fn(&SystemMode) -> f64| {
        let mut matrix = Matrix::zeros(count, count);
        for (i, mode) in modes().enumerate() {
            matrix[(i, i)] = entry(mode);
        }
        matrix
    };
    let damping = diagonal(&|mode| 2.0 * mode.damping_ratio * mode.frequency);
    let stiffness = diagonal(&|mode| mode.frequency * mode.frequency);
    let structure = force(reader, table, &basis).map(|force| {
        let mass = MassMatrix::identity(count);
        Mechanical::new(basis.names.clone(), mass, damping, stiffness).under(force).into()
    });
    ReadStructure { basis: Some(basis.into()), structure }
}

/// Names of the modal coordinates and the rows of the points.
fn basis(components: &[ModalComponent], count: usize) -> RowBasis {
    let (mut names, mut points) = (Vec::with_capacity(count), Vec::new());
    for (component, list) in components {
        let own = component.as_deref().unwrap_or("mode");
        names.extend((1..=list.modes.len()).map(|number| format!("{own}.{number}")));
        points.extend(list.points.iter().map(|point| match component {
            Some(component) => format!("{component}.{point}"),
            None => point.clone(),
        }));
    }
    let mut rows = Matrix::zeros(points.len(), count);
    let (mut row, mut column) = (0, 0);
    for (_, list) in components {
        for (i, mode) in list.modes.iter().enumerate() {
            let size = mode.modal_mass.map_or(1.0, f64::sqrt);
            for (p, entry) in mode.shape.iter().enumerate() {
                rows[(row + p, column + i)] = entry / size;
            }
        }
        row += list.points.len();
        column += list.modes.len();
    }
    RowBasis {
        names,
        what: "point of the shapes",
        points: Some(ShapePoints { names: points, rows }),
    }
}

/// Every component; `None` if one is wrong.
fn components(reader: &mut Reader, table: &Table) -> Option<Vec<ModalComponent>> {
    let mut names: Vec<String> = Vec::new();
    let read: Vec<Option<ModalComponent>> = listed(reader, table, PREFIX, "component")
        .into_iter()
        .map(|(prefix, node, table)| {
            reader.unknown_keys(table, Section::Component, &prefix);
            let key = join(&prefix, "name");
            let name = if let Some(node) = table.get("name") {
                reader.text(&key, node).filter(|name| {
                    let right = is_plain_name(name) && !names.contains(name);
                    if !right {
                        reader.wrong(&key, node, format!("{NAME}, different for each component"));
                    }
                    right
                })
            } else {
                reader.missing(key, node.origin, NAME);
                None
            };
            names.extend(name.clone());
            let list = list(reader, table, &prefix, node.origin);
            Some((Some(name?), list?))
        })
        .collect();
    read.into_iter().collect()
}

/// The modes of a table: listed, or in a file.
fn list(reader: &mut Reader, table: &Table, prefix: &str, header: Origin) -> Option<Arc<ModeList>> {
    let normalisation = match table.get("normalisation") {
        Some(node) => {
            Some(reader.choice(&join(prefix, "normalisation"), node, Choice::Normalisation)?)
        }
        None => None,
    };
    let list = match (table.get("modes"), table.get("mode")) {
        (Some(node), Some(_)) => {
            let key = join(prefix, "modes");
            let allowed = format!("give either {key} or {}, not both", join(prefix, "mode"));
            let complaint =
                Complaint::new(Fault::Conflict, key, node.origin, node.given(), allowed);
            reader.complain(complaint);
            return None;
        }
        (Some(node), None) => file(reader, node, &join(prefix, "modes"))?,
        (None, Some(node)) => Arc::new(inline(reader, table, node, prefix)?),
        (None, None) => {
            let allowed = "a CSV file of modes, or modes as tables [[system.mode]]";
            reader.missing(join(prefix, "modes"), header, allowed);
            return None;
        }
    };
    normalised(reader, table, prefix, header, normalisation, &list).then_some(list)
}

/// Whether the modal masses are those that the normalisation needs.
fn normalised(
    reader: &mut Reader,
    table: &Table,
    prefix: &str,
    header: Origin,
    normalisation: Option<&str>,
    list: &ModeList,
) -> bool {
    let with_mass = list.modes.iter().position(|mode| mode.modal_mass.is_some());
    let without = list.modes.iter().position(|mode| mode.modal_mass.is_none());
    let (at, allowed) = match (normalisation, with_mass, without) {
        (Some("mass"), Some(at), _) => {
            (at, "has no modal_mass: mass-normalised shapes have modal mass 1")
        }
        (Some("max"), _, Some(at)) => {
            (at, "needs modal_mass: the shape alone does not say how large the mass is")
        }
        _ => return true,
    };
    let key = join(prefix, "normalisation");
    let origin = table.get("normalisation").map_or(header, |node| node.origin);
    let allowed = format!("mode {} {allowed}", at + 1);
    reader.complain(Complaint::new(Fault::Conflict, key, origin, Json::Null, allowed));
    false
}

/// Modes of a file.
fn file(reader: &mut Reader, node: &Node, key: &str) -> Option<Arc<ModeList>> {
    let name = reader.text(key, node)?;
    let has_units = reader.units().take_suffixes();
    let list = reader
        .files()
        .parsed(key, &name, modes_file::WANTED, |text| modes_file::parse(text, MOST_COORDINATES));
    let list = reader.in_file((key, node), &name, list)?;
    let in_units = if list.in_hertz && !has_units { Err(WithoutUnits::Hertz) } else { Ok(list) };
    reader.in_file((key, node), &name, in_units)
}

/// Modes that the study lists.
fn inline(reader: &mut Reader, table: &Table, node: &Node, prefix: &str) -> Option<ModeList> {
    if let Value::List(list) = &node.value
        && (list.is_empty() || list.len() > MOST_COORDINATES)
    {
        let allowed = format!("1 to {MOST_COORDINATES} modes; got {}", list.len());
        let key = join(prefix, "mode");
        reader.complain(Complaint::new(Fault::Value, key, node.origin, list.len(), allowed));
        return None;
    }
    let mut points: Vec<String> = Vec::new();
    let read: Vec<Option<InlineMode>> = listed(reader, table, prefix, "mode")
        .into_iter()
        .map(|(prefix, node, table)| one(reader, table, node, &prefix, &mut points))
        .collect();
    let read: Vec<InlineMode> = read.into_iter().collect::<Option<_>>()?;
    let modes = read.into_iter().map(|(mode, entries)| {
        let mut shape = vec![0.0; points.len()];
        for (at, entry) in entries {
            shape[at] = entry;
        }
        SystemMode { shape, ..mode }
    });
    let modes = modes.collect();
    Some(ModeList { points, modes, ..ModeList::default() })
}

/// A mode, and the entries of its shape with their places among the points.
type InlineMode = (SystemMode, Vec<(usize, f64)>);

/// Reads a mode.
fn one(
    reader: &mut Reader,
    table: &Table,
    node: &Node,
    prefix: &str,
    points: &mut Vec<String>,
) -> Option<InlineMode> {
    reader.unknown_keys(table, Section::Mode, prefix);
    let frequency = reader.number(table, prefix, node.origin, SYSTEM_MODE_FREQUENCY);
    let damping = reader.number(table, prefix, node.origin, SYSTEM_MODE_DAMPING);
    let mass = reader.optional(table, prefix, SYSTEM_MODAL_MASS);
    let key = join(prefix, "shape");
    let Some(shape) = table.get("shape") else {
        let allowed = "the displacement of each point, such as { pad_x = 0.3, pad_y = 1.1 }";
        reader.missing(key, node.origin, allowed);
        return None;
    };
    let Some(inner) = shape.table() else {
        let allowed = format!("a table of points, such as {{ pad_x = 0.3 }}; got {}", shape.kind());
        reader.wrong(&key, shape, allowed);
        return None;
    };
    let mut entries = Vec::new();
    let mut right = true;
    for (name, node) in inner.iter() {
        let wanted = WantedNumber::finite(None);
        let entry = reader.quantity(|| format!("{key}.{name}"), node, wanted);
        right &= entry.is_some();
        let at = points.iter().position(|known| known == name).unwrap_or_else(|| {
            points.push(name.to_owned());
            points.len() - 1
        });
        entries.extend(entry.map(|entry| (at, entry)));
    }
    let (frequency, damping_ratio, modal_mass) = (frequency?, damping?, mass.if_given()?);
    let mode = SystemMode { frequency, damping_ratio, modal_mass, shape: Vec::new() };
    right.then_some((mode, entries))
}
