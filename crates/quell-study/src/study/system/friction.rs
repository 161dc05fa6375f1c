//! The friction law of a contact.
//!
//! Its numbers may have units, twins in SI and formulas; with these resolved the table is one that the reader of a belt's
//! law understands, so every law is read in one place.

use quell_model::Friction;
use quell_model::parameter::{COEFFICIENT, STATIC_COEFFICIENT, VISCOUS};
use quell_model::units::{Quantity, Scales};

use super::numbers::{Keyed, Numbers, WantedNumber};
use super::units::SystemUnits;
use crate::complaint::{Complaint, Fault};
use crate::study::belt::friction;
use crate::study::document::{Node, Table, Value};
use crate::study::reader::Reader;
use crate::study::vocabulary::{self, Role, Section, join};

/// A law as it was read.
pub(super) struct LawRead {
    pub(super) law: Friction,
    /// Whether the coefficient was negative: the law is that of the positive one, for a surface that moves in the other
    /// direction.
    pub(super) reversed: bool,
}

/// Reads the law at `path`.
pub(super) fn read(
    reader: &mut Reader,
    node: &Node,
    path: &str,
    numbers: &Numbers,
    has_tangent: bool,
) -> Option<LawRead> {
    let table = reader.table(path, node)?;
    let before = reader.complaints_so_far();
    let (mut plain, renamed) = resolved(reader, table, path, numbers);
    let right = reader.complaints_so_far() == before;
    let reversed = !has_tangent && is_reversed(&plain);
    if reversed {
        for name in [COEFFICIENT.key(), STATIC_COEFFICIENT.key()] {
            if let Some(Value::Number(number)) = plain.get_mut(name).map(|node| &mut node.value) {
                *number = number.abs();
            }
        }
    }
    let mut inner = inner_reader(reader, numbers.units, table, path);
    let plain = Node { value: Value::Table(plain), origin: node.origin };
    let found = reader
        .lend(&mut inner, ("friction", path), |inner| friction::read_table(inner, &plain, None));
    let complaints = inner.into_complaints();
    let wrong = !complaints.is_empty() || !right;
    for complaint in complaints {
        let complaint = at_path(complaint, path, &renamed);
        if !reader.has_complaint_about(&complaint.key) {
            reader.complain(complaint);
        }
    }
    let found = found.filter(|_| !wrong)?;
    Some(LawRead { law: found.law, reversed })
}

/// Whether a Coulomb law has a negative coefficient and nothing that a change of direction would not carry over.
fn is_reversed(table: &Table) -> bool {
    let number = |name: &str| match table.get(name).map(|node| &node.value) {
        Some(Value::Number(number)) => Some(*number),
        _ => None,
    };
    let law = table.get("law").map(|node| &node.value);
    law == Some(&Value::Text("coulomb".to_owned()))
        && number(COEFFICIENT.key()).is_some_and(|number| number < 0.0)
        && number(STATIC_COEFFICIENT.key()).is_none_or(|number| number < 0.0)
        && number(VISCOUS.key()).is_none_or(|number| number == 0.0)
}

/// A reader for the resolved table. Measured slip speeds in metres per second stay in SI, where the belt's reader knows
/// them; its scales then convert them to the units of the file.
fn inner_reader(reader: &mut Reader, units: SystemUnits, table: &Table, path: &str) -> Reader {
    let mut in_file = || {
        let Some(Value::Text(name)) = table.get("file").map(|node| &node.value) else {
            return false;
        };
        let file = friction::in_file(reader.files(), &join(path, "file"), name);
        file.is_ok_and(|file| file.is_in_si())
    };
    let unit = units.si_per_unit(Quantity::Velocity);
    match unit.filter(|_| table.has("slip_velocity_m_per_s") || in_file()) {
        // ω₀ is the size of the unit of velocity.
        Some(unit) => Reader::in_si(Scales::new(1.0, unit * unit).ok()),
        None => Reader::as_written(),
    }
}

