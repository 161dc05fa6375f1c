//! The tables of belts and discs, and those that all kinds share.

use quell_model::friction::samples::{FEWEST, MOST_TERMS};
use quell_model::parameter::{Bounds, Parameter};
use quell_model::units::{Quantity, UnitSystem};
use serde_json::{Map, Value as Json, json};

use super::object::object;
use super::{course, list, waveform};
use crate::study::system::keys::{SystemTable, system_keys};
use crate::study::vocabulary::{self, Key, MOST_POINTS, Role, SCHEMA_VERSION, Section};

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

/// The tables inside a table, with the names of their definitions, and whether they may be lists.
fn inner(section: Section) -> &'static [(&'static str, &'static str, bool)] {
    match section {
        Section::Belt => &[
            ("initial", "belt_initial", false),
            ("drive", "belt_drive", false),
            ("load", "belt_load", false),
        ],
        Section::Disc => &[
            ("mode", "disc_mode", true),
            ("load", "disc_load", true),
            ("drive", "disc_drive", false),
        ],
        Section::DiscLoad => &[("envelope", "disc_load_envelope", false)],
        Section::Dither => &[("envelope", "envelope", false)],
        Section::Design => &[("limits", "design_limits", false)],
        _ => &[],
    }
}

/// A table with all of its keys.
pub(super) fn of_section(section: Section) -> Json {
    let mut properties: Map<String, Json> =
        vocabulary::keys_of(section).map(|key| (key.name.to_owned(), property(key))).collect();
    // Those of a system that a belt or a disc does not have.
    let more = match section {
        Section::Dither => Some(SystemTable::Dither),
        Section::Design => Some(SystemTable::Design),
        _ => None,
    };
    for key in more.map(system_keys).unwrap_or_default() {
        if !properties.contains_key(key.name) {
            properties.insert(key.name.to_owned(), super::system::described(key));
        }
    }
    for (name, definition, several) in inner(section) {
        let one = reference(definition);
        let table = if *several { one_or_several(&one) } else { one };
        properties.insert((*name).to_owned(), table);
    }
    if section == Section::Dither {
        let words = vocabulary::Choice::ContactDirection.names();
        properties.insert("direction".to_owned(), json!({ "enum": words }));
    }
    object(section.about(), &properties, &[])
}

/// The value of a key, described.
pub(super) fn property(key: &Key) -> Json {
    let mut schema = match key.role {
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
        Role::Paths => json!({ "type": "array", "items": { "type": "string" }, "minItems": 1 }),
        Role::Ranges => list::ranges(),
    };
    schema["description"] = about(key).into();
    schema
}

/// Texts of a number followed by a unit; the reader checks the unit.
const WITH_UNIT: &str =
    "^\\s*[-+]?([0-9]+[.]?[0-9]*|[.][0-9]+)([eE][-+]?[0-9]+)?\\s*[^-+.\\s0-9eE]";

/// A number, or a text such as "5.7 kN".
fn with_units(number: &Json) -> Json {
    json!({ "anyOf": [number, { "type": "string", "pattern": WITH_UNIT }] })
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
            format!("{symbol}: {}, in {}", key.about, key.unit_in_words(UnitSystem::None))
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
