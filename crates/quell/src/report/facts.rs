//! The facts of an answer as rows of a table: path, value, unit, and the value in SI next to the number of the equations.

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
    /// The value in SI with its unit, where the answer has one.
    pub(super) si: String,
}

/// Every number, word and truth value of an answer.
pub(super) fn rows(facts: &Json) -> Vec<FactRow> {
    let empty = Map::new();
    let of = |name: &str| facts[name].as_object().unwrap_or(&empty).clone();
    let reader = FactReader { units: of("units"), why: of("why") };
    let mut rows = Vec::new();
    for (name, value) in facts.as_object().unwrap_or(&empty) {
        if !ELSEWHERE.contains(&name.as_str()) && !is_twin(name, facts, &reader.units) {
            reader.walk(name, name, value, facts, &mut rows);
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

/// Whether a field is the SI twin of another one next to it: the same name and the suffix of its unit.
fn is_twin(name: &str, object: &Json, units: &Map<String, Json>) -> bool {
    units.contains_key(name)
        && object.as_object().is_some_and(|object| {
            object.iter().any(|(other, value)| {
                value.is_number() && name.len() > other.len() && twin_of(name, other, units)
            })
        })
}

fn twin_of(name: &str, other: &str, units: &Map<String, Json>) -> bool {
    const SUFFIXES: &[&str] =
        &["n", "m", "s", "hz", "w", "kg", "m_per_s", "n_s_per_m", "n_per_m", "s_per_m", "per_s"];
    let rest = name.strip_prefix(other).and_then(|rest| rest.strip_prefix('_'));
    rest.is_some_and(|rest| SUFFIXES.contains(&rest)) && units.contains_key(other)
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
    fn walk(&self, path: &str, key: &str, value: &Json, parent: &Json, rows: &mut Vec<FactRow>) {
        match value {
            Json::Object(object) => {
                for (name, inner) in object {
                    if !is_twin(name, value, &self.units)
                        && !ELSEWHERE[3..].contains(&name.as_str())
                    {
                        self.walk(&format!("{path}.{name}"), name, inner, value, rows);
                    }
                }
            }
            Json::Array(list) if list.len() > MOST_ENTRIES => {
                let value = format!("{} entries, which --json prints", list.len());
                rows.push(FactRow {
                    path: path.to_owned(),
                    value,
                    unit: String::new(),
                    si: String::new(),
                });
            }
            Json::Array(list) if list.iter().all(Json::is_number) && !list.is_empty() => {
                let numbers: Vec<String> = list.iter().map(Json::to_string).collect();
                rows.push(self.row(path, key, numbers.join(", "), String::new()));
            }
            Json::Array(list) => {
                for (place, inner) in list.iter().enumerate() {
                    self.walk(&format!("{path}[{place}]"), key, inner, parent, rows);
                }
            }
            Json::Null => {
                let of_list = without_places(path);
                let why = [path, &of_list, key].into_iter().find_map(|name| self.why.get(name));
                let why = why.and_then(Json::as_str).unwrap_or("the answer does not give it");
                rows.push(self.row(path, key, format!("unknown: {why}"), String::new()));
            }
            Json::String(text) => rows.push(self.row(path, key, text.clone(), String::new())),
            Json::Bool(is_so) => {
                let word = if *is_so { "yes" } else { "no" };
                rows.push(self.row(path, key, word.to_owned(), String::new()));
            }
            Json::Number(number) => {
                rows.push(self.row(path, key, number.to_string(), self.si(key, parent)));
            }
        }
    }

    fn row(&self, path: &str, key: &str, value: String, si: String) -> FactRow {
        let of_list = without_places(path).replace("[]", "");
        let unit = unit_at(&self.units, &of_list, key).filter(|unit| *unit != "1");
        FactRow { path: path.to_owned(), value, unit: unit.unwrap_or_default().to_owned(), si }
    }

    fn si(&self, key: &str, parent: &Json) -> String {
        let twin = parent.as_object().and_then(|object| {
            object.iter().find(|(name, value)| value.is_number() && twin_of(name, key, &self.units))
        });
        let unit = |name: &String| self.units.get(name).and_then(Json::as_str).unwrap_or_default();
        twin.map_or_else(String::new, |(name, value)| format!("{value} {}", unit(name)))
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn facts_are_rows_with_units_reasons_and_values_in_si() {
        let facts = json!({
            "ok": true,
            "sentence": "left out",
            "amplitude": 0.5,
            "amplitude_n": 5e3,
            "list": [{ "value": 1.5, "kind": "jump" }],
            "numbers": [1, 2],
            "long": vec![0; 40],
            "none": null,
            "modes": [{ "speed": null }],
            "settled": false,
            "why": { "none": "no dither", "modes[].speed": "no diameters" },
            "units": { "amplitude": "length", "amplitude_n": "N", "value": "1" },
        });
        let row = |path: &str, value: &str, unit: &str, si: &str| FactRow {
            path: path.to_owned(),
            value: value.to_owned(),
            unit: unit.to_owned(),
            si: si.to_owned(),
        };
        let found = rows(&facts);
        for wanted in [
            row("amplitude", "0.5", "length", "5000.0 N"),
            row("list[0].value", "1.5", "", ""),
            row("list[0].kind", "jump", "", ""),
            row("numbers", "1, 2", "", ""),
            row("long", "40 entries, which --json prints", "", ""),
            row("none", "unknown: no dither", "", ""),
            row("modes[0].speed", "unknown: no diameters", "", ""),
            row("settled", "no", "", ""),
        ] {
            assert!(found.contains(&wanted), "{wanted:?}: {found:?}");
        }
        assert_eq!(found.len(), 8);
        assert_eq!(named(&facts, &["amplitude"]).len(), 1);
    }
}
