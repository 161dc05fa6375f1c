//! A law written as a formula, with its named constants and the parameters of the study that it uses.

use quell_input::complaint::Origin;
use quell_input::document::{Node, Table, Value};
use quell_model::parameter::{Bounds, MAXIMUM_VELOCITY, STATIC_COEFFICIENT};
use quell_model::units::Quantity;
use quell_model::{Expression, Friction, Invalid, InvalidValues};

use crate::study::reader::Reader;
use crate::study::vocabulary::{KeyUnit, join};

/// The table of the constants of a formula.
pub(super) const CONSTANTS: &str = "constants";

/// Reads `coefficient`, `static_coefficient`, `maximum_velocity` and the table `constants`.
pub(super) fn read(
    reader: &mut Reader,
    table: &Table,
    path: &str,
    header: Origin,
) -> Option<Friction> {
    let own = constants(reader, table, path);
    let level = reader.optional(table, path, STATIC_COEFFICIENT).if_given();
    let key = join(path, "coefficient");
    let Some(node) = table.get("coefficient") else {
        let allowed = "a formula in the slip velocity v, such as \"0.3 + 0.1*exp(-abs(v)/0.2)\"";
        reader.missing(key, header, allowed);
        return None;
    };
    let text = match &node.value {
        Value::Text(text) => text.clone(),
        Value::Number(number) => format!("{number:?}"),
        _ => {
            reader.wrong(&key, node, format!("a formula in quotes; got {}", node.kind()));
            return None;
        }
    };
    let maximum = reader.optional(table, path, MAXIMUM_VELOCITY).if_given();
    let (level, maximum) = (level?, maximum?);
    // The proof needs the belt: its errors come later.
    reader.remember(path, ("coefficient", "coefficient"), node.origin, 1.0);
    let mut constants = own?;
    constants.extend(parameters_in(reader, &text, &constants));
    let law = LawFormula { text, constants, level, unit: velocity_unit(reader) }.compiled(reader);
    match law.and_then(|law| law.with_maximum_velocity(maximum)) {
        Ok(law) => Some(Friction::Expression(law)),
        Err(invalid) => {
            complain(reader, table, path, node, invalid);
            None
        }
    }
}

/// What determines the law of a formula.
#[derive(Debug, PartialEq)]
struct LawFormula {
    text: String,
    constants: Vec<(String, f64)>,
    level: Option<f64>,
    unit: f64,
}

impl LawFormula {
    /// Its law, which is compiled once for all readings with the same numbers.
    fn compiled(self, reader: &mut Reader) -> Result<Expression, InvalidValues> {
        let same = |(known, _): &(Self, Expression)| *known == self;
        if let Some(known) = reader.computed().known(same) {
            return Ok(known.1.clone());
        }
        let Self { text, constants, level, unit } = &self;
        let law = Expression::new(text, constants, *level, *unit)?;
        reader.computed().keep((self, law.clone()));
        Ok(law)
    }
}

/// One velocity of the study in the numbers of the equations.
pub(super) fn velocity_unit(reader: &Reader) -> f64 {
    // An invalid mass or stiffness has been reported already, and no law is built then.
    reader.units().in_equations(1.0, Quantity::Velocity, KeyUnit::Study).unwrap_or(1.0)
}

fn constants(reader: &mut Reader, table: &Table, path: &str) -> Option<Vec<(String, f64)>> {
    let Some(node) = table.get(CONSTANTS) else { return Some(Vec::new()) };
    let path = join(path, CONSTANTS);
    let table = reader.table(&path, node)?;
    let read: Vec<Option<(String, f64)>> = table
        .iter()
        .map(|(name, node)| {
            let value = reader.within(&join(&path, name), node, Bounds::FINITE, "", false)?;
            Some((name.to_owned(), value))
        })
        .collect();
    read.into_iter().collect()
}

/// The parameters of the study that a formula uses, but for those that a constant of its own hides.
fn parameters_in(reader: &Reader, text: &str, own: &[(String, f64)]) -> Vec<(String, f64)> {
    let word = |letter: char| letter.is_ascii_alphanumeric() || letter == '_';
    let words: Vec<&str> = text.split(|letter| !word(letter)).collect();
    let named = reader.named();
    let known = named.names.iter().zip(&named.values).filter(|(name, _)| {
        words.contains(&name.as_str()) && own.iter().all(|(known, _)| known != *name)
    });
    known.map(|(name, value)| (name.clone(), *value)).collect()
}

/// Reports the errors of the model about a user-defined law, each under its key.
pub(super) fn complain(
    reader: &mut Reader,
    table: &Table,
    path: &str,
    formula: &Node,
    invalid: InvalidValues,
) {
    for Invalid { key, allowed, .. } in invalid {
        let rest = key.strip_prefix("friction.").unwrap_or(&key);
        let inside = table.get(CONSTANTS).and_then(Node::table);
        let node = match rest.strip_prefix(CONSTANTS) {
            Some(name) => inside.and_then(|table| table.get(name.trim_start_matches('.'))),
            None => table.get(rest),
        };
        let allowed = allowed.replace("friction.", &format!("{path}."));
        reader.wrong_once(&join(path, rest), node.unwrap_or(formula), allowed);
    }
}
