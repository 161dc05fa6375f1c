//! The answer of a command, and what differs between two.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::process::Command;

use serde_json::Value as Json;

use crate::twins::Twin;

/// Texts whose words are free, counts of work, and complaints, which name the keys of each form.
const FREE: &[&str] =
    &["sentence", "why", "units", "unit_system", "steps", "title", "file", "errors"];

/// Relative and absolute difference of numbers beyond their stated errors. Far above the tolerance of both engines (10⁻¹² a step); a threshold
/// that one form bisects and the other computes exactly differs by 2·10⁻⁶, which must show. With larger ones such a second rule would hide.
const ROUNDING: (f64, f64) = (1e-6, 1e-9);

/// What a command answered.
pub(crate) struct Answer {
    code: Option<i32>,
    values: BTreeMap<String, Json>,
}

/// Something that differs.
pub(crate) struct Difference {
    /// What differs and where, as the list has it.
    pub(crate) kind: String,
    pub(crate) detail: String,
}

impl Answer {
    /// Asks `quell` in a folder.
    pub(crate) fn of(folder: &Path, words: &[&str]) -> Self {
        let mut command = Command::new(env!("CARGO_BIN_EXE_quell"));
        let output = command.args(words).arg("--json").current_dir(folder).output().expect("run");
        let mut values = BTreeMap::new();
        if let Ok(json) = serde_json::from_slice(&output.stdout) {
            flatten(&json, "", &mut values);
        }
        Self { code: output.status.code(), values }
    }

    /// Every number and word by its path.
    pub(crate) fn values(&self) -> impl Iterator<Item = (&str, &Json)> {
        self.values.iter().map(|(key, value)| (key.as_str(), value))
    }

    /// Whether the command failed.
    pub(crate) fn is_refused(&self) -> bool {
        self.code != Some(0)
    }

    /// A number and its stated error.
    pub(crate) fn number_with_error(&self, key: &str) -> (f64, f64) {
        let number = self.values.get(key).and_then(Json::as_f64);
        (number.unwrap_or_else(|| panic!("{key} of {:?}", self.values)), self.error(key))
    }

    /// The error that is stated for a value.
    fn error(&self, key: &str) -> f64 {
        let beside = [format!("{key}_error"), replaced_end(key, "value", "error")];
        let stated = beside.iter().find_map(|key| self.values.get(key)?.as_f64());
        stated.map_or(0.0, f64::abs)
    }
}

/// `key` with another last word, or itself.
fn replaced_end(key: &str, from: &str, to: &str) -> String {
    key.strip_suffix(from).map_or_else(|| key.to_owned(), |start| format!("{start}{to}"))
}

fn flatten(value: &Json, path: &str, values: &mut BTreeMap<String, Json>) {
    match value {
        Json::Object(map) => {
            for (key, inner) in map {
                let dot = if path.is_empty() { "" } else { "." };
                flatten(inner, &format!("{path}{dot}{key}"), values);
            }
        }
        Json::Array(list) => {
            values.insert(format!("{path}[]"), list.len().into());
            for (index, inner) in list.iter().enumerate() {
                flatten(inner, &format!("{path}[{index}]"), values);
            }
        }
        _ => {
            values.insert(path.to_owned(), value.clone());
        }
    }
}

/// The key without the numbers of its entries.
fn kind_of(key: &str) -> String {
    let mut kind = String::new();
    let mut inside = false;
    for letter in key.chars() {
        inside &= letter != ']';
        if !inside {
            kind.push(letter);
        }
        inside |= letter == '[';
    }
    kind
}

/// Whether the words of a key are free.
fn is_free(key: &str) -> bool {
    key.split(['.', '[']).any(|part| FREE.contains(&part))
}

/// What differs between the answers of a study's own kind and of the system.
pub(crate) fn differences(own: &Answer, system: &Answer, twin: &Twin) -> Vec<Difference> {
    if own.code != system.code {
        let (one, other) = (own.code.unwrap_or(-1), system.code.unwrap_or(-1));
        let kind = format!("exit {one} {other}");
        return vec![Difference { detail: kind.clone(), kind }];
    }
    let mut found: BTreeMap<String, String> = BTreeMap::new();
    let kinds = |answer: &Answer| -> BTreeSet<String> {
        answer.values.keys().filter(|key| !is_free(key)).map(|key| kind_of(key)).collect()
    };
    let (own_kinds, system_kinds) = (kinds(own), kinds(system));
    for key in own_kinds.difference(&system_kinds) {
        found.insert(format!("own {key}"), String::new());
    }
    for key in system_kinds.difference(&own_kinds) {
        found.insert(format!("system {key}"), String::new());
    }
    for (key, one) in own.values.iter().filter(|(key, _)| !is_free(key)) {
        let Some(other) = system.values.get(key) else { continue };
        if !same(one, other, own.error(key) + system.error(key), twin) {
            let detail = format!("{key} = {one} against {other}");
            found.entry(format!("value {}", kind_of(key))).or_insert(detail);
        }
    }
    found.into_iter().map(|(kind, detail)| Difference { kind, detail }).collect()
}

fn same(one: &Json, other: &Json, error: f64, twin: &Twin) -> bool {
    if let (Some(one), Some(other)) = (one.as_f64(), other.as_f64()) {
        let close = |one: f64| {
            (one - other).abs() <= ROUNDING.0 * one.abs().max(other.abs()) + ROUNDING.1 + error
        };
        let powers = if twin.scaled { -2..=2 } else { 0..=0 };
        return powers.into_iter().any(|power| close(one * 1000f64.powi(power)));
    }
    if let (Json::String(one), Json::String(other)) = (one, other) {
        let renamed =
            twin.renamed.iter().fold(one.clone(), |one, (own, system)| one.replace(own, system));
        return renamed == *other || one == other;
    }
    one == other
}