/// Names of resolved keys with the keys that were written.
type Renamed = Vec<(&'static str, String)>;

/// The table with every number as a plain number in the units of the file.
fn resolved(reader: &mut Reader, table: &Table, path: &str, numbers: &Numbers) -> (Table, Renamed) {
    let law = match table.get("law").map(|node| &node.value) {
        Some(Value::Text(text)) => text.as_str(),
        _ => "",
    };
    let (mut plain, mut renamed) = (Table::default(), Renamed::new());
    for (name, node) in table.iter() {
        let at = join(path, name);
        let role = vocabulary::key(Section::Friction, name).map(|key| key.role);
        match role {
            Some(Role::Number(parameter)) => {
                let wanted = WantedNumber::finite(Some(parameter.quantity));
                plain.set(name, number(reader, numbers, &at, node, wanted));
            }
            Some(Role::Coefficient) if law == "expression" => plain.set(name, node.clone()),
            Some(Role::Coefficient) => {
                let wanted = WantedNumber::finite(Some(Quantity::Ratio));
                plain.set(name, number(reader, numbers, &at, node, wanted));
            }
            Some(Role::Speeds { si: false }) => {
                let wanted = WantedNumber::finite(Some(Quantity::Velocity));
                plain.set(name, number(reader, numbers, &at, node, wanted));
            }
            Some(Role::Twin(parameter, twin)) => {
                let other = Some(twin.key);
                let found = numbers.keyed(reader, table, path, parameter.key(), other);
                let Some(Keyed { twin: true, .. }) = found else { continue };
                let wanted =
                    WantedNumber { twin: true, ..WantedNumber::finite(Some(parameter.quantity)) };
                plain.set(parameter.key(), number(reader, numbers, &at, node, wanted));
                renamed.push((parameter.key(), name.to_owned()));
            }
            Some(Role::FrictionForce(parameter, _)) => {
                let allowed = format!(
                    "a study of a system gives the coefficient {} and the normal load of the contact",
                    join(path, parameter.key())
                );
                let complaint =
                    Complaint::new(Fault::Conflict, at, node.origin, node.given(), allowed);
                reader.complain(complaint);
            }
            _ => plain.set(name, node.clone()),
        }
    }
    if law == "expression" {
        let constants = constants(reader, table, path, numbers);
        if let Some((node, constants)) = constants {
            plain.set("constants", Node { value: Value::Table(constants), origin: node.origin });
        }
    }
    (plain, renamed)
}

/// The constants of a formula and the parameters that it uses.
fn constants<'t>(
    reader: &mut Reader,
    table: &'t Table,
    path: &str,
    numbers: &Numbers,
) -> Option<(&'t Node, Table)> {
    let formula = table.get("coefficient")?;
    let mut constants = Table::default();
    let own = table.get("constants");
    for (name, node) in own.and_then(Node::table).into_iter().flat_map(Table::iter) {
        let at = format!("{path}.constants.{name}");
        constants.set(name, number(reader, numbers, &at, node, WantedNumber::finite(None)));
    }
    if let Value::Text(text) = &formula.value {
        let word = |letter: char| letter.is_ascii_alphanumeric() || letter == '_';
        let words: Vec<&str> = text.split(|letter| !word(letter)).collect();
        for (name, value) in numbers.names.iter().zip(&numbers.values) {
            if words.contains(&name.as_str()) && !constants.has(name) {
                let value = Value::Number(*value);
                constants.set(name, Node { value, origin: formula.origin });
            }
        }
    }
    let node = own.unwrap_or(formula);
    (own.is_some() || constants.iter().next().is_some()).then_some((node, constants))
}

/// A node with its numbers evaluated; bounds are left to the reader of laws.
fn number(
    reader: &mut Reader,
    numbers: &Numbers,
    key: &str,
    node: &Node,
    wanted: WantedNumber,
) -> Node {
    if let Value::List(list) = &node.value {
        let list = list
            .iter()
            .enumerate()
            .map(|(index, node)| number(reader, numbers, &format!("{key}[{index}]"), node, wanted));
        return Node { value: Value::List(list.collect()), origin: node.origin };
    }
    if matches!(node.value, Value::Number(number) if !number.is_finite()) {
        return node.clone();
    }
    match numbers.number(reader, || key.to_owned(), node, wanted) {
        Some(value) => Node { value: Value::Number(value), origin: node.origin },
        None => node.clone(),
    }
}

/// A complaint of the reader of laws under the key of the file.
fn at_path(complaint: Complaint, path: &str, renamed: &Renamed) -> Complaint {
    let moved = |key: &str| {
        let name = key.strip_prefix("friction").unwrap_or(key).trim_start_matches('.');
        let written = renamed.iter().find(|(plain, _)| *plain == name);
        let name = written.map_or(name, |(_, written)| written.as_str());
        if name.is_empty() { path.to_owned() } else { join(path, name) }
    };
    let key = moved(&complaint.key);
    let suggestion = complaint
        .suggestion
        .as_deref()
        .map(|key| if key.starts_with("friction") { moved(key) } else { key.to_owned() });
    let allowed = complaint.allowed.replace("friction.", &format!("{path}."));
    Complaint { key, allowed, suggestion, ..complaint }
}
