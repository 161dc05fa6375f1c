//! `[friction]` and `[contact.friction]`: a law and its parameters, or a user-defined law.

use quell_input::complaint::{Complaint, Fault, Origin};
use quell_input::document::{Node, Table};
use quell_model::friction::Otherwise;
use quell_model::parameter::{COEFFICIENT, Parameter, STATIC_COEFFICIENT};
use quell_model::{Friction, InvalidValues, LawKind};
use serde_json::Value as Json;

use super::reader::{Found, Reader};
use super::vocabulary::{Choice, Role, Section, join, law_keys};
use forces::ForceLevels;
pub(in crate::study) use forces::{
    are_given as are_given_as_forces, in_newtons, needs_no_normal_force,
};
pub(in crate::study) use law_place::LawPlace;
pub use measured::Measured;
pub(in crate::study) use read_law::ReadLaw;

mod expression;
mod forces;
mod law_place;
mod measured;
mod read_law;
mod samples;

/// Reads `[friction]` of a belt.
pub(in crate::study) fn read(
    reader: &mut Reader,
    root: &Table,
    normal_load: Option<f64>,
) -> Option<ReadLaw> {
    let Some(node) = root.get("friction") else {
        let allowed = "a table [friction] with law and its parameters";
        reader.missing("friction", Origin::Whole, allowed);
        return None;
    };
    let place = LawPlace { path: "friction", normal_load, may_be_reversed: false };
    read_table(reader, node, place)
}

/// Reads the table of a law.
pub(in crate::study) fn read_table(
    reader: &mut Reader,
    node: &Node,
    place: LawPlace<'_>,
) -> Option<ReadLaw> {
    let path = place.path;
    let table = reader.table(path, node)?;
    // Only friction that is given as forces depends on the load.
    let load = place.normal_load.filter(|_| are_given_as_forces(table));
    reader.part(table, (load, place.may_be_reversed), |reader| {
        let name = reader.needed_choice(table, path, node.origin, "law", Choice::Law);
        let kind = name.and_then(LawKind::from_name);
        unknown_keys(reader, table, path, kind);
        match kind {
            Some(LawKind::Expression) => {
                expression::read(reader, table, path, node.origin).map(ReadLaw::of)
            }
            Some(LawKind::Samples) => samples::read(reader, table, path, node.origin),
            kind => numeric_law(reader, table, node, place, kind),
        }
    })
}

/// Reads the law of a disc, which is defined by numbers alone.
pub(in crate::study) fn of_a_disc(reader: &mut Reader, node: &Node) -> Option<Friction> {
    let path = "friction";
    let table = reader.table(path, node)?;
    let name = reader.needed_choice(table, path, node.origin, "law", Choice::Law);
    let kind = name.and_then(LawKind::from_name);
    unknown_keys(reader, table, path, kind);
    let numeric = |kind: &LawKind| LawKind::NUMERIC.contains(kind);
    if let Some(kind) = kind.filter(|kind| !numeric(kind) || forces::are_given(table)) {
        let words: Vec<&str> = LawKind::NUMERIC.iter().map(|kind| kind.name()).collect();
        let allowed = format!("a law of coefficients for a disc: {}", words.join(", "));
        let given = Json::from(kind.name());
        reader.complain(Complaint::new(Fault::Value, "friction.law", node.origin, given, allowed));
        return None;
    }
    let place = LawPlace { path, normal_load: None, may_be_reversed: false };
    numeric_law(reader, table, node, place, kind).map(|read| read.law)
}

/// A law that numbers define. Without a valid name, the numbers that are given are checked.
fn numeric_law(
    reader: &mut Reader,
    table: &Table,
    node: &Node,
    place: LawPlace<'_>,
    kind: Option<LawKind>,
) -> Option<ReadLaw> {
    let levels = match kind {
        Some(kind) => ForceLevels::of(reader, table, place, kind).ok()?,
        None => None,
    };
    let parameters = kind.map_or(LawKind::ALL[0].parameters(), LawKind::parameters);
    // NaN stands for a value already reported.
    let mut values: Vec<f64> = Vec::with_capacity(parameters.len());
    let mut reversed = false;
    for parameter in parameters {
        if kind.is_none() && !table.has(parameter.key()) {
            continue;
        }
        let found = match &levels {
            Some(levels) if forces::gives(*parameter) => levels.value(reader, table, *parameter),
            _ if place.may_be_reversed && is_reversed(reader, table, kind, *parameter) => {
                reversed = true;
                negative(reader, table, place, *parameter)
            }
            _ => reader.optional(table, place.path, *parameter),
        };
        let value = match found {
            Found::Value(value) => Some(value),
            Found::Wrong => None,
            Found::Absent => match kind.and_then(|kind| kind.default_of(parameter.path)) {
                Some(Otherwise::Number(number)) => Some(number),
                Some(Otherwise::SameAs(path)) => {
                    let earlier = parameters.iter().position(|known| known.path == path);
                    earlier.and_then(|place| values.get(place).copied())
                }
                None if levels.is_some() && forces::gives(*parameter) => {
                    forces::missing(reader, place.path, node.origin, *parameter);
                    None
                }
                None => reader.number(table, place.path, node.origin, *parameter),
            },
        };
        values.push(value.unwrap_or(f64::NAN));
    }
    let kind = kind?;
    let own_load = levels.and_then(|levels| levels.own_load);
    let has_level = STATIC_COEFFICIENT.keys().any(|key| table.has(key))
        || forces::key_in(table, STATIC_COEFFICIENT).is_some();
    match kind.build(&values) {
        // A static level that is not given equals the coefficient.
        Ok(Friction::Coulomb(law)) if !has_level => {
            let law = Friction::Coulomb(law.without_static_level());
            Some(ReadLaw { own_load, reversed, ..ReadLaw::of(law) })
        }
        Ok(law) => Some(ReadLaw { own_load, reversed, ..ReadLaw::of(law) }),
        Err(invalid) => {
            let known = values.iter().all(|value| !value.is_nan());
            report(reader, table, place.path, kind.parameters(), (invalid, known));
            None
        }
    }
}

