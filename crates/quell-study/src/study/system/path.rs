//! Paths of a study of a system, such as `contact.pad.friction.coefficient` or `system.stiffness[0][1]`.
//!
//! A path is followed through the document: entries of lists are named by an index, contacts also by their name, and a
//! single entry needs neither.

use std::fmt::Write as _;

use quell_model::parameter::Parameter;
use quell_model::units::Quantity;

use super::keys::{SystemKey, SystemRole, SystemTable, system_keys};
use super::numbers::{Numbers, Wanted};
use super::units::SystemUnits;
use crate::complaint::{Complaint, Fault};
use crate::study::document::{Node, Table, Value};
use crate::study::suggest;
use crate::study::vocabulary::{self, Role, Section};

/// A number of a study of a system.
#[derive(Clone, Debug, PartialEq)]
pub struct SystemAddress {
    /// Its path with every index, the same for all ways to write it.
    pub path: String,
    /// Description, in one line.
    pub about: &'static str,
    /// Symbol in the equations, if it is a number of the registry.
    pub symbol: Option<&'static str>,
    /// Its quantity, if it has one.
    pub quantity: Option<Quantity>,
    /// Unit of its value; `1` without a unit.
    pub unit: &'static str,
    /// Whether a value of the path is in SI whatever the units of the file.
    pub twin: bool,
}

/// Finds the number that a path names in a document.
///
/// # Errors
/// The nearest existing path, if any is close enough.
pub fn resolve_in(document: &Table, path: &str) -> Result<SystemAddress, Option<String>> {
    let found = follow(document, path).map_err(|lost| lost.nearest)?;
    if !found.is_number {
        return Err(None);
    }
    let mut canonical = String::new();
    for step in &found.steps {
        match step {
            Step::Key(name) if canonical.is_empty() => canonical.push_str(name),
            Step::Key(name) => {
                let _ = write!(canonical, ".{name}");
            }
            Step::Index(index) => {
                let _ = write!(canonical, "[{index}]");
            }
        }
    }
    Ok(SystemAddress {
        unit: unit(document, found.quantity, found.twin).unwrap_or("1"),
        path: canonical,
        about: found.about,
        symbol: found.parameter.map(|parameter| parameter.symbol),
        quantity: found.quantity,
        twin: found.twin,
    })
}

/// The unit to which values of a path are converted.
pub(in crate::study) fn measured_in(document: &Table, path: &str) -> Option<&'static str> {
    let found = follow(document, path).ok()?;
    match found.quantity {
        Some(Quantity::Ratio) => Some("1"),
        quantity => unit(document, quantity, found.twin),
    }
}

fn unit(document: &Table, quantity: Option<Quantity>, twin: bool) -> Option<&'static str> {
    let quantity = quantity?;
    if twin {
        return quantity.si_unit().map(|(unit, _)| unit);
    }
    let system = document.get("system").and_then(Node::table);
    let units = match system.and_then(|table| table.get("units")).map(|node| &node.value) {
        Some(Value::Text(name)) => SystemUnits::from_name(name).unwrap_or_default(),
        _ => SystemUnits::None,
    };
    units.unit(quantity)
}

/// Sets the value of a path.
///
/// # Errors
/// A path that does not exist, with the nearest one.
pub(in crate::study) fn set(
    document: &mut Table,
    path: &str,
    node: &Node,
) -> Result<(), Box<Complaint>> {
    let found = match follow(document, path) {
        Ok(found) => found,
        Err(lost) => {
            let fault = if lost.allowed.is_some() { Fault::Conflict } else { Fault::Unknown };
            let allowed = lost.allowed.unwrap_or_else(|| "the keys of the study".to_owned());
            let complaint = Complaint::new(fault, path, node.origin, node.given(), allowed);
            return Err(Box::new(complaint.suggesting(lost.nearest)));
        }
    };
    let Some((last, steps)) = found.steps.split_last() else { return Ok(()) };
    let mut at = Place::Table(document);
    for step in steps {
        let Some(next) = at.inside(step, node) else { return Ok(()) };
        at = next;
    }
    match (at, last) {
        (Place::Table(table), Step::Key(name)) => {
            for sibling in &found.replaces {
                if sibling != name {
                    table.remove(sibling);
                }
            }
            table.set(name, node.clone());
        }
        (Place::List(list), Step::Index(index)) => {
            if let Some(entry) = list.get_mut(*index) {
                *entry = node.clone();
            }
        }
        _ => {}
    }
    Ok(())
}

