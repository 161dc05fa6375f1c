//! Follows a path through the document of a study of a system.

use std::fmt::Write as _;

use quell_model::parameter::system::FRICTION_FACTOR;

use super::dither::is_factor;
use super::found::{FoundPath, LostPath, PathStep};
use super::keys::{SystemKey, SystemRole, SystemTable, system_keys};
use crate::study::document::{Node, Table, Value};
use crate::study::suggest;
use crate::study::vocabulary::{self, Role, Section};

/// A name of a path with the indices after it.
#[derive(Clone, Debug)]
pub(super) struct PathSegment<'p> {
    pub(super) name: &'p str,
    pub(super) indices: Vec<usize>,
}

fn segments(path: &str) -> Option<Vec<PathSegment<'_>>> {
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
            (rest.is_empty() && !name.is_empty()).then_some(PathSegment { name, indices })
        })
        .collect()
}

/// Follows a path through the document.
pub(super) fn follow(document: &Table, path: &str) -> Result<FoundPath, LostPath> {
    let Some(segments) = segments(path) else { return Err(LostPath::default()) };
    let mut walk = Walk { document, steps: Vec::new(), written: String::new() };
    walk.table(SystemTable::Root, Some(document), &segments)
}

pub(super) struct Walk<'d> {
    pub(super) document: &'d Table,
    pub(super) steps: Vec<PathStep>,
    /// The part of the path that was followed.
    pub(super) written: String,
}

impl<'d> Walk<'d> {
    fn go(&mut self, name: &str) {
        self.steps.push(PathStep::Key(name.to_owned()));
        if !self.written.is_empty() {
            self.written.push('.');
        }
        self.written.push_str(name);
    }

    pub(super) fn found(&self, key: &SystemKey, twin: bool) -> FoundPath {
        FoundPath {
            steps: self.steps.clone(),
            about: key.about,
            parameter: key.parameter(),
            quantity: key.quantity(),
            twin,
            is_number: matches!(key.role, SystemRole::Number(_) | SystemRole::Size(_)),
            replaces: key.alternatives(),
        }
    }

