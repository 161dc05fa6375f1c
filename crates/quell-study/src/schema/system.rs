//! The schema of the tables that only a system has, made from their keys.

use quell_model::parameter::{Bounds, DITHER_AMPLITUDE, Parameter};
use serde_json::{Map, Value as Json, json};

use crate::study::system::keys::{SystemKey, SystemRole, SystemTable, system_keys};

/// Adds the definitions of the tables that only a system has.
pub(super) fn define(definitions: &mut Map<String, Json>) {
    for (which, required) in [
        (SystemTable::System, &[][..]),
        (SystemTable::Mode, &["damping_ratio", "shape"]),
        (SystemTable::Component, &["name"]),
        (SystemTable::Initial, &[]),
        (SystemTable::Contact, &[]),
        (SystemTable::DitherPlace, &[]),
    ] {
        definitions.insert(name(which).to_owned(), table(which, required));
    }
    definitions.insert(name(SystemTable::Named).to_owned(), named());
}

fn name(which: SystemTable) -> &'static str {
    match which {
        SystemTable::Root | SystemTable::System => "system",
        SystemTable::Mode => "system_mode",
        SystemTable::Component => "system_component",
        SystemTable::Initial => "system_initial",
        SystemTable::Contact => "contact",
        SystemTable::Friction => "friction",
        SystemTable::Dither => "dither",
        SystemTable::Drive => "belt_drive",
        SystemTable::Load => "belt_load",
        SystemTable::Envelope => "envelope",
        SystemTable::Design => "design",
        SystemTable::DesignLimits => "design_limits",
        SystemTable::DitherPlace => "dither_place",
        SystemTable::Actuator => "actuator",
        SystemTable::Named => "parameters",
    }
}

fn reference(which: SystemTable) -> Json {
    json!({ "$ref": format!("#/$defs/{}", name(which)) })
}

fn table(which: SystemTable, required: &[&str]) -> Json {
    let mut properties = Map::new();
    for key in system_keys(which) {
        properties.insert(key.name.to_owned(), described(key));
        for twin in key.twins() {
            properties.insert(twin, described(key));
        }
    }
    let about = match which {
        SystemTable::System => "the linear structure",
        SystemTable::Mode => "a mode",
        SystemTable::Component => "a body given by its modes",
        SystemTable::Initial => "initial state of a run",
        SystemTable::DitherPlace => "where a dither acts: at, or contact and direction",
        _ => "a friction contact",
    };
    super::object::object(about, &properties, required)
}

/// The value of a key of a system, described.
pub(super) fn described(key: &SystemKey) -> Json {
    let mut schema = property(key);
    schema["description"] = key.about.into();
    schema
}

fn property(key: &SystemKey) -> Json {
    let entry = number(None);
    let list = json!({ "type": "array", "items": entry, "minItems": 1 });
    match key.role {
        SystemRole::Number(parameter) => number(Some(parameter)),
        SystemRole::Size(_) => number(Some(DITHER_AMPLITUDE)),
        SystemRole::Matrix(_) => {
            let rows =
                json!({ "type": "array", "items": { "anyOf": [entry, list] }, "minItems": 1 });
            let name = json!({ "type": "string", "description": "Matrix Market file, relative to the study file" });
            let file = json!({
                "type": "object",
                "properties": { "file": name },
                "required": ["file"],
                "additionalProperties": false,
            });
            json!({ "anyOf": [rows, file] })
        }
        SystemRole::Row(_) => json!({ "anyOf": [list, entries()] }),
        SystemRole::Names => {
            json!({ "type": "array", "items": { "type": "string" }, "minItems": 1 })
        }
        SystemRole::Numbers => super::list::numbers(),
        SystemRole::Ranges => super::list::ranges(),
        SystemRole::Choices(choice) => super::list::choices(choice),
        SystemRole::Choice(choice) => json!({ "enum": choice.names() }),
        SystemRole::Wave(wave) => super::waveform::property(wave),
        SystemRole::Course(course) => super::course::property(course, None),
        SystemRole::Text => json!({ "type": "string" }),
        SystemRole::Flag => json!({ "type": "boolean" }),
        SystemRole::Table(inner) => reference(inner),
        SystemRole::List(inner) => {
            json!({ "type": "array", "items": reference(inner), "minItems": 1 })
        }
        SystemRole::Tables(inner) => {
            let one = reference(inner);
            json!({ "anyOf": [one, { "type": "array", "items": one }] })
        }
    }
}

/// A row as a table: names with a dot may be nested tables.
fn entries() -> Json {
    let entry = number(None);
    let inner = json!({ "type": "object", "additionalProperties": entry });
    json!({ "type": "object", "additionalProperties": { "anyOf": [entry, inner] } })
}

/// A number, or a text: a number with a unit or a formula.
pub(super) fn number(parameter: Option<Parameter>) -> Json {
    let mut plain = json!({ "type": "number" });
    if let Some(Bounds { lower, lower_included, .. }) = parameter.map(|known| known.bounds)
        && lower.is_finite()
    {
        plain[if lower_included { "minimum" } else { "exclusiveMinimum" }] = lower.into();
    }
    json!({ "anyOf": [plain, { "type": "string" }] })
}

fn named() -> Json {
    json!({
        "type": "object",
        "description": "named numbers for formulas: numbers, or formulas of other parameters",
        "additionalProperties": number(None),
    })
}
