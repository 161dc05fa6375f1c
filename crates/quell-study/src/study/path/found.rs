//! What a path of a study leads to.

use quell_input::complaint::{Complaint, Fault, Origin};
use quell_input::document::{Node, Table, Value};
use quell_input::said::Said;
use serde_json::Value as Json;

use crate::study::vocabulary::Key;

/// A step from a value of the document to one inside it.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::study) enum PathStep {
    Key(String),
    Index(usize),
}

/// A path that was followed to its end.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::study) struct FoundPath {
    pub(in crate::study) steps: Vec<PathStep>,
    /// The key whose value it is, or whose value it is an entry of.
    pub(in crate::study) key: &'static Key,
    pub(in crate::study) is_number: bool,
    /// Keys of the same table that the value replaces.
    pub(super) replaces: Vec<&'static Key>,
}

impl FoundPath {
    /// The value at its end.
    pub(super) fn node<'d>(&self, document: &'d Table) -> Option<&'d Node> {
        node_at(document, &self.steps)
    }
}

/// The value at the end of these steps.
pub(super) fn node_at<'d>(document: &'d Table, steps: &[PathStep]) -> Option<&'d Node> {
    let (PathStep::Key(first), rest) = steps.split_first()? else { return None };
    let mut node = document.get(first)?;
    for step in rest {
        node = match (&node.value, step) {
            (Value::Table(table), PathStep::Key(name)) => table.get(name)?,
            (Value::List(list), PathStep::Index(index)) => list.get(*index)?,
            _ => return None,
        };
    }
    Some(node)
}

/// A path that leads nowhere.
#[derive(Debug)]
pub(in crate::study) struct LostPath {
    pub(super) fault: Fault,
    /// The nearest path.
    pub(in crate::study) nearest: Option<String>,
    /// What is wrong, if more is known than that the path does not exist.
    pub(super) allowed: Option<String>,
}

impl Default for LostPath {
    fn default() -> Self {
        Self::near(None)
    }
}

impl LostPath {
    /// A path that does not exist.
    pub(super) fn near(nearest: Option<String>) -> Self {
        Self { fault: Fault::Unknown, nearest, allowed: None }
    }

    /// A path that this study does not have, and why.
    pub(super) fn because(allowed: impl Into<String>) -> Self {
        Self::faulty(Fault::Conflict, allowed)
    }

    /// A path that is wrong in another way.
    pub(super) fn faulty(fault: Fault, allowed: impl Into<String>) -> Self {
        Self { fault, nearest: None, allowed: Some(allowed.into()) }
    }

    /// The complaint about a value that is this path; `otherwise` says what it must be where no more is known, and with which fault.
    pub(in crate::study) fn complaint(
        self,
        key: impl Into<String>,
        (origin, given): (Origin, Json),
        (fault, otherwise): (Fault, impl Into<Said>),
    ) -> Complaint {
        let fault = if self.allowed.is_some() { self.fault } else { fault };
        let allowed = self.allowed.map_or_else(|| otherwise.into(), Said::from);
        Complaint::new(fault, key, origin, given, allowed).suggesting(self.nearest)
    }
}
