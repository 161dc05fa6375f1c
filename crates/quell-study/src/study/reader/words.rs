//! Reads words, text and tables.

use std::fmt::Display;

use quell_input::complaint::{Complaint, Fault, Origin};
use quell_input::document::{Node, Table, Value};
use quell_input::nearest;
use quell_input::said::Said;
use serde_json::Value as Json;

use super::Reader;
use crate::study::vocabulary::{Choice, join};

impl Reader {
    /// A word from a list.
    pub(in crate::study) fn choice(
        &mut self,
        key: &str,
        node: &Node,
        choice: Choice,
    ) -> Option<&'static str> {
        let names = choice.names();
        let Value::Text(text) = &node.value else {
            self.wrong(key, node, format!("{}; got {}", one_of(choice), node.kind()));
            return None;
        };
        let found = names.iter().copied().find(|name| name == text);
        if found.is_none() {
            let nearest = nearest::word(text, names).map(|name| format!("\"{name}\""));
            let (given, allowed) = (node.given(), one_of(choice));
            let complaint = Complaint::new(Fault::Value, key, node.origin, given, allowed);
            self.complain(complaint.suggesting(nearest));
        }
        found
    }

    /// A required word from a list.
    pub(in crate::study) fn needed_choice(
        &mut self,
        table: &Table,
        prefix: &str,
        header: Origin,
        name: &str,
        choice: Choice,
    ) -> Option<&'static str> {
        let key = join(prefix, name);
        let Some(node) = table.get(name) else {
            let allowed = one_of(choice);
            self.complain(Complaint::new(Fault::Missing, key, header, Json::Null, allowed));
            return None;
        };
        self.choice(&key, node, choice)
    }

    /// Free text.
    pub(in crate::study) fn text(&mut self, key: &str, node: &Node) -> Option<String> {
        let Value::Text(text) = &node.value else {
            self.wrong(key, node, format!("a string in quotes; got {}", node.kind()));
            return None;
        };
        Some(text.clone())
    }

    /// Reports an invalid value.
    pub(in crate::study) fn wrong(&mut self, key: &str, node: &Node, allowed: impl Into<Said>) {
        self.complain(Complaint::new(Fault::Value, key, node.origin, node.given(), allowed));
    }

    /// What is in the file that a key names; what is wrong with it is reported.
    pub(in crate::study) fn in_file<T>(
        &mut self,
        (key, node): (&str, &Node),
        name: &str,
        found: Result<T, impl Display>,
    ) -> Option<T> {
        let complaint = |why: &dyn Display| {
            Complaint::new(Fault::Path, key, node.origin, name, why.to_string())
        };
        found.map_err(|why| self.complain(complaint(&why))).ok()
    }

    /// Reports an invalid value under a key that has not been reported.
    pub(in crate::study) fn wrong_once(
        &mut self,
        key: &str,
        node: &Node,
        allowed: impl Into<Said>,
    ) {
        if self.complaints.iter().all(|known| known.key != key) {
            self.wrong(key, node, allowed);
        }
    }

    /// A table of the root or of `[belt]`; an error if it is something else.
    pub(in crate::study) fn table<'a>(&mut self, key: &str, node: &'a Node) -> Option<&'a Table> {
        let table = node.table();
        if table.is_none() {
            self.wrong(key, node, format!("a table [{key}]; got {}", node.kind()));
        }
        table
    }
}

/// The words of a list, in words.
fn one_of(choice: Choice) -> String {
    let names = choice.names();
    let quoted: Vec<String> = names.iter().map(|name| format!("\"{name}\"")).collect();
    format!("one of {}", quoted.join(", "))
}