/// The number at a path; `None` if the study has none there.
pub(super) fn number(document: &Table, numbers: &Numbers, path: &str) -> Option<f64> {
    let found = follow(document, path).ok().filter(|found| found.is_number)?;
    let wanted = Wanted { twin: found.twin, ..Wanted::finite(found.quantity) };
    let size = numbers.file_units(wanted);
    let node = found.node(document);
    if let Some(node) = node {
        return numbers.value(node, wanted).ok().map(|value| value / size);
    }
    // The number may be given by another key in other units, or have a default.
    let (Some(Step::Key(last)), Some(parameter)) = (found.steps.last(), found.parameter) else {
        return None;
    };
    for other in found.replaces.iter().filter(|name| *name != last) {
        let mut steps = found.steps.clone();
        steps.pop();
        steps.push(Step::Key(other.clone()));
        let twin = other != parameter.key();
        if let Some(node) = node_at(document, &steps) {
            let wanted = Wanted { twin, ..wanted };
            return numbers.value(node, wanted).ok().map(|value| value / size);
        }
    }
    let optional = ["normal_stiffness", "normal_damping", "phase"];
    optional.contains(&parameter.key()).then_some(0.0)
}

/// A step from a value of the document to one inside it.
#[derive(Clone, Debug, PartialEq)]
enum Step {
    Key(String),
    Index(usize),
}

/// A path that was followed to its end.
#[derive(Debug)]
struct Found {
    steps: Vec<Step>,
    about: &'static str,
    parameter: Option<Parameter>,
    quantity: Option<Quantity>,
    twin: bool,
    is_number: bool,
    /// Keys of the same table that the value replaces.
    replaces: Vec<String>,
}

impl Found {
    fn node<'d>(&self, document: &'d Table) -> Option<&'d Node> {
        node_at(document, &self.steps)
    }
}

fn node_at<'d>(document: &'d Table, steps: &[Step]) -> Option<&'d Node> {
    let (Step::Key(first), rest) = steps.split_first()? else { return None };
    let mut node = document.get(first)?;
    for step in rest {
        node = match (&node.value, step) {
            (Value::Table(table), Step::Key(name)) => table.get(name)?,
            (Value::List(list), Step::Index(index)) => list.get(*index)?,
            _ => return None,
        };
    }
    Some(node)
}

/// A path that leads nowhere.
#[derive(Debug, Default)]
struct Lost {
    nearest: Option<String>,
    /// What is wrong, if more is known than that the path does not exist.
    allowed: Option<String>,
}

impl Lost {
    fn because(allowed: impl Into<String>) -> Self {
        Self { allowed: Some(allowed.into()), ..Self::default() }
    }
}

/// A value of the document that is changed.
enum Place<'d> {
    Table(&'d mut Table),
    List(&'d mut Vec<Node>),
}

impl<'d> Place<'d> {
    /// The value inside; a missing table is created.
    fn inside(self, step: &Step, node: &Node) -> Option<Self> {
        let value: &'d mut Value = match (self, step) {
            (Self::Table(table), Step::Key(name)) => {
                if !table.has(name) {
                    let value = Value::Table(Table::default());
                    table.set(name, Node { value, origin: node.origin });
                }
                &mut table.get_mut(name)?.value
            }
            (Self::List(list), Step::Index(index)) => &mut list.get_mut(*index)?.value,
            _ => return None,
        };
        match value {
            Value::Table(table) => Some(Self::Table(table)),
            Value::List(list) => Some(Self::List(list)),
            _ => None,
        }
    }
}

