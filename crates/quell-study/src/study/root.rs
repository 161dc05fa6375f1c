//! The keys outside any table (version and title), and unknown tables.

use serde_json::Value as Json;

use super::document::{Table, Value};
use super::reader::Reader;
use super::suggest;
use super::system::keys;
use super::vocabulary::{self, NOT_BUILT, SCHEMA_VERSION, Section};
use crate::complaint::{Complaint, Fault};

/// Reports unknown tables and keys; `tables` are those of this kind of study. Returns the title.
pub(super) fn read(reader: &mut Reader, document: &Table, tables: &[&str]) -> Option<String> {
    let known: Vec<&str> = Section::ALL.iter().map(|section| section.path()).collect();
    let is_system = keys::is_described(document);
    for (name, node) in document.iter() {
        if NOT_BUILT.contains(&name) {
            let allowed = format!(
                "[{name}] is not implemented yet; this version handles belts, discs and systems"
            );
            let complaint = Complaint::new(Fault::NotBuilt, name, node.origin, Json::Null, allowed);
            reader.complain(complaint);
            continue;
        }
        if vocabulary::key(Section::Root, name).is_some() || tables.contains(&name) {
            continue;
        }
        if name == Section::Actuator.path() {
            let allowed = "[actuator] is implemented for belts and systems: the dither of a disc modulates its friction";
            let complaint = Complaint::new(Fault::NotBuilt, name, node.origin, Json::Null, allowed);
            reader.complain(complaint);
            continue;
        }
        if keys::TABLES.contains(&name) && !known.contains(&name) {
            let allowed = format!("[{name}] belongs to a study of a system, with [system]");
            let complaint = Complaint::new(Fault::Conflict, name, node.origin, Json::Null, allowed);
            reader.complain(complaint);
        } else if !known.contains(&name) || (is_system && !keys::OTHER_KINDS.contains(&name)) {
            let nearest = suggest::word(name, tables.iter().copied())
                .or_else(|| suggest::path("", name, None));
            let complaint =
                Complaint::new(Fault::Unknown, name, node.origin, node.given(), tables.join(", "));
            reader.complain(complaint.suggesting(nearest));
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
