//! Reads the tables of a system.

use std::sync::Arc;

use quell_model::{Contact, System};
use serde_json::Value as Json;

use super::contact::{self, ContactContext};
use super::dither::{self, DitherContext};
use super::initial;
use super::keys::SystemTable;
use super::numbers::{Numbers, missing, unknown_keys};
use super::structure::{self, Body};
use super::units::SystemUnits;
use super::{SystemSetup, parameters};
use crate::complaint::{Complaint, Fault, Origin};
use crate::study::document::Table;
use crate::study::reader::Reader;
use crate::study::study_kind::Given;
use crate::study::vocabulary::Choice;

/// Reads the study of a system; `None` if something is wrong, which has then been reported.
pub(super) fn study(
    reader: &mut Reader,
    document: &Table,
    given: Given<'_, SystemSetup>,
) -> Option<SystemSetup> {
    conflicts(reader, document);
    let units = units(reader, document);
    let numbers = parameters::read(reader, document, units);
    let node = document.get("system");
    let header = node.map_or(Origin::Whole, |node| node.origin);
    let Some(node) = node else {
        missing(reader, "system", header, "a table [system] with coordinates, mass and stiffness");
        return None;
    };
    let table = reader.table("system", node)?;
    unknown_keys(reader, table, "system", SystemTable::System);
    let Body { basis, structure } = body(reader, &numbers, table, header);
    // Without names no row can be read.
    let basis = basis?;
    let first_order = table.has("states");
    let known = given.known.map_or(&[][..], |setup| &setup.measured);
    let context = ContactContext {
        numbers: &numbers,
        basis: &basis,
        first_order,
        measured: false,
        shared: document.get("friction"),
        folder: given.folder,
        known,
    };
    let contacts = contact::read(reader, document, context);
    let (contacts, measured): (Option<Vec<Contact>>, Vec<_>) = match contacts {
        Some(read) => {
            let (contacts, measured): (Vec<_>, Vec<_>) = read.into_iter().unzip();
            (Some(contacts), measured)
        }
        None => (None, Vec::new()),
    };
    let names = contact::names(document);
    let context = DitherContext {
        numbers: &numbers,
        basis: &basis,
        names: &names,
        contacts: contacts.as_deref(),
    };
    let inputs = dither::read(reader, document, context);
    let observe = initial::observe(reader, table, &numbers, &basis);
    let initial = initial::read(reader, table, &numbers, &basis, first_order);
    let (structure, contacts, inputs) = (structure?, contacts?, inputs?);
    let observe = observe?.unwrap_or_else(|| initial::default_row(&contacts, &structure));
    let system = Arc::new(System { structure, contacts, inputs });
    let warnings = Vec::new();
    let initial = initial?;
    Some(SystemSetup { system, observe, initial, numbers, warnings, measured: measured.into() })
}

/// Reports tables of the other kinds.
fn conflicts(reader: &mut Reader, document: &Table) {
    for name in ["belt", "disc"] {
        if let Some(node) = document.get(name) {
            let allowed = format!(
                "a study describes a belt, a disc or a system; [{name}] and [system] exclude each other"
            );
            let complaint = Complaint::new(Fault::Conflict, name, node.origin, Json::Null, allowed);
            reader.complain(complaint);
        }
    }
}

fn units(reader: &mut Reader, document: &Table) -> SystemUnits {
    let system = document.get("system").and_then(|node| node.table());
    let Some(node) = system.and_then(|table| table.get("units")) else {
        return SystemUnits::None;
    };
    let name = reader.choice("system.units", node, Choice::SystemUnits);
    name.and_then(SystemUnits::from_name).unwrap_or_default()
}

/// Reads the structure in the form that its keys choose.
fn body(reader: &mut Reader, numbers: &Numbers, table: &Table, header: Origin) -> Body {
    let forms = ["coordinates", "states"];
    let mut given = forms.into_iter().filter_map(|name| Some((name, table.get(name)?)));
    let Some((form, _)) = given.next() else {
        let allowed = "the names of the coordinates, with mass and stiffness; or states and matrix";
        missing(reader, "system.coordinates", header, allowed);
        return Body::default();
    };
    if let Some((other, node)) = given.next() {
        let key = format!("system.{other}");
        let allowed = format!("give either system.{form} or {key}, not both");
        reader.complain(Complaint::new(Fault::Conflict, key, node.origin, Json::Null, allowed));
    }
    match form {
        "states" => structure::first_order(reader, numbers, table, header),
        _ => structure::mechanical(reader, numbers, table, header),
    }
}
