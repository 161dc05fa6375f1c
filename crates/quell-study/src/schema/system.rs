//! The schema of a study of a system, made from its keys.

use quell_model::parameter::{Bounds, DITHER_AMPLITUDE, Parameter};
use serde_json::{Map, Value as Json, json};

use crate::study::system::keys::{SystemKey, SystemRole, SystemTable, system_keys};
use crate::study::vocabulary::{self, Choice, Role, SCHEMA_ABOUT, SCHEMA_VERSION, Section};

/// Adds the definitions of a study of a system; its root is `study_system`.
pub(super) fn define(definitions: &mut Map<String, Json>) {
    for (which, required) in [
        (SystemTable::System, &[][..]),
        (SystemTable::Mode, &["damping_ratio", "shape"]),
        (SystemTable::Component, &["name"]),
        (SystemTable::Initial, &[]),
        (SystemTable::Contact, &[]),
        (SystemTable::Dither, &["waveform"]),
        (SystemTable::Drive, &[]),
        (SystemTable::Load, &[]),
        (SystemTable::Envelope, &[]),
        (SystemTable::Design, &["minimise", "vary", "from", "to"]),
        (SystemTable::DesignLimits, &[]),
        (SystemTable::DitherPlace, &[]),
        (SystemTable::Actuator, &["kind"]),
    ] {
        definitions.insert(name(which).to_owned(), table(which, required));
    }
    definitions.insert(name(SystemTable::Friction).to_owned(), friction());
    definitions.insert(name(SystemTable::Named).to_owned(), named());
    let mut root = table(SystemTable::Root, &["system"]);
    let properties = &mut root["properties"];
    properties["schema"] = json!({ "const": SCHEMA_VERSION, "description": SCHEMA_ABOUT });
    properties["title"] = json!({ "type": "string", "description": "subject of the study" });
    properties["uncertainty"] = json!({ "$ref": "#/$defs/uncertainty" });
    properties["sweep"] = json!({ "type": "array", "items": { "$ref": "#/$defs/sweep" } });
    definitions.insert("study_system".to_owned(), root);
}

fn name(which: SystemTable) -> &'static str {
    match which {
        SystemTable::Root => "study_system",
        SystemTable::System => "system",
        SystemTable::Mode => "system_mode",
        SystemTable::Component => "system_component",
        SystemTable::Initial => "system_initial",
        SystemTable::Contact => "contact",
        SystemTable::Friction => "contact_friction",
        SystemTable::Dither => "system_dither",
        SystemTable::Drive => "contact_drive",
        SystemTable::Load => "contact_load",
        SystemTable::Envelope => "system_envelope",
        SystemTable::Design => "system_design",
        SystemTable::DesignLimits => "system_limits",
        SystemTable::DitherPlace => "dither_place",
        SystemTable::Actuator => "system_actuator",
        SystemTable::Named => "parameters",
    }
}

fn reference(which: SystemTable) -> Json {
    json!({ "$ref": format!("#/$defs/{}", name(which)) })
}

fn table(which: SystemTable, required: &[&str]) -> Json {
    let mut properties = Map::new();
    for key in system_keys(which) {
        properties.insert(key.name.to_owned(), described(property(key), key.about));
        for twin in key.twins() {
            properties.insert(twin, described(property(key), key.about));
        }
    }
    let about = match which {
        SystemTable::Root => "a study of a linear structure with friction contacts",
        SystemTable::System => "the linear structure",
        SystemTable::Mode => "a mode",
        SystemTable::Component => "a body given by its modes",
        SystemTable::Initial => "initial state of a run",
        SystemTable::Dither => {
            "a force on coordinates, periodic or noise, or a modulation of a load"
        }
        SystemTable::Drive => "velocity of the surface over time",
        SystemTable::Load => "normal load over time",
        SystemTable::Envelope => "share of the amplitude over time",
        SystemTable::Design => Section::Design.about(),
        SystemTable::DesignLimits => Section::DesignLimits.about(),
        SystemTable::DitherPlace => "where a dither acts: at, or contact and direction",
        SystemTable::Actuator => Section::Actuator.about(),
        _ => "a friction contact",
    };
    let mut object = json!({
        "type": "object",
        "description": about,
        "properties": properties,
        "required": required,
        "additionalProperties": false,
    });
    if which == SystemTable::Dither {
        let relation = super::waveform::noise_or_periodic(&["frequency", "frequency_hz", "phase"]);
        object["allOf"] = json!([relation]);
    }
    object
}

fn described(mut schema: Json, about: &str) -> Json {
    schema["description"] = about.into();
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
fn number(parameter: Option<Parameter>) -> Json {
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

/// The keys of every law. Which of them a law has is left to `quell check`, because each number may be a formula.
fn friction() -> Json {
    let mut properties = Map::new();
    for key in vocabulary::keys_of(Section::Friction) {
        let schema = match key.role {
            Role::FrictionForce(..) => continue,
            Role::Choice(choice) => json!({ "enum": choice.names() }),
            Role::Text => json!({ "type": "string" }),
            Role::Terms => json!({ "type": "integer", "minimum": 1 }),
            Role::Speeds { .. } => json!({ "type": "array", "items": number(None) }),
            Role::Coefficient => {
                json!({ "anyOf": [number(None), { "type": "array", "items": number(None) }] })
            }
            _ => number(None),
        };
        properties.insert(key.name.to_owned(), described(schema, key.about));
    }
    let constants = described(named(), Section::Constants.about());
    properties.insert("constants".to_owned(), constants);
    properties.insert("law".to_owned(), json!({ "enum": Choice::Law.names() }));
    json!({
        "type": "object",
        "description": Section::Friction.about(),
        "properties": properties,
        "required": ["law"],
        "additionalProperties": false,
    })
}
