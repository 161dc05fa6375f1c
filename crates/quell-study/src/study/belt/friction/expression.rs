//! A law written as a formula, with its named constants.

use quell_model::friction::expression::{CONSTANTS, FORMULA};
use quell_model::parameter::{Bounds, MAXIMUM_VELOCITY, STATIC_COEFFICIENT};
use quell_model::units::Quantity;
use quell_model::{Expression, Friction, Invalid, InvalidValues};
use serde_json::Value as Json;

use crate::complaint::{Complaint, Fault, Origin};
use crate::study::document::{Node, Table, Value};
use crate::study::reader::{Found, Reader};

/// Reads `coefficient`, `static_coefficient`, `maximum_velocity` and `[friction.constants]`.
pub(super) fn read(reader: &mut Reader, table: &Table, header: Origin) -> Option<Friction> {
    let constants = constants(reader, table);
    let level = reader.optional(table, "friction", STATIC_COEFFICIENT, None);
    let Some(node) = table.get("coefficient") else {
        let allowed = "a formula in the slip velocity v, such as \"0.3 + 0.1*exp(-abs(v)/0.2)\"";
        reader.complain(Complaint::new(Fault::Missing, FORMULA, header, Json::Null, allowed));
        return None;
    };
    let text = match &node.value {
        Value::Text(text) => text.clone(),
        Value::Number(number) => format!("{number:?}"),
        _ => {
            reader.wrong(FORMULA, node, format!("a formula in quotes; got {}", node.kind()));
            return None;
        }
    };
    let level = match level {
        Found::Value(level) => Some(level),
        Found::Absent => None,
        Found::Wrong => return None,
    };
    let maximum = match reader.optional(table, "friction", MAXIMUM_VELOCITY, None) {
        Found::Value(speed) => Some(speed),
        Found::Absent => None,
        Found::Wrong => return None,
    };
    // The proof needs the belt: its errors come later.
    reader.remember(FORMULA, FORMULA, node.origin, 1.0);
    let law = Expression::new(&text, &constants?, level, velocity_unit(reader));
    match law.and_then(|law| law.with_maximum_velocity(maximum)) {
        Ok(law) => Some(Friction::Expression(law)),
        Err(invalid) => {
            complain(reader, table, node, invalid);
            None
        }
    }
}

/// The dimensionless velocity of one velocity unit of the study.
pub(super) fn velocity_unit(reader: &Reader) -> f64 {
    // An invalid mass or stiffness has been reported already, and no law is built then.
    reader.known_scales().map_or(1.0, |scales| scales.from_si(Quantity::Velocity, 1.0))
}

fn constants(reader: &mut Reader, table: &Table) -> Option<Vec<(String, f64)>> {
    let Some(node) = table.get("constants") else { return Some(Vec::new()) };
    let table = reader.table(CONSTANTS, node)?;
    let read: Vec<Option<(String, f64)>> = table
        .iter()
        .map(|(name, node)| {
            let key = format!("{CONSTANTS}.{name}");
            let value = reader.within(&key, node, Bounds::FINITE, "", false)?;
            Some((name.to_owned(), value))
        })
        .collect();
    read.into_iter().collect()
}

/// Reports the errors of the model about a user-defined law, each under its key.
pub(super) fn complain(reader: &mut Reader, table: &Table, formula: &Node, invalid: InvalidValues) {
    for Invalid { key, allowed, .. } in invalid {
        let name = key.rsplit('.').next().unwrap_or_default();
        let inside = table.get("constants").and_then(Node::table);
        let node = if key.starts_with(CONSTANTS) {
            inside.and_then(|table| table.get(name))
        } else {
            table.get(name)
        };
        reader.wrong(&key, node.unwrap_or(formula), allowed);
    }
}
