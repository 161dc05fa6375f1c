//! A table of known keys.

use serde_json::{Map, Value as Json, json};

/// A table of these keys and no others.
pub(super) fn object(about: &str, properties: &Map<String, Json>, required: &[&str]) -> Json {
    json!({
        "type": "object",
        "description": about,
        "properties": properties,
        "required": required,
        "additionalProperties": false,
    })
}