/// Reports the errors of the model about the numbers of a law under the keys of the file; those of numbers that have been reported are
/// left out.
fn report(
    reader: &mut Reader,
    table: &Table,
    path: &str,
    parameters: &[Parameter],
    (invalid, known): (InvalidValues, bool),
) {
    for wrong in invalid {
        let Some(parameter) = parameters.iter().find(|known| known.path == wrong.key) else {
            continue;
        };
        let as_force = || forces::key_in(table, *parameter);
        let key = parameter.keys().find(|key| table.has(key)).or_else(as_force);
        let Some((key, node)) = key.and_then(|key| Some((key, table.get(key)?))) else { continue };
        if known || wrong.value != "NaN" {
            // A relation names the other number by the key that gives it.
            let mut allowed = wrong.allowed;
            for other in parameters {
                let given = other.keys().find(|key| table.has(key));
                let given = given.or_else(|| forces::key_in(table, *other));
                allowed = allowed.replace(other.path, &join(path, given.unwrap_or(other.key())));
            }
            reader.wrong_once(&join(path, key), node, allowed);
        }
    }
}

/// Whether a Coulomb law has a negative coefficient and nothing that a change of direction would not carry over, in its coefficient or its
/// static level.
fn is_reversed(
    reader: &Reader,
    table: &Table,
    kind: Option<LawKind>,
    parameter: Parameter,
) -> bool {
    let number = |known: Parameter| {
        table.get(known.key()).and_then(|node| reader.number_of(node, known.quantity))
    };
    let viscous = quell_model::parameter::VISCOUS;
    [COEFFICIENT, STATIC_COEFFICIENT].iter().any(|known| known.path == parameter.path)
        && kind == Some(LawKind::Coulomb)
        && number(COEFFICIENT).is_some_and(|number| number < 0.0)
        && number(STATIC_COEFFICIENT).is_none_or(|number| number < 0.0)
        && (viscous.keys().all(|key| !table.has(key)) || number(viscous) == Some(0.0))
        && table.has(parameter.key())
}

/// The absolute value of a negative number.
fn negative(
    reader: &mut Reader,
    table: &Table,
    place: LawPlace<'_>,
    parameter: Parameter,
) -> Found {
    let bounds = quell_model::parameter::Bounds::FINITE;
    match reader.optional(table, place.path, Parameter { bounds, ..parameter }) {
        Found::Value(value) => Found::Value(value.abs()),
        found => found,
    }
}

/// Reports keys that no law has, or that this law does not have.
fn unknown_keys(reader: &mut Reader, table: &Table, path: &str, kind: Option<LawKind>) {
    for (name, node) in table.iter() {
        let Some(key) = law_keys().find(|key| key.name == name) else {
            reader.unknown_key(Section::Friction, path, name, node);
            continue;
        };
        let Some(kind) = kind else { continue };
        if !belongs(key.role, kind) {
            let keys = law_keys().filter(|key| belongs(key.role, kind));
            let keys: Vec<&str> = keys.map(|key| key.name).collect();
            // It is a key of another law: no suggestion is needed.
            let allowed = format!("{} for law = \"{}\"", keys.join(", "), kind.name());
            let (key, given) = (join(path, name), node.given());
            reader.complain(Complaint::new(Fault::Unknown, key, node.origin, given, allowed));
        }
    }
}

/// Whether a law has a key with this role.
fn belongs(role: Role, kind: LawKind) -> bool {
    match role {
        Role::Number(parameter) | Role::Twin(parameter, _) => {
            let mut known = kind.parameters().iter().chain(kind.options());
            known.any(|known| known.path == parameter.path)
        }
        Role::FrictionForce(parameter, _) => forces::belongs(kind, parameter),
        Role::Flag => LawKind::NUMERIC.contains(&kind),
        Role::Table(_) => kind == LawKind::Expression,
        Role::Coefficient => {
            matches!(kind, LawKind::Expression | LawKind::Samples)
                || kind.parameters().iter().any(|known| known.path == COEFFICIENT.path)
        }
        Role::Speeds { .. } | Role::Terms | Role::Text => kind == LawKind::Samples,
        _ => true,
    }
}