/// A name of a path with the indices after it.
#[derive(Clone, Debug)]
struct Segment<'p> {
    name: &'p str,
    indices: Vec<usize>,
}

fn segments(path: &str) -> Option<Vec<Segment<'_>>> {
    path.trim()
        .split('.')
        .map(|part| {
            let (name, mut rest) = match part.find('[') {
                Some(at) => part.split_at(at),
                None => (part, ""),
            };
            let mut indices = Vec::new();
            while let Some(inner) = rest.strip_prefix('[') {
                let (index, after) = inner.split_once(']')?;
                indices.push(index.trim().parse().ok()?);
                rest = after;
            }
            (rest.is_empty() && !name.is_empty()).then_some(Segment { name, indices })
        })
        .collect()
}

/// Follows a path through the document.
fn follow(document: &Table, path: &str) -> Result<Found, Lost> {
    let Some(segments) = segments(path) else { return Err(Lost::default()) };
    let mut walk = Walk { document, steps: Vec::new(), written: String::new() };
    walk.table(SystemTable::Root, Some(document), &segments)
}

struct Walk<'d> {
    document: &'d Table,
    steps: Vec<Step>,
    /// The part of the path that was followed.
    written: String,
}

impl<'d> Walk<'d> {
    fn go(&mut self, name: &str) {
        self.steps.push(Step::Key(name.to_owned()));
        if !self.written.is_empty() {
            self.written.push('.');
        }
        self.written.push_str(name);
    }

    fn found(&self, key: &SystemKey, twin: bool) -> Found {
        let replaces = std::iter::once(key.name.to_owned()).chain(key.twins()).collect();
        Found {
            steps: self.steps.clone(),
            about: key.about,
            parameter: match key.role {
                SystemRole::Number(parameter) => Some(parameter),
                _ => None,
            },
            quantity: key.quantity(),
            twin,
            is_number: matches!(key.role, SystemRole::Number(_)),
            replaces,
        }
    }

