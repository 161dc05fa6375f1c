//! Changes to a study from outside its file: `--set path=value`, `--tolerance`, points of a
//! sweep. They change the document, which is checked afterwards.

use std::fmt;

use quell_input::complaint::{Complaint, Origin};
use quell_input::document::{Node, Table, Value};

use super::path;

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
        path::set(root, &self.path, &self.node)
    }
}

impl fmt::Display for Change {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}={}", self.path, self.node.given())
    }
}
