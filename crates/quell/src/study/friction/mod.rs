//! `[friction]`: a law and its parameters, or a law of one's own.

use std::path::Path;

use quell_model::{Friction, LawKind};
use serde_json::Value as Json;

use super::mirror::{Node, Table};
use super::reader::Reader;
use super::vocabulary::{self, Choice, Role, Section};
use crate::complaint::{Complaint, Fault, Origin};
pub use samples::Measured;

mod expression;
mod samples;

/// A law, and the samples that it was fitted to.
pub(super) type Read = (Friction, Option<Measured>);

/// Reads `[friction]`. Files of samples are looked for in `folder`; those that are known already are
/// neither read nor fitted again.
pub(super) fn read(
    reader: &mut Reader,
    root: &Table,
    folder: &Path,
    known: Option<&Measured>,
) -> Option<Read> {
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
    let table = reader.table("friction", node)?;
    let name = reader.needed_choice(table, "friction", node.origin, "law", Choice::Law);
    let kind = name.and_then(LawKind::from_name);
    unknown_keys(reader, table, kind);
    match kind {
        Some(LawKind::Expression) => {
            expression::read(reader, table, node.origin).map(|law| (law, None))
        }
        Some(LawKind::Samples) => samples::read(reader, table, node.origin, folder, known),
        kind => numeric(reader, table, node, kind).map(|law| (law, None)),
    }
}

/// A law that is nothing but its numbers.
fn numeric(
    reader: &mut Reader,
    table: &Table,
    node: &Node,
    kind: Option<LawKind>,
) -> Option<Friction> {
    // Without a law its parameters are still judged, each by itself.
    let parameters = kind.map_or_else(|| LawKind::ALL[0].parameters(), LawKind::parameters);
    let values: Vec<Option<f64>> = parameters
        .iter()
        .filter(|parameter| kind.is_some() || table.has(parameter.key()))
        .map(|parameter| reader.number(table, "friction", node.origin, *parameter))
        .collect();
    // NaN stands for what was complained about: `adopt` says nothing twice.
    let known: Vec<f64> = values.iter().map(|value| value.unwrap_or(f64::NAN)).collect();
    match kind?.build(&known) {
        Ok(law) => Some(law),
        Err(invalid) => {
            reader.adopt(invalid);
            None
        }
    }
}

/// The table of the constants of a formula.
const CONSTANTS: &str = "constants";

/// Complains about keys that no law, or not this law, has.
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
            // It is a key, only not one of this law: there is no nearer one to suggest.
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

/// Whether a law has a key that takes this.
fn belongs(role: Role, kind: LawKind) -> bool {
    match role {
        Role::Number(parameter) | Role::Twin(parameter, _) => {
            kind.parameters().iter().any(|known| known.path == parameter.path)
        }
        Role::Coefficient => matches!(kind, LawKind::Expression | LawKind::Samples),
        Role::Speeds { .. } | Role::Terms | Role::Text => kind == LawKind::Samples,
        _ => true,
    }
}
