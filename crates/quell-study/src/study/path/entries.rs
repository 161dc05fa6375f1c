//! The end of a path: an entry of a matrix or of a row.

use quell_input::document::{Node, Value};
use quell_input::nearest;

use super::found::{FoundPath, LostPath, PathStep};
use super::walk::{PathSegment, Walk};
use crate::study::vocabulary::{Key, Section};

impl<'d> Walk<'d> {
    /// An entry of a matrix.
    pub(super) fn matrix(
        &mut self,
        key: &'static Key,
        node: Option<&'d Node>,
        segment: &PathSegment<'_>,
        rest: &[PathSegment<'_>],
    ) -> Result<FoundPath, LostPath> {
        let list = match node.map(|node| &node.value) {
            Some(Value::List(list)) => list,
            Some(Value::Table(_)) => return self.matrix_file(key, segment, rest),
            _ => return Err(LostPath::default()),
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
                return Err(LostPath::because(allowed));
            }
            _ => {
                let example = if diagonal { "[0]" } else { "[0][1]" };
                return Err(LostPath::because(format!(
                    "set entry by entry, such as {name}{example}"
                )));
            }
        };
        if !rest.is_empty() || indices.iter().any(|index| *index >= n) {
            return Err(LostPath::because(format!("{name} has {n} rows; indices begin at 0")));
        }
        self.steps.extend(indices.into_iter().map(PathStep::Index));
        Ok(FoundPath { is_number: true, replaces: Vec::new(), ..self.found(key) })
    }

    /// The file of a matrix; its entries cannot be set.
    fn matrix_file(
        &mut self,
        key: &'static Key,
        segment: &PathSegment<'_>,
        rest: &[PathSegment<'_>],
    ) -> Result<FoundPath, LostPath> {
        match (segment.indices.as_slice(), rest) {
            ([], [PathSegment { name: "file", indices }]) if indices.is_empty() => {
                self.steps.push(PathStep::Key("file".to_owned()));
                Ok(FoundPath { replaces: Vec::new(), ..self.found(key) })
            }
            _ => {
                let name = &self.written;
                Err(LostPath::because(format!(
                    "{name} is in a file: its entries are changed there, and the file by {name}.file"
                )))
            }
        }
    }

    /// An entry of a row, by name or index, in the form in which the row is written.
    pub(super) fn row(
        &mut self,
        key: &'static Key,
        which: Section,
        node: Option<&'d Node>,
        segment: &PathSegment<'_>,
        rest: &[PathSegment<'_>],
    ) -> Result<FoundPath, LostPath> {
        let names = self.names(which, key.name);
        let listed = matches!(node.map(|node| &node.value), Some(Value::List(_)));
        let inner: Vec<&str> = rest.iter().map(|segment| segment.name).collect();
        let name = inner.join(".");
        let plain = rest.iter().all(|segment| segment.indices.is_empty());
        let last = match (segment.indices.as_slice(), rest.is_empty(), listed) {
            ([index], true, true) => PathStep::Index(*index),
            ([index], true, false) => {
                PathStep::Key(names.get(*index).cloned().ok_or_else(LostPath::default)?)
            }
            ([], false, true) if plain => {
                let place = names.iter().position(|known| *known == name);
                PathStep::Index(place.ok_or_else(|| self.unknown_name(&name, &names))?)
            }
            ([], false, false) if plain => PathStep::Key(name),
            _ => {
                let allowed = format!("set entry by entry, such as {}.x", self.written);
                return Err(LostPath::because(allowed));
            }
        };
        match last {
            // Names with a dot are nested tables where they were written without quotes.
            PathStep::Key(name) => {
                let table = node.and_then(Node::table);
                let whole = table.is_none_or(|table| table.has(&name)) || !name.contains('.');
                if whole {
                    self.steps.push(PathStep::Key(name));
                } else {
                    let parts = name.split('.').map(|part| PathStep::Key(part.to_owned()));
                    self.steps.extend(parts);
                }
            }
            PathStep::Index(index) => self.entry(node, index)?,
        }
        Ok(FoundPath { is_number: true, replaces: Vec::new(), ..self.found(key) })
    }

    fn unknown_name(&self, name: &str, names: &[String]) -> LostPath {
        let nearest = nearest::word(name, names.iter().map(String::as_str));
        let nearest = nearest.map(|name| format!("{}.{name}", self.written));
        LostPath::near(nearest)
    }

    /// Names of the entries of a row that is written as an array.
    fn names(&self, which: Section, key: &str) -> Vec<String> {
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
        if which == Section::SystemInitial && key == "values" && mechanical {
            let velocities = names.iter().map(|name| format!("velocity.{name}"));
            return names.iter().cloned().chain(velocities).collect();
        }
        names
    }
}
