//! The tables of belts and discs, and those that all kinds share.

use quell_model::friction::samples::{FEWEST, MOST_TERMS};
use quell_model::parameter::{Bounds, Parameter};
use quell_model::units::{Quantity, UnitSystem};
use serde_json::{Map, Value as Json, json};

use super::list::with_units;
use super::object::object;
use super::{course, list, waveform};
use crate::study::vocabulary::{
    self, DocumentKind, Key, MOST_POINTS, Role, SCHEMA_VERSION, Section,
};

/// The name of a definition.
pub(super) fn name(section: Section) -> String {
    match section {
        Section::Envelope => "envelope".to_owned(),
        section => section.path().replace('.', "_"),
    }
}

/// A reference to a definition.
pub(super) fn reference(name: &str) -> Json {
    json!({ "$ref": format!("#/$defs/{name}") })
}

/// A table, or several as a list.
pub(super) fn one_or_several(one: &Json) -> Json {
    json!({ "anyOf": [one, { "type": "array", "items": one }] })
}

/// One requirement a key.
pub(super) fn required(keys: &[&str]) -> Vec<Json> {
    keys.iter().map(|key| json!({ "required": [key] })).collect()
}

/// Exactly one of several keys.
pub(super) fn one_of(keys: &[&str]) -> Json {
    json!({ "oneOf": required(keys) })
}

/// At least one of several keys.
pub(super) fn some_of(keys: &[&str]) -> Json {
    json!({ "anyOf": required(keys) })
}

/// None of several keys.
pub(super) fn excluding(keys: &[&str]) -> Json {
    json!({ "not": { "anyOf": required(keys) } })
}

/// A table with all of its keys; one that studies of several kinds give in their own ways may be any of these.
pub(super) fn of_section(section: Section, needed: &[&str]) -> Json {
    let mut properties: Map<String, Json> = Map::new();
    for key in vocabulary::keys().iter().filter(|key| key.section == section) {
        let one = property(key);
        match properties.get_mut(key.name) {
            None => {
                properties.insert(key.name.to_owned(), one);
            }
            Some(other) if value(other) != value(&one) => {
                let about = other["description"].take();
                let mut either = alternatives(other);
                let more = alternatives(&one).into_iter();
                either.extend(more.filter(|one| !alternatives(other).contains(one)));
                *other = json!({ "anyOf": either, "description": about });
            }
            Some(_) => {}
        }
    }
    object(section.about(), &properties, needed)
}

/// The keys of a table in studies of a kind, without descriptions.
pub(super) fn properties(section: Section, kind: DocumentKind) -> Map<String, Json> {
    let of_kind = |key: &Key| property(&Key { scope: kind.scope(), ..*key });
    let keys = vocabulary::keys_of(section, kind);
    keys.map(|key| (key.name.to_owned(), value(&of_kind(key)))).collect()
}

/// The values of which a value may be any.
fn alternatives(described: &Json) -> Vec<Json> {
    match described["anyOf"].as_array() {
        Some(any) => any.clone(),
        None => vec![value(described)],
    }
}

/// What a value may be, without its description.
fn value(described: &Json) -> Json {
    let mut value = described.clone();
    if let Some(object) = value.as_object_mut() {
        object.remove("description");
    }
    value
}

/// The value of a key, described.
pub(super) fn property(key: &Key) -> Json {
    let mut schema = match key.role {
        Role::Number(parameter) | Role::Twin(parameter, _) | Role::Size(parameter, _)
            if key.scope.includes(DocumentKind::System) =>
        {
            number_or_formula(Some(parameter))
        }
        Role::Number(parameter) | Role::Twin(parameter, _) | Role::Size(parameter, _) => {
            number(parameter)
        }
        Role::Choice(choice) => json!({ "enum": choice.names() }),
        Role::Wave(wave) => waveform::property(wave),
        Role::Course(course) => course::property(course, key.section.course()),
        Role::Text => json!({ "type": "string" }),
        Role::Flag => json!({ "type": "boolean" }),
        Role::Schema => json!({ "const": SCHEMA_VERSION }),
        Role::Choices(choice) => list::choices(choice),
        Role::Reference => {
            json!({ "oneOf": [{ "const": "critical" }, { "type": "number", "exclusiveMinimum": 0.0 }] })
        }
        Role::Coefficient => json!({}),
        Role::FrictionForce(..) => with_units(&bounded(Bounds::NOT_NEGATIVE, Quantity::Ratio)),
        Role::Speeds { .. } => {
            let speed = with_units(&bounded(Bounds::NOT_NEGATIVE, Quantity::Ratio));
            json!({ "type": "array", "items": speed, "minItems": FEWEST })
        }
        Role::Band { .. } => {
            let bounds = if key.section == Section::Dither {
                Bounds::POSITIVE
            } else {
                Bounds::NOT_NEGATIVE
            };
            let end = with_units(&bounded(bounds, Quantity::FrequencyRatio));
            json!({ "type": "array", "items": end, "minItems": 2, "maxItems": 2 })
        }
        Role::Terms => json!({ "type": "integer", "minimum": 1, "maximum": MOST_TERMS }),
        Role::AxisNumber => with_units(&json!({ "type": "number" })),
        Role::Constant => json!({ "type": "number" }),
        Role::AxisPoints => json!({ "type": "integer", "minimum": 2, "maximum": MOST_POINTS }),
        Role::AxisValues => list::numbers(),
        Role::Paths | Role::Names => {
            json!({ "type": "array", "items": { "type": "string" }, "minItems": 1 })
        }
        Role::Ranges => list::ranges(),
        Role::Matrix(_) => matrix(),
        Role::Row(_) => json!({ "anyOf": [list::of(&number_or_formula(None)), entries()] }),
        Role::Table(inner) => reference(&name(inner)),
        Role::List(inner) | Role::Tables(inner @ Section::Sweep) => {
            json!({ "type": "array", "items": reference(&name(inner)) })
        }
        Role::Tables(inner) => one_or_several(&reference(&name(inner))),
    };
    schema["description"] = about(key).into();
    schema
}

