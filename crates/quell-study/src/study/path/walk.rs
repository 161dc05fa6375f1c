//! Follows a path through the document of a study.

use std::fmt::Write as _;
use std::sync::LazyLock;

use quell_input::complaint::Fault;
use quell_input::document::{Node, Table, Value};
use quell_input::nearest;
use quell_model::friction::expression;
use quell_model::parameter::SCALES;
use quell_model::parameter::system::FRICTION_FACTOR;

use super::found::{FoundPath, LostPath, PathStep};
use crate::study::root;
use crate::study::suggest;
use crate::study::vocabulary::{
    self, Choice, DocumentKind, FRICTION, Key, KeyScope, Role, Section, join,
};

/// The key of a named number, which the study chooses.
static NAMED: Key = Key {
    section: Section::Parameters,
    name: "NAME",
    role: Role::Constant,
    about: "a named number of the study",
    scope: KeyScope::EVERY,
};

/// The amplitude of a dither that is a factor on friction.
static FACTOR: LazyLock<Key> = LazyLock::new(|| Key {
    section: Section::Dither,
    name: FRICTION_FACTOR.key(),
    role: Role::Number(FRICTION_FACTOR),
    about: FRICTION_FACTOR.about,
    scope: KeyScope::SYSTEM,
});

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
pub(in crate::study) fn follow(document: &Table, path: &str) -> Result<FoundPath, LostPath> {
    let Some(segments) = segments(path) else { return Err(LostPath::default()) };
    let kind = DocumentKind::of(document);
    let mut walk =
        Walk { document, kind, any_entry: false, steps: Vec::new(), written: String::new() };
    walk.table(Section::Root, Some(document), &segments)
}

/// Follows a path through the keys of studies of a kind, whose lists may have any number of entries.
pub(super) fn follow_keys(path: &str, kind: DocumentKind) -> Result<FoundPath, LostPath> {
    let Some(segments) = segments(path) else { return Err(LostPath::default()) };
    let document = &Table::default();
    let mut walk =
        Walk { document, kind, any_entry: true, steps: Vec::new(), written: String::new() };
    walk.table(Section::Root, None, &segments)
}

pub(super) struct Walk<'d> {
    pub(super) document: &'d Table,
    kind: DocumentKind,
    /// Whether lists may have any number of entries.
    any_entry: bool,
    pub(super) steps: Vec<PathStep>,
    /// The part of the path that was followed.
    pub(super) written: String,
}

impl<'d> Walk<'d> {
    fn go(&mut self, name: &str) {
        self.steps.push(PathStep::Key(name.to_owned()));
        self.written = join(&self.written, name);
    }

    pub(super) fn found(&self, key: &'static Key) -> FoundPath {
        let siblings = vocabulary::keys_of(key.section, self.kind);
        FoundPath {
            steps: self.steps.clone(),
            key,
            is_number: key.takes_number(),
            replaces: siblings.filter(|sibling| key.replaces(sibling)).collect(),
        }
    }

