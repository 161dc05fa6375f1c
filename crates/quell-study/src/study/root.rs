//! The keys outside any table (version and title), and unknown tables.

use quell_input::complaint::{Complaint, Fault};
use quell_input::document::{Table, Value};
use serde_json::Value as Json;

use super::reader::Reader;
use super::vocabulary::{self, DocumentKind, NOT_BUILT, Role, SCHEMA_VERSION, Section};

/// Reports unknown tables and keys, and those of other kinds of study. Returns the title.
pub(super) fn read(reader: &mut Reader, document: &Table) -> Option<String> {
    let kind = DocumentKind::of(document);
    for (name, node) in document.iter() {
        if vocabulary::key(Section::Root, name, kind).is_none() {
            match misplaced(name, kind) {
                Some((fault, allowed)) => {
                    let complaint = Complaint::new(fault, name, node.origin, Json::Null, allowed);
                    reader.complain(complaint);
                }
                None => reader.unknown_key(Section::Root, "", name, node),
            }
        }
    }
    // A study without a version has the current one.
    if let Some(node) = document.get("schema")
        && node.value != Value::Number(f64::from(SCHEMA_VERSION))
    {
        let allowed = format!("{SCHEMA_VERSION}, the only version of the study format, or omitted");
        reader.wrong("schema", node, allowed);
    }
    document.get("title").and_then(|node| reader.text("title", node))
}

/// What is wrong with a table in a study of this kind if only those of other kinds have it, or none yet.
pub(super) fn misplaced(name: &str, kind: DocumentKind) -> Option<(Fault, String)> {
    if NOT_BUILT.contains(&name) {
        let allowed = format!(
            "[{name}] is not implemented yet; this version handles belts, discs and systems"
        );
        return Some((Fault::NotBuilt, allowed));
    }
    let key = vocabulary::keys().iter().find(|key| {
        key.section == Section::Root && key.name == name && !key.scope.includes(kind)
    })?;
    if key.role == Role::Table(Section::Solver) {
        let allowed = "[solver] belongs to a study of a belt, with [belt]: every step of systems and discs is accurate to rounding";
        return Some((Fault::Conflict, allowed.to_owned()));
    }
    let kinds = DocumentKind::ALL;
    let other = kinds.into_iter().find(|kind| key.scope.includes(*kind))?.section().path();
    let allowed = if name == other {
        let own = kind.section().path();
        format!(
            "a study describes a belt, a disc or a system; [{name}] and [{own}] exclude each other"
        )
    } else {
        format!("[{name}] belongs to a study of a {other}, with [{other}]")
    };
    Some((Fault::Conflict, allowed))
}
