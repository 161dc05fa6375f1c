//! The schema of `[uncertainty]`, in studies of every kind.

use serde_json::{Map, Value as Json, json};

use crate::study::vocabulary::{CORRELATED, DISTRIBUTIONS, JOINTLY_NORMAL};

/// Distributions by paths, their covariance and their correlation.
pub(super) fn uncertainty() -> Json {
    let of = json!({ "type": "array", "items": { "type": "string" }, "minItems": 1 });
    let row = json!({ "type": "array", "items": { "type": "number" }, "minItems": 1 });
    let matrix = json!({ "type": "array", "items": row, "minItems": 1 });
    json!({
        "type": "object",
        "description": "distributions of numbers of the study by their paths",
        "properties": {
            "covariance": {
                "type": "object",
                "description": JOINTLY_NORMAL,
                "properties": { "of": of, "mean": row, "matrix": matrix },
                "required": ["of", "mean", "matrix"],
                "additionalProperties": false,
            },
            "correlation": {
                "type": "object",
                "description": CORRELATED,
                "properties": { "of": of, "matrix": matrix },
                "required": ["of", "matrix"],
                "additionalProperties": false,
            },
        },
        "additionalProperties": { "$ref": "#/$defs/uncertainty_at" },
        "minProperties": 1,
    })
}

/// A distribution, or, where a path is written without quotes, the table of what its first name leads to.
pub(super) fn uncertainty_at() -> Json {
    let pair = |about: &str| json!({ "type": "array", "items": { "type": "number" }, "minItems": 2, "maxItems": 2, "description": about });
    let kinds: Map<String, Json> =
        DISTRIBUTIONS.iter().map(|(name, about)| ((*name).to_owned(), pair(about))).collect();
    let one = json!({
        "type": "object",
        "properties": kinds,
        "required": [],
        "minProperties": 1,
        "maxProperties": 1,
        "additionalProperties": false,
    });
    let inside = json!({
        "type": "object",
        "additionalProperties": { "$ref": "#/$defs/uncertainty_at" },
        "minProperties": 1,
    });
    json!({ "anyOf": [one, inside] })
}