    /// Follows the rest of a path from a table.
    fn table(
        &mut self,
        which: Section,
        table: Option<&'d Table>,
        path: &[PathSegment<'_>],
    ) -> Result<FoundPath, LostPath> {
        let Some((segment, rest)) = path.split_first() else { return Err(self.whole(which)) };
        if which.has_own_names() {
            return self.named(which, table, segment, rest);
        }
        let misplaced = || {
            let wrong = (which == Section::Root).then(|| root::misplaced(segment.name, self.kind));
            wrong.flatten().map(|(fault, allowed)| LostPath::faulty(fault, allowed))
        };
        let key = vocabulary::key(which, segment.name, self.kind)
            .ok_or_else(|| misplaced().unwrap_or_else(|| self.lost(which, segment, rest)))?;
        let node = table.and_then(|table| table.get(segment.name));
        self.go(segment.name);
        match (key.role, segment.indices.as_slice()) {
            (Role::Tables(inner), _) => self.tables(inner, node, segment, rest),
            (Role::Table(inner), []) => self.table(inner, node.and_then(Node::table), rest),
            (Role::Matrix(_), _) => self.matrix(key, node, segment, rest),
            (Role::Row(_), _) => self.row(key, which, node, segment, rest),
            (_, []) if rest.is_empty() => {
                let of_amplitude =
                    key.parameter().is_some_and(|known| known.path == FRICTION_FACTOR.path);
                let factor = of_amplitude && table.is_some_and(is_factor);
                let found = self.found(key);
                Ok(if factor { FoundPath { key: &FACTOR, ..found } } else { found })
            }
            // An entry of a list of samples.
            (Role::Coefficient | Role::Speeds { .. } | Role::Band { .. }, [index])
                if rest.is_empty() =>
            {
                self.entry(node, *index)?;
                Ok(self.found(key))
            }
            _ => Err(LostPath::default()),
        }
    }

    /// An entry of a list of numbers.
    pub(super) fn entry(&mut self, node: Option<&Node>, index: usize) -> Result<(), LostPath> {
        let count = match node.map(|node| &node.value) {
            Some(Value::List(list)) => list.len(),
            _ if self.any_entry => usize::MAX,
            _ => 0,
        };
        if index >= count {
            let name = &self.written;
            return Err(LostPath::because(match count {
                0 => format!("{name} is no list"),
                _ => format!("{name} has {count} entries; indices begin at 0"),
            }));
        }
        self.steps.push(PathStep::Index(index));
        Ok(())
    }

    /// A path that names a whole table.
    fn whole(&self, which: Section) -> LostPath {
        let mut keys = vocabulary::keys_of(which, self.kind);
        let example = keys.find(|key| {
            let scale = key.parameter().is_some_and(|known| SCALES.contains(&known));
            !scale && key.role != Role::Choice(Choice::Units)
        });
        let example = join(&self.written, example.map_or("a", |key| key.name));
        let allowed = format!("set key by key, such as {example}, because it is a table");
        LostPath::faulty(Fault::Value, allowed)
    }

    /// An entry of a list of tables.
    fn tables(
        &mut self,
        which: Section,
        node: Option<&'d Node>,
        segment: &PathSegment<'_>,
        rest: &[PathSegment<'_>],
    ) -> Result<FoundPath, LostPath> {
        let entries = node.map_or(&[][..], Node::entries);
        let listed = matches!(node, Some(Node { value: Value::List(_), .. }));
        let named = rest.first().and_then(|first| {
            let is = |(index, node): (usize, &Node)| match name_of(node) {
                Some(name) => name == first.name,
                None => which == Section::Contact && format!("contact {}", index + 1) == first.name,
            };
            let by_name = which.has_named_entries() && first.indices.is_empty();
            entries.iter().enumerate().position(is).filter(|_| by_name)
        });
        let count = entries.len();
        let (index, rest) = match (segment.indices.as_slice(), named) {
            ([index], _) => (*index, rest),
            ([], Some(index)) => (index, &rest[1..]),
            ([], None) if count == 1 || (count == 0 && self.may_begin(which)) => (0, rest),
            ([], None) => return Err(unspecified(&self.written, entries, rest)),
            _ => return Err(LostPath::default()),
        };
        let Some(entry) = entries.get(index) else {
            if self.any_entry {
                self.steps.extend(segment.indices.iter().copied().map(PathStep::Index));
                self.written.push_str(&after_indices(segment));
                return self.table(which, None, rest);
            }
            if index > count || !self.may_begin(which) || (which != Section::Sweep && count > 0) {
                return Err(LostPath::because(counted(&self.written, count)));
            }
            // An axis is always in a list; a single entry of another list is a plain table.
            if which == Section::Sweep {
                self.steps.push(PathStep::Index(index));
            }
            return self.table(which, None, rest);
        };
        if listed {
            self.steps.push(PathStep::Index(index));
        }
        if count > 1 || !segment.indices.is_empty() {
            let _ = match name_of(entry) {
                Some(own) if which == Section::Contact => write!(self.written, ".{own}"),
                _ => write!(self.written, "[{index}]"),
            };
        }
        let table = entry.table();
        if which == Section::Contact
            && rest.first().is_some_and(|first| first.name == "friction")
            && table.is_some_and(|table| !table.has("friction"))
            && let Some(shared) = self.document.get("friction")
        {
            if count > 1 {
                let allowed = "the law of this contact is that of all contacts: use friction.…";
                return Err(LostPath::because(allowed));
            }
            self.steps = vec![PathStep::Key("friction".to_owned())];
            "friction".clone_into(&mut self.written);
            return self.table(Section::Friction, shared.table(), &rest[1..]);
        }
        self.table(which, table, rest)
    }

    /// Whether a key can be set in an entry that is not there yet.
    fn may_begin(&self, which: Section) -> bool {
        which == Section::Sweep || self.any_entry || self.kind != DocumentKind::System
    }

    /// A number whose name the study chooses.
    fn named(
        &mut self,
        which: Section,
        table: Option<&'d Table>,
        segment: &PathSegment<'_>,
        rest: &[PathSegment<'_>],
    ) -> Result<FoundPath, LostPath> {
        let may_be_new = which == Section::Constants
            && self.kind != DocumentKind::System
            && expression::is_name(segment.name);
        let known: Vec<&str> =
            table.into_iter().flat_map(Table::iter).map(|(name, _)| name).collect();
        let there = may_be_new || known.contains(&segment.name);
        if !there || !rest.is_empty() || !segment.indices.is_empty() {
            let nearest = nearest::word(segment.name, known);
            let nearest = nearest.map(|name| format!("{}.{name}", self.written));
            return Err(LostPath::near(nearest));
        }
        self.go(segment.name);
        Ok(self.found(&NAMED))
    }

    /// A name that a table does not have, with the nearest one.
    fn lost(
        &self,
        which: Section,
        segment: &PathSegment<'_>,
        rest: &[PathSegment<'_>],
    ) -> LostPath {
        let nearest = suggest::key(self.kind, which, segment.name).map(|key| {
            let table =
                if key.section == which { self.written.as_str() } else { key.section.path() };
            format!("{}{}{}", join(table, key.name), after_indices(segment), after(rest))
        });
        // The only contact may be named, and its name mistyped.
        let contact = || {
            let named = which == Section::Contact && !rest.is_empty();
            let node = self.document.get("contact").filter(|_| named)?;
            let name = nearest::word(segment.name, node.entries().iter().filter_map(name_of))?;
            Some(format!("contact.{name}{}", after(rest)))
        };
        let named = || {
            let table = self.document.get("parameters").and_then(Node::table);
            let alone = which == Section::Root && rest.is_empty();
            let has = alone && table.is_some_and(|table| table.has(segment.name));
            has.then(|| format!("parameters.{}", segment.name))
        };
        LostPath::near(contact().or_else(named).or(nearest))
    }
}

/// Whether a dither is a factor on the friction of its contact, so that its amplitude is no force.
pub(in crate::study) fn is_factor(table: &Table) -> bool {
    !table.has("at")
        && matches!(table.get("direction").map(|node| &node.value), Some(Value::Text(word)) if word == FRICTION)
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
    let nearest = nearest::word(first, names.iter().copied()).filter(|_| rest.len() > 1);
    let nearest = nearest.map(|found| format!("{name}.{found}{}", after(&rest[1..])));
    let allowed = match entries.len() {
        0 => counted(name, 0),
        count if names.is_empty() => {
            format!("specify which one: {name}[0] to {name}[{}]", count - 1)
        }
        _ => format!("specify which one: {name}.NAME, NAME one of {}", names.join(", ")),
    };
    LostPath { nearest, ..LostPath::because(allowed) }
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
