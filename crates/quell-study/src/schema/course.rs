//! The schema of the keys of drives, loads and envelopes.

use quell_model::profile::MOST_KNOTS;
use serde_json::{Value as Json, json};

use super::list::with_units;
use crate::study::vocabulary::{CourseKey, CourseTable};

/// The value of a key; `table` is what its table gives.
pub(super) fn property(course: CourseKey, table: Option<CourseTable>) -> Json {
    let list = |item: Json| json!({ "type": "array", "items": item, "minItems": 1, "maxItems": MOST_KNOTS });
    match course {
        CourseKey::Time { .. } => list(with_units(&json!({ "type": "number" }))),
        CourseKey::Value { .. } => {
            let positive = table.is_some_and(|table| table.bounds.lower == 0.0);
            list(with_units(&if positive {
                json!({ "type": "number", "exclusiveMinimum": 0 })
            } else {
                json!({ "type": "number" })
            }))
        }
        CourseKey::Shape | CourseKey::File => json!({ "type": "string" }),
    }
}