/// A diagonal, rows or a file.
fn matrix() -> Json {
    let entry = number_or_formula(None);
    let rows = list::of(&json!({ "anyOf": [entry, list::of(&entry)] }));
    let name = json!({ "type": "string", "description": "Matrix Market file, relative to the study file" });
    let file = json!({
        "type": "object",
        "properties": { "file": name },
        "required": ["file"],
        "additionalProperties": false,
    });
    json!({ "anyOf": [rows, file] })
}

/// A row as a table: names with a dot may be nested tables.
fn entries() -> Json {
    let entry = number_or_formula(None);
    let inner = json!({ "type": "object", "additionalProperties": entry });
    json!({ "type": "object", "additionalProperties": { "anyOf": [entry, inner] } })
}

/// Numbers whose names the study chooses.
pub(super) fn named(section: Section) -> Json {
    json!({
        "type": "object",
        "description": section.about(),
        "additionalProperties": number_or_formula(None),
    })
}

/// A number, or a text: a number with a unit or a formula.
pub(super) fn number_or_formula(parameter: Option<Parameter>) -> Json {
    let mut plain = json!({ "type": "number" });
    if let Some(Bounds { lower, lower_included, .. }) = parameter.map(|known| known.bounds)
        && lower.is_finite()
    {
        plain[if lower_included { "minimum" } else { "exclusiveMinimum" }] = lower.into();
    }
    json!({ "anyOf": [plain, { "type": "string" }] })
}

/// A number of the registry.
pub(super) fn number(parameter: Parameter) -> Json {
    let Parameter { bounds, quantity, .. } = parameter;
    if quantity == Quantity::Count {
        return bounded(bounds, quantity);
    }
    // With a unit the bounds depend on the scales unless they are about the sign.
    let any = quantity.si_unit().is_some() && !parameter.is_pure();
    let signed = match bounds {
        Bounds { lower: 0.0, upper: f64::INFINITY, .. } => bounds,
        Bounds { lower: 0.0, .. } if any => Bounds { upper: f64::INFINITY, ..bounds },
        _ if any => Bounds::FINITE,
        _ => bounds,
    };
    with_units(&bounded(signed, quantity))
}

fn about(key: &Key) -> String {
    match key.role {
        Role::Number(_) | Role::Twin(..) | Role::Size(..) => {
            let symbol = key.symbol().unwrap_or_default();
            format!(
                "{symbol}: {}, in {}",
                key.about,
                key.unit_in_words(key.first_kind(), UnitSystem::None)
            )
        }
        Role::Speeds { .. } | Role::Band { .. } | Role::FrictionForce(..) => {
            format!("{}, in {}", key.about, key.unit(UnitSystem::None))
        }
        _ => key.about.to_owned(),
    }
}

pub(super) fn bounded(bounds: Bounds, quantity: Quantity) -> Json {
    let whole = quantity == Quantity::Count;
    let mut schema = json!({ "type": if whole { "integer" } else { "number" } });
    if bounds.lower.is_finite() {
        let keyword = if bounds.lower_included { "minimum" } else { "exclusiveMinimum" };
        schema[keyword] = bounds.lower.into();
    }
    if bounds.upper.is_finite() {
        schema["maximum"] = bounds.upper.into();
    }
    schema
}
