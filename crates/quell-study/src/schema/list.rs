//! The schemas of numbers with units, of lists and of ranges, in studies of every kind.

use serde_json::{Value as Json, json};

use crate::study::vocabulary::Choice;

/// Texts of a number followed by a unit; the reader checks the unit.
const WITH_UNIT: &str =
    "^\\s*[-+]?([0-9]+[.]?[0-9]*|[.][0-9]+)([eE][-+]?[0-9]+)?\\s*[^-+.\\s0-9eE]";

/// A number, or a text such as "5.7 kN".
pub(super) fn with_units(number: &Json) -> Json {
    json!({ "anyOf": [number, { "type": "string", "pattern": WITH_UNIT }] })
}

/// Several words from a list.
pub(super) fn choices(choice: Choice) -> Json {
    json!({ "type": "array", "items": { "enum": choice.names() } })
}

/// At least one number.
pub(super) fn numbers() -> Json {
    json!({ "type": "array", "items": { "type": "number" }, "minItems": 1 })
}

/// Smallest and largest values by paths.
pub(super) fn ranges() -> Json {
    let range =
        json!({ "type": "array", "items": { "type": "number" }, "minItems": 2, "maxItems": 2 });
    json!({ "type": "object", "additionalProperties": range, "minProperties": 1 })
}

/// At least one of these.
pub(super) fn of(item: &Json) -> Json {
    json!({ "type": "array", "items": item, "minItems": 1 })
}
