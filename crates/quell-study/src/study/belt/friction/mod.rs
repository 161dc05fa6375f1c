//! `[friction]`: a law and its parameters, or a user-defined law.

use quell_model::friction::Otherwise;
use quell_model::parameter::{COEFFICIENT, STATIC_COEFFICIENT};
use quell_model::{Friction, LawKind};
use serde_json::Value as Json;

use crate::complaint::{Complaint, Fault, Origin};
use crate::study::document::{Node, Table};
use crate::study::reader::{Found, Reader};
use crate::study::vocabulary::{self, Choice, Role, Section};
pub(super) use forces::{in_newtons, needs_no_normal_force};
pub use measured::Measured;
pub(in crate::study) use samples::in_file;

mod expression;
mod forces;
mod measured;
mod read_law;
mod samples;

use read_law::ReadLaw;

/// Reads `[friction]`; `normal_load` is the normal load F, if given and valid.
pub(super) fn read(reader: &mut Reader, root: &Table, normal_load: Option<f64>) -> Option<ReadLaw> {
    let Some(node) = root.get("friction") else {
        let allowed = "a table [friction] with law and its parameters";
        reader.complain(Complaint::new(
            Fault::Missing,
            "friction",
            Origin::Whole,
            Json::Null,
            allowed,
        ));
        return None;
    };
    read_table(reader, node, normal_load)
}

/// Reads the table of a law; its keys are reported as those of `[friction]`.
pub(in crate::study) fn read_table(
    reader: &mut Reader,
    node: &Node,
    normal_load: Option<f64>,
) -> Option<ReadLaw> {
    let table = reader.table("friction", node)?;
    let name = reader.needed_choice(table, "friction", node.origin, "law", Choice::Law);
    let kind = name.and_then(LawKind::from_name);
    unknown_keys(reader, table, kind);
    match kind {
        Some(LawKind::Expression) => expression::read(reader, table, node.origin).map(ReadLaw::of),
        Some(LawKind::Samples) => samples::read(reader, table, node.origin),
        Some(kind) if forces::are_given(table) => {
            forces::read(reader, table, node.origin, kind, normal_load)
        }
        kind => numeric_law(reader, table, node, kind).map(ReadLaw::of),
    }
}

/// Reads the law of a disc, which is defined by numbers alone.
pub(in crate::study) fn of_a_disc(reader: &mut Reader, node: &Node) -> Option<Friction> {
    let table = reader.table("friction", node)?;
    let name = reader.needed_choice(table, "friction", node.origin, "law", Choice::Law);
    let kind = name.and_then(LawKind::from_name);
    unknown_keys(reader, table, kind);
    let numeric = |kind: &LawKind| LawKind::NUMERIC.contains(kind);
    if let Some(kind) = kind.filter(|kind| !numeric(kind) || forces::are_given(table)) {
        let words: Vec<&str> = LawKind::NUMERIC.iter().map(|kind| kind.name()).collect();
        let allowed = format!("a law of coefficients for a disc: {}", words.join(", "));
        let given = Json::from(kind.name());
        reader.complain(Complaint::new(Fault::Value, "friction.law", node.origin, given, allowed));
        return None;
    }
    numeric_law(reader, table, node, kind)
}

/// A law defined by numbers alone.
fn numeric_law(
    reader: &mut Reader,
    table: &Table,
    node: &Node,
    kind: Option<LawKind>,
) -> Option<Friction> {
    // Without a law its parameters are still checked individually.
    let parameters = kind.map_or_else(|| LawKind::ALL[0].parameters(), LawKind::parameters);
    // NaN stands for a value already reported: `adopt` reports nothing twice.
    let mut values: Vec<f64> = Vec::with_capacity(parameters.len());
    for parameter in parameters {
        if kind.is_none() && !table.has(parameter.key()) {
            continue;
        }
        let value = match reader.optional(table, "friction", *parameter, None) {
            Found::Value(value) => Some(value),
            Found::Wrong => None,
            Found::Absent => match kind.and_then(|kind| kind.default_of(parameter.path)) {
                Some(Otherwise::Number(number)) => Some(number),
                Some(Otherwise::SameAs(path)) => {
                    let earlier = parameters.iter().position(|known| known.path == path);
                    earlier.and_then(|place| values.get(place).copied())
                }
                None => reader.number(table, "friction", node.origin, *parameter),
            },
        };
        values.push(value.unwrap_or(f64::NAN));
    }
    match kind?.build(&values) {
        // A static level that is not given equals the coefficient.
        Ok(Friction::Coulomb(law)) if !table.has(STATIC_COEFFICIENT.key()) => {
            Some(Friction::Coulomb(law.without_static_level()))
        }
        Ok(law) => Some(law),
        Err(invalid) => {
            reader.adopt(invalid);
            None
        }
    }
}

/// The table of the constants of a formula.
const CONSTANTS: &str = "constants";

/// Reports keys that no law has, or that this law does not have.
fn unknown_keys(reader: &mut Reader, table: &Table, kind: Option<LawKind>) {
    for (name, node) in table.iter() {
        let key = vocabulary::key(Section::Friction, name);
        if key.is_none() && name != CONSTANTS {
            reader.unknown_key(Section::Friction, "friction", name, node);
            continue;
        }
        let Some(kind) = kind else { continue };
        let has = key.map_or(kind == LawKind::Expression, |key| belongs(key.role, kind));
        if !has {
            let constants = (kind == LawKind::Expression).then_some(CONSTANTS);
            let keys = reader.keys_there(Section::Friction);
            let keys: Vec<&str> = keys
                .filter(|key| belongs(key.role, kind))
                .map(|key| key.name)
                .chain(constants)
                .collect();
            // It is a key of another law: no suggestion is needed.
            let allowed = format!("{} for law = \"{}\"", keys.join(", "), kind.name());
            let key = vocabulary::join("friction", name);
            reader.complain(Complaint::new(
                Fault::Unknown,
                key,
                node.origin,
                node.given(),
                allowed,
            ));
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
        Role::FrictionForce(parameter, _) => forces::gives(kind, parameter),
        Role::Coefficient => {
            matches!(kind, LawKind::Expression | LawKind::Samples)
                || forces::gives(kind, COEFFICIENT)
        }
        Role::Speeds { .. } | Role::Terms | Role::Text => kind == LawKind::Samples,
        _ => true,
    }
}
