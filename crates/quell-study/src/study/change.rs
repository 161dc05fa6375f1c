//! Changes to a study from outside its file: `--set path=value`, `--tolerance`, points of a
//! sweep. They change the document, which is checked afterwards.

use std::fmt;

use quell_model::parameter::{NATURAL_FREQUENCY, SCALES, STIFFNESS};

use super::document::{Node, Table, Value};
use super::system::{keys, path};
use super::vocabulary::{self, Choice, Key, NOT_BUILT, Role, Section};
use crate::complaint::{Complaint, Fault, Origin};

/// One change.
#[derive(Clone, Debug, PartialEq)]
pub struct Change {
    /// Path of the key, such as `dither[1].amplitude`.
    pub path: String,
    /// Its new value.
    pub node: Node,
}

impl Change {
    /// From `path=value`.
    ///
    /// # Errors
    /// An error if the text has no `=`.
    pub fn parse(text: &str, option: &'static str) -> Result<Self, Box<Complaint>> {
        match text.split_once('=') {
            Some((path, value)) if !path.trim().is_empty() => {
                Ok(Self { path: path.trim().to_owned(), node: Node::from_argument(value, option) })
            }
            _ => {
                let allowed = "path=value, such as belt.belt_velocity=0.1";
                Err(Box::new(Complaint::option(option, text, allowed)))
            }
        }
    }

    /// A number for a path.
    pub fn number(path: &str, value: f64, origin: Origin) -> Self {
        Self { path: path.to_owned(), node: Node { value: Value::Number(value), origin } }
    }

    /// Makes the change.
    pub(super) fn apply(&self, root: &mut Table) -> Result<(), Box<Complaint>> {
        if keys::is_described(root) && !self.is_common() {
            return path::set(root, &self.path, &self.node);
        }
        let address = vocabulary::resolve(&self.path).map_err(|nearest| self.unknown(nearest))?;
        let key = address.key;
        let Some(table) = self.section(root, key.section, address.index)? else {
            return Ok(());
        };
        for sibling in vocabulary::keys_of(key.section) {
            if replaces(key, sibling) {
                table.remove(sibling.name);
            }
        }
        // Constants have names chosen in the study.
        let name = match key.role {
            Role::Constant => self.path.trim().rsplit('.').next().unwrap_or_default(),
            _ => key.name,
        };
        table.set(name, self.node.clone());
        Ok(())
    }

    /// Whether the path names a key that studies of all kinds share.
    fn is_common(&self) -> bool {
        let first = self.path.trim().split(['.', '[']).next().unwrap_or_default();
        ["schema", "title", "sweep"].contains(&first)
    }

    /// An error with the nearest key.
    fn unknown(&self, nearest: Option<String>) -> Box<Complaint> {
        let first = self.path.split(['.', '[']).next().unwrap_or_default();
        if NOT_BUILT.contains(&first) {
            let allowed = format!("[{first}] is not implemented yet");
            return Box::new(self.complaint(Fault::NotBuilt, allowed));
        }
        if let Some(section) = self.table_itself() {
            let example = vocabulary::keys_of(section)
                .find(|key| {
                    let scale = key.parameter().is_some_and(|known| SCALES.contains(&known));
                    !scale && key.role != Role::Choice(Choice::Units)
                })
                .map_or_else(|| vocabulary::join(section.path(), "a"), Key::path);
            let allowed = format!("set key by key, such as {example}, because it is a table");
            return Box::new(self.complaint(Fault::Value, allowed));
        }
        let complaint = self.complaint(Fault::Unknown, "the keys listed by `quell schema`");
        Box::new(complaint.suggesting(nearest))
    }

    /// The table that the path names, if it names a whole table.
    fn table_itself(&self) -> Option<Section> {
        let path = self.path.trim();
        let name = path.strip_suffix(']').and_then(|path| path.split_once('['));
        let name = name.map_or(path, |(name, _)| name);
        Section::ALL.iter().copied().find(|section| section.path() == name && !name.is_empty())
    }

    fn complaint(&self, fault: Fault, allowed: impl Into<String>) -> Complaint {
        Complaint::new(fault, &self.path, self.node.origin, self.node.given(), allowed)
    }

