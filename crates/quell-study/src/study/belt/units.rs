//! The units of a belt: those that it names, or SI where mass and stiffness are given.

use quell_input::complaint::{Complaint, Fault, Origin};
use quell_input::document::{Node, Table, Value};
use quell_model::parameter::{MASS, NATURAL_FREQUENCY, Parameter, SCALES, STIFFNESS};
use quell_model::units::{Scales, UnitSystem};

use crate::study::reader::{EquationScale, Found, Reader};
use crate::study::vocabulary::{self, Choice, DocumentKind, Role, Section, UNITS, join};

const PREFIX: &str = "belt";

/// A reader for the study of a belt, which knows its units and scales.
pub(super) fn reader(root: &Table) -> Reader {
    let mut reader = Reader::in_units(UnitSystem::None, EquationScale::Belt(None));
    let node = root.get(PREFIX);
    let belt = node.and_then(Node::table);
    let named = belt.and_then(|belt| belt.get(UNITS)).map(|node| named(&mut reader, node));
    let has_scales = belt.is_some_and(has_scales);
    let file = named.map_or_else(|| belt_units(root), Option::unwrap_or_default);
    reader.set_file_units(file);
    let (Some(belt), header) = (belt, node.map_or(Origin::Whole, |node| node.origin)) else {
        return reader;
    };
    if file.is_none() && !has_scales {
        return reader;
    }
    // The scales themselves are numbers of the file, and of SI where it has no units.
    reader.set_scale(EquationScale::OfTheFile);
    if file.is_none() {
        only_with_units(&mut reader, belt);
        reader.set_file_units(UnitSystem::Si);
    }
    let scales = scales(&mut reader, belt, header);
    reader.set_file_units(file);
    reader.set_scale(EquationScale::Belt(scales));
    reader
}

/// The units of a belt that names none.
pub(in crate::study) fn belt_units(root: &Table) -> UnitSystem {
    match root.get(PREFIX).and_then(Node::table) {
        Some(belt) if has_scales(belt) || is_suffixed(root) => UnitSystem::Si,
        _ => UnitSystem::None,
    }
}

fn has_scales(belt: &Table) -> bool {
    SCALES.iter().flat_map(Parameter::keys).any(|key| belt.has(key))
}

/// The units that a table names.
pub(in crate::study) fn named(reader: &mut Reader, node: &Node) -> Option<UnitSystem> {
    reader.choice(&join(PREFIX, UNITS), node, Choice::Units).and_then(UnitSystem::from_name)
}

/// Mass, and stiffness or natural frequency, in the units of the file.
fn scales(reader: &mut Reader, belt: &Table, header: Origin) -> Option<Scales> {
    let units = reader.units().file;
    let mass = scale(reader, belt, header, MASS);
    let stiffness = STIFFNESS.keys().find_map(|key| Some((key, belt.get(key)?)));
    let Some((name, node)) = NATURAL_FREQUENCY.keys().find_map(|key| Some((key, belt.get(key)?)))
    else {
        let stiffness = scale(reader, belt, header, STIFFNESS);
        return Scales::in_units_of(units, mass?, stiffness?).ok();
    };
    let frequency = scale(reader, belt, header, NATURAL_FREQUENCY);
    if let Some((stiffness, _)) = stiffness {
        reader.not_both(&join(PREFIX, stiffness), &join(PREFIX, name), node);
        return None;
    }
    Scales::of_angular_frequency(units, mass?, frequency?).ok()
}

fn scale(reader: &mut Reader, belt: &Table, header: Origin, parameter: Parameter) -> Option<f64> {
    let found = reader.optional(belt, PREFIX, parameter);
    if found == Found::Absent {
        let or =
            if parameter.path == STIFFNESS.path { "; or belt.natural_frequency_hz" } else { "" };
        let Parameter { bounds, quantity, symbol, about, .. } = parameter;
        let unit = reader.units().file.unit(quantity).unwrap_or_default();
        let about = about.split(';').next().unwrap_or(about);
        let allowed = format!(
            "{bounds} in {unit} ({symbol}, {about}){or}; a study with units needs mass and stiffness"
        );
        reader.missing(parameter.path, header, allowed);
    }
    found.if_given().flatten()
}

/// Reports scales without a unit in a study without units.
fn only_with_units(reader: &mut Reader, belt: &Table) {
    for parameter in SCALES {
        let Some(node) = belt.get(parameter.key()) else { continue };
        if let Value::Number(_) = node.value {
            let with = parameter.si.first().map_or(parameter.path, |other| other.key);
            let allowed = format!(
                "a number with its unit, or {}: the study has no units of its own",
                join(PREFIX, with)
            );
            let (origin, given) = (node.origin, node.given());
            reader.complain(Complaint::new(Fault::Mixed, parameter.path, origin, given, allowed));
        }
    }
}

/// Whether all quantities of a study have the suffix of a unit: then it has units, and its mass and stiffness are missing.
fn is_suffixed(root: &Table) -> bool {
    let mut suffixed = false;
    for section in [Section::Belt, Section::Friction, Section::Dither] {
        for table in root.get(section.path()).map(tables).unwrap_or_default() {
            let keys = table.iter();
            let mut keys =
                keys.filter_map(|(name, _)| vocabulary::key(section, name, DocumentKind::Belt));
            let is_bare = keys.any(|key| match key.role {
                Role::Number(parameter) => {
                    parameter.quantity.si_unit().is_some() && !parameter.is_pure()
                }
                role => {
                    suffixed |= match role {
                        Role::Twin(_, other) => !other.unit.is_empty(),
                        Role::Speeds { si } => si,
                        Role::FrictionForce(..) => true,
                        _ => false,
                    };
                    false
                }
            });
            if is_bare {
                return false;
            }
        }
    }
    suffixed
}

/// The tables of a list, or the only one.
fn tables(node: &Node) -> Vec<&Table> {
    match &node.value {
        Value::List(list) => list.iter().filter_map(Node::table).collect(),
        _ => node.table().into_iter().collect(),
    }
}