    /// Follows the rest of a path from a table.
    fn table(
        &mut self,
        which: SystemTable,
        table: Option<&'d Table>,
        path: &[Segment<'_>],
    ) -> Result<Found, Lost> {
        let Some((segment, rest)) = path.split_first() else {
            let allowed = format!("set key by key: {} is a table", self.written);
            return Err(Lost::because(allowed));
        };
        match which {
            SystemTable::Named => return self.named(table, segment, rest),
            SystemTable::Friction => return self.friction(table, segment, rest),
            _ => {}
        }
        let keys = system_keys(which);
        let plain = keys.iter().find(|key| key.name == segment.name).map(|key| (key, false));
        let (key, twin) = plain
            .or_else(|| {
                let twins = |key: &&SystemKey| key.twins().iter().any(|twin| twin == segment.name);
                keys.iter().find(twins).map(|key| (key, true))
            })
            .ok_or_else(|| self.lost(which, segment, rest))?;
        let node = table.and_then(|table| table.get(segment.name));
        self.go(segment.name);
        match key.role {
            SystemRole::Tables(inner) => self.tables(inner, node, segment, rest),
            SystemRole::Table(inner) if segment.indices.is_empty() => {
                let table = node.and_then(Node::table);
                self.table(inner, table, rest)
            }
            SystemRole::Matrix(_) => self.matrix(key, twin, node, segment, rest),
            SystemRole::Row(_) => self.row(key, twin, which, node, segment, rest),
            _ if rest.is_empty() && segment.indices.is_empty() => {
                let mut found = self.found(key, twin);
                if which == SystemTable::Initial {
                    let others = system_keys(which).iter().map(|key| key.name.to_owned());
                    found.replaces.extend(others);
                }
                Ok(found)
            }
            _ => Err(Lost::default()),
        }
    }

    /// An entry of a list of tables.
    fn tables(
        &mut self,
        which: SystemTable,
        node: Option<&'d Node>,
        segment: &Segment<'_>,
        rest: &[Segment<'_>],
    ) -> Result<Found, Lost> {
        let name = segment.name;
        let (entries, listed): (&[Node], bool) = match node {
            None => (&[], false),
            Some(Node { value: Value::List(list), .. }) => (list, true),
            Some(node) => (std::slice::from_ref(node), false),
        };
        let name_of = |node: &'d Node| match node.table()?.get("name").map(|node| &node.value) {
            Some(Value::Text(text)) => Some(text.as_str()),
            _ => None,
        };
        let named = rest.first().and_then(|first| {
            let default = |index: usize| format!("contact {}", index + 1);
            let is = |(index, node): (usize, &'d Node)| match name_of(node) {
                Some(name) => name == first.name,
                None => which == SystemTable::Contact && default(index) == first.name,
            };
            let by_name = matches!(which, SystemTable::Contact | SystemTable::Component);
            entries.iter().enumerate().position(is).filter(|_| by_name && first.indices.is_empty())
        });
        let (index, rest) = match (segment.indices.as_slice(), named) {
            ([index], _) => (*index, rest),
            ([], Some(index)) => (index, &rest[1..]),
            ([], None) if entries.len() == 1 => (0, rest),
            ([], None) => {
                let first = rest.first().map(|first| first.name).unwrap_or_default();
                let names: Vec<&str> = entries.iter().filter_map(name_of).collect();
                let nearest = suggest::word(first, names.iter().copied());
                let nearest = nearest
                    .filter(|_| rest.len() > 1)
                    .map(|found| format!("{name}.{found}{}", after(&rest[1..])));
                let allowed = match entries.len() {
                    0 => format!("the study has no [[{name}]]"),
                    count if names.is_empty() => {
                        format!("specify which one: {name}[0] to {name}[{}]", count - 1)
                    }
                    _ => format!("specify which one: {name}.NAME with {}", names.join(", ")),
                };
                return Err(Lost { nearest, allowed: Some(allowed) });
            }
            _ => return Err(Lost::default()),
        };
        let Some(entry) = entries.get(index) else {
            let count = entries.len();
            let allowed = match count {
                0 => format!("the study has no [[{name}]]"),
                1 => format!("the study has one: {name}[0]"),
                _ => format!("the study has {count} of them: {name}[0] to {name}[{}]", count - 1),
            };
            return Err(Lost::because(allowed));
        };
        if listed {
            self.steps.push(Step::Index(index));
        }
        if entries.len() > 1 {
            match name_of(entry) {
                Some(own) if which == SystemTable::Contact => {
                    let _ = write!(self.written, ".{own}");
                }
                _ => {
                    let _ = write!(self.written, "[{index}]");
                }
            }
        }
        let table = entry.table();
        if which == SystemTable::Contact
            && rest.first().is_some_and(|first| first.name == "friction")
            && table.is_some_and(|table| !table.has("friction"))
            && let Some(shared) = self.document.get("friction")
        {
            if entries.len() > 1 {
                let allowed = "the law of this contact is that of all: use friction.…";
                return Err(Lost::because(allowed));
            }
            self.steps = vec![Step::Key("friction".to_owned())];
            return self.friction_of(shared.table(), &rest[1..]);
        }
        self.table(which, table, rest)
    }

    fn friction_of(
        &mut self,
        table: Option<&'d Table>,
        rest: &[Segment<'_>],
    ) -> Result<Found, Lost> {
        let (segment, rest) = rest.split_first().ok_or_else(Lost::default)?;
        self.friction(table, segment, rest)
    }

    /// A number of a friction law.
    fn friction(
        &mut self,
        table: Option<&'d Table>,
        segment: &Segment<'_>,
        rest: &[Segment<'_>],
    ) -> Result<Found, Lost> {
        if segment.name == "constants" {
            let inner = table.and_then(|table| table.get("constants")).and_then(Node::table);
            self.go("constants");
            return self.table(SystemTable::Named, inner, rest);
        }
        let key = vocabulary::key(Section::Friction, segment.name)
            .filter(|key| !matches!(key.role, Role::FrictionForce(..)) && rest.is_empty());
        let Some(key) = key else { return Err(self.lost(SystemTable::Friction, segment, rest)) };
        self.go(segment.name);
        let parameter = key.parameter();
        let siblings = parameter.map(|parameter| {
            let twins = parameter.si.iter().map(|twin| twin.key.to_owned());
            twins.chain([parameter.key().to_owned()]).collect()
        });
        let mut found = Found {
            steps: self.steps.clone(),
            about: key.about,
            parameter,
            quantity: parameter.map(|parameter| parameter.quantity),
            twin: matches!(key.role, Role::Twin(..)),
            is_number: parameter.is_some(),
            replaces: siblings.unwrap_or_default(),
        };
        if let [index] = segment.indices.as_slice() {
            found.steps.push(Step::Index(*index));
        }
        Ok(found)
    }

    /// A number whose name the study chooses.
    fn named(
        &mut self,
        table: Option<&'d Table>,
        segment: &Segment<'_>,
        rest: &[Segment<'_>],
    ) -> Result<Found, Lost> {
        let known: Vec<&str> =
            table.into_iter().flat_map(Table::iter).map(|(name, _)| name).collect();
        if !known.contains(&segment.name) || !rest.is_empty() || !segment.indices.is_empty() {
            let nearest = suggest::word(segment.name, known);
            let nearest = nearest.map(|name| format!("{}.{name}", self.written));
            return Err(Lost { nearest, allowed: None });
        }
        self.go(segment.name);
        Ok(Found {
            steps: self.steps.clone(),
            about: "a named number of the study",
            parameter: None,
            quantity: None,
            twin: false,
            is_number: true,
            replaces: Vec::new(),
        })
    }

    /// An entry of a matrix.
    fn matrix(
        &mut self,
        key: &SystemKey,
        twin: bool,
        node: Option<&'d Node>,
        segment: &Segment<'_>,
        rest: &[Segment<'_>],
    ) -> Result<Found, Lost> {
        let Some(Value::List(list)) = node.map(|node| &node.value) else {
            return Err(Lost::default());
        };
        let diagonal = !matches!(list.first().map(|node| &node.value), Some(Value::List(_)));
        let name = &self.written;
        let n = list.len();
        let indices = match (segment.indices.as_slice(), diagonal) {
            ([i], true) => vec![*i],
            ([i, j], true) if i == j => vec![*i],
            ([i, j], false) => vec![*i, *j],
            ([_, _], true) => {
                let allowed =
                    format!("{name} is a diagonal of {n} numbers: {name}[0] to {name}[{}]", n - 1);
                return Err(Lost::because(allowed));
            }
            _ => {
                let example = if diagonal { "[0]" } else { "[0][1]" };
                return Err(Lost::because(format!("set entry by entry, such as {name}{example}")));
            }
        };
        if !rest.is_empty() || indices.iter().any(|index| *index >= n) {
            return Err(Lost::because(format!("{name} has {n} rows; indices begin at 0")));
        }
        self.steps.extend(indices.into_iter().map(Step::Index));
        Ok(Found { is_number: true, replaces: Vec::new(), ..self.found(key, twin) })
    }

    /// An entry of a row, by name or index, in the form in which the row is written.
    fn row(
        &mut self,
        key: &SystemKey,
        twin: bool,
        which: SystemTable,
        node: Option<&'d Node>,
        segment: &Segment<'_>,
        rest: &[Segment<'_>],
    ) -> Result<Found, Lost> {
        let names = self.names(which, key.name);
        let listed = matches!(node.map(|node| &node.value), Some(Value::List(_)));
        let inner: Vec<&str> = rest.iter().map(|segment| segment.name).collect();
        let name = inner.join(".");
        let plain = rest.iter().all(|segment| segment.indices.is_empty());
        let last = match (segment.indices.as_slice(), rest.is_empty(), listed) {
            ([index], true, true) => Step::Index(*index),
            ([index], true, false) => {
                Step::Key(names.get(*index).cloned().ok_or_else(Lost::default)?)
            }
            ([], false, true) if plain => {
                let place = names.iter().position(|known| *known == name);
                Step::Index(place.ok_or_else(|| self.unknown_name(&name, &names))?)
            }
            ([], false, false) if plain => Step::Key(name),
            _ => {
                let allowed = format!("set entry by entry, such as {}.x", self.written);
                return Err(Lost::because(allowed));
            }
        };
        match last {
            // Names with a dot are nested tables where they were written without quotes.
            Step::Key(name) => {
                let table = node.and_then(Node::table);
                let whole = table.is_none_or(|table| table.has(&name)) || !name.contains('.');
                if whole {
                    self.steps.push(Step::Key(name));
                } else {
                    let parts = name.split('.').map(|part| Step::Key(part.to_owned()));
                    self.steps.extend(parts);
                }
            }
            index @ Step::Index(_) => self.steps.push(index),
        }
        Ok(Found { is_number: true, replaces: Vec::new(), ..self.found(key, twin) })
    }

    fn unknown_name(&self, name: &str, names: &[String]) -> Lost {
        let nearest = suggest::word(name, names.iter().map(String::as_str));
        let nearest = nearest.map(|name| format!("{}.{name}", self.written));
        Lost { nearest, allowed: None }
    }

    /// Names of the entries of a row that is written as an array.
    fn names(&self, which: SystemTable, key: &str) -> Vec<String> {
        let system = self.document.get("system").and_then(Node::table);
        let listed = ["coordinates", "states"].into_iter().find_map(|name| {
            match &system?.get(name)?.value {
                Value::List(list) => Some(list),
                _ => None,
            }
        });
        let text = |node: &Node| match &node.value {
            Value::Text(text) => text.clone(),
            _ => String::new(),
        };
        let names: Vec<String> = listed.into_iter().flatten().map(text).collect();
        let mechanical = system.is_some_and(|table| !table.has("states"));
        if which == SystemTable::Initial && key == "values" && mechanical {
            let velocities = names.iter().map(|name| format!("velocity.{name}"));
            return names.iter().cloned().chain(velocities).collect();
        }
        names
    }

    /// A name that a table does not have, with the nearest one.
    fn lost(&self, which: SystemTable, segment: &Segment<'_>, rest: &[Segment<'_>]) -> Lost {
        let here: Vec<String> = match which {
            SystemTable::Friction => {
                let keys = vocabulary::keys_of(Section::Friction);
                let plain = keys.filter(|key| !matches!(key.role, Role::FrictionForce(..)));
                plain.map(|key| key.name.to_owned()).collect()
            }
            _ => {
                let keys = system_keys(which).iter();
                keys.flat_map(|key| std::iter::once(key.name.to_owned()).chain(key.twins()))
                    .collect()
            }
        };
        let nearest = suggest::word(segment.name, here.iter().map(String::as_str));
        let nearest = nearest.map(|name| {
            let first =
                if self.written.is_empty() { name } else { format!("{}.{name}", self.written) };
            let same = Segment { name: "", indices: segment.indices.clone() };
            format!("{first}{}{}", after_indices(&same), after(rest))
        });
        let elsewhere = || {
            let alone = which == SystemTable::Root && rest.is_empty();
            let tables = [
                (SystemTable::Contact, "contact"),
                (SystemTable::Dither, "dither"),
                (SystemTable::System, "system"),
            ];
            let found = tables.into_iter().filter(|_| alone).find_map(|(table, name)| {
                let keys = system_keys(table).iter().map(|key| key.name);
                suggest::word(segment.name, keys).map(|key| format!("{name}.{key}"))
            });
            let named = self.document.get("parameters").and_then(Node::table);
            let has = alone && named.is_some_and(|table| table.has(segment.name));
            if has { Some(format!("parameters.{}", segment.name)) } else { found }
        };
        Lost { nearest: nearest.or_else(elsewhere), allowed: None }
    }
}

/// The rest of a path as it was written.
fn after(rest: &[Segment<'_>]) -> String {
    rest.iter().map(|segment| format!(".{}{}", segment.name, after_indices(segment))).collect()
}

fn after_indices(segment: &Segment<'_>) -> String {
    segment.indices.iter().map(|index| format!("[{index}]")).collect()
}
