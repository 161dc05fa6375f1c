//! The facts of an answer as rows of a table: path, value and unit.

use serde_json::{Map, Value as Json};

use crate::fields::unit_at;
use crate::words::digits;

/// Lists longer than this are not written; their length is.
const MOST_ENTRIES: usize = 12;
/// Fields that are written elsewhere in the report.
const ELSEWHERE: &[&str] = &["ok", "sentence", "warnings", "units", "why", "title"];

/// A fact.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct FactRow {
    /// Its path, such as `critical_amplitudes[0].amplitude`.
    pub(super) path: String,
    /// The value as JSON writes it.
    pub(super) value: String,
    pub(super) unit: String,
}

/// Every number, word and truth value of an answer.
pub(super) fn rows(facts: &Json) -> Vec<FactRow> {
    let empty = Map::new();
    let of = |name: &str| facts[name].as_object().unwrap_or(&empty).clone();
    let reader = FactReader { units: of("units"), why: of("why") };
    let mut rows = Vec::new();
    for (name, value) in facts.as_object().unwrap_or(&empty) {
        if !ELSEWHERE.contains(&name.as_str()) {
            reader.walk(name, name, value, &mut rows);
        }
    }
    rows
}

/// The rows whose last key begins with one of these words, for readers: numbers have six digits.
pub(super) fn named(facts: &Json, words: &[&str]) -> Vec<FactRow> {
    let is_named = |row: &FactRow| {
        let key = row.path.rsplit('.').next().unwrap_or_default();
        words.iter().any(|word| key.starts_with(word))
    };
    let rounded = |row: FactRow| match row.value.parse() {
        Ok(value) => FactRow { value: digits(value), ..row },
        Err(_) => row,
    };
    rows(facts).into_iter().filter(is_named).map(rounded).collect()
}

/// A path whose places in lists are left out, as reasons about all entries of a list have it: `modes[].speed`.
fn without_places(path: &str) -> String {
    let mut general = String::new();
    let mut inside = false;
    for letter in path.chars() {
        inside &= letter != ']';
        if !inside {
            general.push(letter);
        }
        inside |= letter == '[';
    }
    general
}

/// Units and reasons of an answer.
struct FactReader {
    units: Map<String, Json>,
    why: Map<String, Json>,
}

impl FactReader {
    fn walk(&self, path: &str, key: &str, value: &Json, rows: &mut Vec<FactRow>) {
        match value {
            Json::Object(object) => {
                for (name, inner) in object {
                    if !ELSEWHERE[3..].contains(&name.as_str()) {
                        self.walk(&format!("{path}.{name}"), name, inner, rows);
                    }
                }
            }
            Json::Array(list) if list.len() > MOST_ENTRIES => {
                let value = format!("{} entries, which --json prints", list.len());
                rows.push(FactRow { path: path.to_owned(), value, unit: String::new() });
            }
            Json::Array(list) if list.iter().all(Json::is_number) && !list.is_empty() => {
                let numbers: Vec<String> = list.iter().map(Json::to_string).collect();
                rows.push(self.row(path, key, numbers.join(", ")));
            }
            Json::Array(list) => {
                for (place, inner) in list.iter().enumerate() {
                    self.walk(&format!("{path}[{place}]"), key, inner, rows);
                }
            }
            Json::Null => {
                let of_list = without_places(path);
                let why = [path, &of_list, key].into_iter().find_map(|name| self.why.get(name));
                let why = why.and_then(Json::as_str).unwrap_or("the answer does not give it");
                rows.push(self.row(path, key, format!("unknown: {why}")));
            }
            Json::String(text) => rows.push(self.row(path, key, text.clone())),
            Json::Bool(is_so) => {
                let word = if *is_so { "yes" } else { "no" };
                rows.push(self.row(path, key, word.to_owned()));
            }
            Json::Number(number) => {
                rows.push(self.row(path, key, number.to_string()));
            }
        }
    }

    fn row(&self, path: &str, key: &str, value: String) -> FactRow {
        let of_list = without_places(path).replace("[]", "");
        let unit = unit_at(&self.units, &of_list, key).filter(|unit| *unit != "1");
        FactRow { path: path.to_owned(), value, unit: unit.unwrap_or_default().to_owned() }
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn facts_are_rows_with_units_and_reasons() {
        let facts = json!({
            "ok": true,
            "sentence": "left out",
            "amplitude": 0.5,
            "list": [{ "value": 1.5, "kind": "jump" }],
            "numbers": [1, 2],
            "long": vec![0; 40],
            "none": null,
            "modes": [{ "speed": null }],
            "settled": false,
            "why": { "none": "no dither", "modes[].speed": "no diameters" },
            "units": { "amplitude": "N", "value": "1" },
        });
        let row = |path: &str, value: &str, unit: &str| FactRow {
            path: path.to_owned(),
            value: value.to_owned(),
            unit: unit.to_owned(),
        };
        let found = rows(&facts);
        for wanted in [
            row("amplitude", "0.5", "N"),
            row("list[0].value", "1.5", ""),
            row("list[0].kind", "jump", ""),
            row("numbers", "1, 2", ""),
            row("long", "40 entries, which --json prints", ""),
            row("none", "unknown: no dither", ""),
            row("modes[0].speed", "unknown: no diameters", ""),
            row("settled", "no", ""),
        ] {
            assert!(found.contains(&wanted), "{wanted:?}: {found:?}");
        }
        assert_eq!(found.len(), 8);
        assert_eq!(named(&facts, &["amplitude"]).len(), 1);
    }
}
