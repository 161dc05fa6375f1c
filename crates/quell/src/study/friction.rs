//! `[friction]`: a law and its parameters.

use quell_model::{Friction, LawKind};
use serde_json::Value as Json;

use super::mirror::Table;
use super::reader::Reader;
use super::vocabulary::{self, Choice, Role, Section};
use crate::complaint::{Complaint, Fault, Origin};

/// Reads `[friction]`.
pub(super) fn read(reader: &mut Reader, root: &Table) -> Option<Friction> {
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

/// Complains about keys that no law, or not this law, has.
fn unknown_keys(reader: &mut Reader, table: &Table, kind: Option<LawKind>) {
    for (name, node) in table.iter() {
        let known = vocabulary::key(Section::Friction, name).is_some_and(|key| match key.role {
            Role::Number(parameter) | Role::Twin(parameter, _) => kind.is_none_or(|kind| {
                kind.parameters().iter().any(|known| known.path == parameter.path)
            }),
            _ => true,
        });
        if !known {
            reader.unknown_key(Section::Friction, "friction", name, node);
        }
    }
}