    /// The table of a section, created if it is missing. `None` if something else has
    /// its name, which the check reports.
    fn section<'a>(
        &self,
        root: &'a mut Table,
        section: Section,
        index: Option<usize>,
    ) -> Result<Option<&'a mut Table>, Box<Complaint>> {
        match section {
            Section::Root => Ok(Some(root)),
            Section::Initial | Section::Drive | Section::Load => {
                let Some(belt) = self.table(root, "belt") else {
                    return Ok(None);
                };
                Ok(self.table(belt, section.path().trim_start_matches("belt.")))
            }
            Section::DesignLimits => {
                let Some(design) = self.table(root, "design") else {
                    return Ok(None);
                };
                Ok(self.table(design, "limits"))
            }
            Section::Envelope => {
                let Some(dither) = self.entry(root, "dither", index)? else {
                    return Ok(None);
                };
                Ok(self.table(dither, "envelope"))
            }
            Section::DiscDrive => {
                let Some(disc) = self.table(root, "disc") else {
                    return Ok(None);
                };
                Ok(self.table(disc, "drive"))
            }
            Section::LoadEnvelope => {
                let Some(disc) = self.table(root, "disc") else {
                    return Ok(None);
                };
                let Some(load) = self.entry(disc, "load", index)? else {
                    return Ok(None);
                };
                Ok(self.table(load, "envelope"))
            }
            Section::Constants => {
                let Some(friction) = self.table(root, "friction") else {
                    return Ok(None);
                };
                Ok(self.table(friction, "constants"))
            }
            Section::Dither | Section::Sweep => self.entry(root, section.path(), index),
            Section::DiscMode | Section::DiscLoad => {
                let Some(disc) = self.table(root, "disc") else {
                    return Ok(None);
                };
                let name = section.path().trim_start_matches("disc.");
                self.entry(disc, name, index)
            }
            _ => Ok(self.table(root, section.path())),
        }
    }

    fn table<'a>(&self, parent: &'a mut Table, name: &str) -> Option<&'a mut Table> {
        if !parent.has(name) {
            let value = Value::Table(Table::default());
            parent.set(name, Node { value, origin: self.node.origin });
        }
        match parent.get_mut(name).map(|node| &mut node.value) {
            Some(Value::Table(table)) => Some(table),
            _ => None,
        }
    }

    /// An entry of `[[dither]]` or `[[sweep]]`.
    fn entry<'a>(
        &self,
        root: &'a mut Table,
        name: &str,
        index: Option<usize>,
    ) -> Result<Option<&'a mut Table>, Box<Complaint>> {
        let count = match root.get(name).map(|node| &node.value) {
            Some(Value::List(list)) => list.len(),
            Some(_) => 1,
            None => 0,
        };
        let chosen = match (index, count) {
            (None | Some(0), 0 | 1) => 0,
            (Some(index), count) if index < count => index,
            // The next axis; entries of other lists cannot be created one key at a time.
            (Some(index), count) if index == count && name == "sweep" => index,
            (_, count) => {
                let allowed = match count {
                    0 => format!("the study has no [{name}]"),
                    1 => format!("the study has one [{name}]: {name}[0]"),
                    _ if index.is_some() => {
                        format!("the study has {count} of them: {name}[0] to {name}[{}]", count - 1)
                    }
                    _ => format!("specify which one: {name}[0] to {name}[{}]", count - 1),
                };
                return Err(Box::new(self.complaint(Fault::Conflict, allowed)));
            }
        };
        let origin = self.node.origin;
        let fresh = || Node { value: Value::Table(Table::default()), origin };
        if count == 0 {
            // An axis is always in a list; a single dither is a plain table.
            let node = match name {
                "sweep" => Node { value: Value::List(vec![fresh()]), origin },
                _ => fresh(),
            };
            root.set(name, node);
        }
        Ok(match root.get_mut(name).map(|node| &mut node.value) {
            Some(Value::Table(table)) => Some(table),
            Some(Value::List(list)) => {
                if chosen == list.len() {
                    list.push(fresh());
                }
                match list.get_mut(chosen).map(|node| &mut node.value) {
                    Some(Value::Table(table)) => Some(table),
                    _ => None,
                }
            }
            _ => None,
        })
    }
}

impl fmt::Display for Change {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}={}", self.path, self.node.given())
    }
}

/// Whether setting `key` replaces `sibling`: another key of the same parameter, a named state for numbers, the values of an axis for its
/// ends, and vice versa.
fn replaces(key: &Key, sibling: &Key) -> bool {
    if key.name == sibling.name {
        return false;
    }
    if let (Some(one), Some(other)) = (key.parameter(), sibling.parameter()) {
        // Stiffness and natural frequency are alternatives to each other.
        let alternatives = [STIFFNESS.path, NATURAL_FREQUENCY.path];
        return one.path == other.path
            || [one, other].iter().all(|number| alternatives.contains(&number.path));
    }
    match (key.section, key.role, sibling.role) {
        (Section::Initial, role, other) => is_word(role) || is_word(other),
        (Section::Friction, Role::Speeds { .. }, Role::Speeds { .. })
        | (_, Role::Band { .. }, Role::Band { .. }) => true,
        (Section::Friction, Role::FrictionForce(one, _), Role::FrictionForce(other, _)) => {
            one.path == other.path
        }
        (Section::Sweep, role, other) => {
            (role == Role::AxisValues) != (other == Role::AxisValues)
                && key.name != "parameter"
                && sibling.name != "parameter"
        }
        _ => false,
    }
}

fn is_word(role: Role) -> bool {
    matches!(role, Role::Choice(_))
}