    /// Follows the rest of a path from a table.
    fn table(
        &mut self,
        which: SystemTable,
        table: Option<&'d Table>,
        path: &[PathSegment<'_>],
    ) -> Result<FoundPath, LostPath> {
        let Some((segment, rest)) = path.split_first() else {
            let allowed = format!("set key by key: {} is a table", self.written);
            return Err(LostPath::because(allowed));
        };
        match which {
            SystemTable::Named => return self.named(table, segment, rest),
            SystemTable::Friction => return self.friction(table, segment, rest),
            _ => {}
        }
        let keys = system_keys(which);
        let plain = keys.iter().find(|key| key.name == segment.name).map(|key| (key, false));
        let (key, twin) = plain
            .or_else(|| keys.iter().find(|key| key.has_twin(segment.name)).map(|key| (key, true)))
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
                let is_amplitude =
                    key.parameter().is_some_and(|known| known.path == FRICTION_FACTOR.path);
                if which == SystemTable::Dither && is_amplitude && table.is_some_and(is_factor) {
                    found.parameter = Some(FRICTION_FACTOR);
                    found.quantity = Some(FRICTION_FACTOR.quantity);
                    found.about = FRICTION_FACTOR.about;
                }
                if which == SystemTable::Initial {
                    let others = system_keys(which).iter().map(|key| key.name.to_owned());
                    found.replaces.extend(others);
                }
                Ok(found)
            }
            _ => Err(LostPath::default()),
        }
    }

    /// An entry of a list of tables.
    fn tables(
        &mut self,
        which: SystemTable,
        node: Option<&'d Node>,
        segment: &PathSegment<'_>,
        rest: &[PathSegment<'_>],
    ) -> Result<FoundPath, LostPath> {
        let (entries, listed): (&[Node], bool) = match node {
            None => (&[], false),
            Some(Node { value: Value::List(list), .. }) => (list, true),
            Some(node) => (std::slice::from_ref(node), false),
        };
        let named = rest.first().and_then(|first| {
            let is = |(index, node): (usize, &Node)| match name_of(node) {
                Some(name) => name == first.name,
                None => {
                    which == SystemTable::Contact && format!("contact {}", index + 1) == first.name
                }
            };
            let by_name = matches!(which, SystemTable::Contact | SystemTable::Component);
            entries.iter().enumerate().position(is).filter(|_| by_name && first.indices.is_empty())
        });
        let (index, rest) = match (segment.indices.as_slice(), named) {
            ([index], _) => (*index, rest),
            ([], Some(index)) => (index, &rest[1..]),
            ([], None) if entries.len() == 1 => (0, rest),
            ([], None) => return Err(unspecified(segment.name, entries, rest)),
            _ => return Err(LostPath::default()),
        };
        let Some(entry) = entries.get(index) else {
            return Err(LostPath::because(counted(segment.name, entries.len())));
        };
        if listed {
            self.steps.push(PathStep::Index(index));
        }
        if entries.len() > 1 {
            let _ = match name_of(entry) {
                Some(own) if which == SystemTable::Contact => write!(self.written, ".{own}"),
                _ => write!(self.written, "[{index}]"),
            };
        }
        let table = entry.table();
        if which == SystemTable::Contact
            && rest.first().is_some_and(|first| first.name == "friction")
            && table.is_some_and(|table| !table.has("friction"))
            && let Some(shared) = self.document.get("friction")
        {
            if entries.len() > 1 {
                let allowed = "the law of this contact is that of all contacts: use friction.…";
                return Err(LostPath::because(allowed));
            }
            self.steps = vec![PathStep::Key("friction".to_owned())];
            return self.friction_of(shared.table(), &rest[1..]);
        }
        self.table(which, table, rest)
    }

    fn friction_of(
        &mut self,
        table: Option<&'d Table>,
        rest: &[PathSegment<'_>],
    ) -> Result<FoundPath, LostPath> {
        let (segment, rest) = rest.split_first().ok_or_else(LostPath::default)?;
        self.friction(table, segment, rest)
    }

    /// A number of a friction law.
    fn friction(
        &mut self,
        table: Option<&'d Table>,
        segment: &PathSegment<'_>,
        rest: &[PathSegment<'_>],
    ) -> Result<FoundPath, LostPath> {
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
        let mut found = FoundPath {
            steps: self.steps.clone(),
            about: key.about,
            parameter,
            quantity: parameter.map(|parameter| parameter.quantity),
            twin: matches!(key.role, Role::Twin(..)),
            is_number: parameter.is_some(),
            replaces: siblings.unwrap_or_default(),
        };
        if let [index] = segment.indices.as_slice() {
            found.steps.push(PathStep::Index(*index));
        }
        Ok(found)
    }

    /// A number whose name the study chooses.
    fn named(
        &mut self,
        table: Option<&'d Table>,
        segment: &PathSegment<'_>,
        rest: &[PathSegment<'_>],
    ) -> Result<FoundPath, LostPath> {
        let known: Vec<&str> =
            table.into_iter().flat_map(Table::iter).map(|(name, _)| name).collect();
        if !known.contains(&segment.name) || !rest.is_empty() || !segment.indices.is_empty() {
            let nearest = suggest::word(segment.name, known);
            let nearest = nearest.map(|name| format!("{}.{name}", self.written));
            return Err(LostPath { nearest, allowed: None });
        }
        self.go(segment.name);
        Ok(FoundPath {
            steps: self.steps.clone(),
            about: "a named number of the study",
            parameter: None,
            quantity: None,
            twin: false,
            is_number: true,
            replaces: Vec::new(),
        })
    }

    /// A name that a table does not have, with the nearest one.
    fn lost(
        &self,
        which: SystemTable,
        segment: &PathSegment<'_>,
        rest: &[PathSegment<'_>],
    ) -> LostPath {
        let here: Vec<String> = if which == SystemTable::Friction {
            let keys = vocabulary::keys_of(Section::Friction);
            let plain = keys.filter(|key| !matches!(key.role, Role::FrictionForce(..)));
            plain.map(|key| key.name.to_owned()).collect()
        } else {
            let keys = system_keys(which).iter();
            keys.flat_map(|key| [key.name.to_owned()].into_iter().chain(key.twins())).collect()
        };
        let nearest = suggest::word(segment.name, here.iter().map(String::as_str));
        let nearest = nearest.map(|name| {
            let first =
                if self.written.is_empty() { name } else { format!("{}.{name}", self.written) };
            let same = PathSegment { name: "", indices: segment.indices.clone() };
            format!("{first}{}{}", after_indices(&same), after(rest))
        });
        // The only contact may be named, and its name mistyped.
        let contact = || {
            let named = which == SystemTable::Contact && !rest.is_empty();
            let node = self.document.get("contact").filter(|_| named)?;
            let entries = match &node.value {
                Value::List(list) => list.as_slice(),
                _ => std::slice::from_ref(node),
            };
            let name = suggest::word(segment.name, entries.iter().filter_map(name_of))?;
            Some(format!("contact.{name}{}", after(rest)))
        };
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
        LostPath { nearest: contact().or(nearest).or_else(elsewhere), allowed: None }
    }
}

/// The name that an entry of a list gives itself.
fn name_of(node: &Node) -> Option<&str> {
    match node.table()?.get("name").map(|node| &node.value) {
        Some(Value::Text(text)) => Some(text),
        _ => None,
    }
}

/// A path that names no entry of a list of several.
fn unspecified(name: &str, entries: &[Node], rest: &[PathSegment<'_>]) -> LostPath {
    let first = rest.first().map(|first| first.name).unwrap_or_default();
    let names: Vec<&str> = entries.iter().filter_map(name_of).collect();
    let nearest = suggest::word(first, names.iter().copied()).filter(|_| rest.len() > 1);
    let nearest = nearest.map(|found| format!("{name}.{found}{}", after(&rest[1..])));
    let allowed = match entries.len() {
        0 => counted(name, 0),
        count if names.is_empty() => {
            format!("specify which one: {name}[0] to {name}[{}]", count - 1)
        }
        _ => format!("specify which one: {name}.NAME, NAME one of {}", names.join(", ")),
    };
    LostPath { nearest, allowed: Some(allowed) }
}

/// How many entries a list has.
fn counted(name: &str, count: usize) -> String {
    match count {
        0 => format!("the study has no [[{name}]]"),
        1 => format!("the study has one: {name}[0]"),
        _ => format!("the study has {count} of them: {name}[0] to {name}[{}]", count - 1),
    }
}

/// The rest of a path as it was written.
fn after(rest: &[PathSegment<'_>]) -> String {
    let mut text = String::new();
    for segment in rest {
        let _ = write!(text, ".{}{}", segment.name, after_indices(segment));
    }
    text
}

fn after_indices(segment: &PathSegment<'_>) -> String {
    let mut text = String::new();
    for index in &segment.indices {
        let _ = write!(text, "[{index}]");
    }
    text
}
