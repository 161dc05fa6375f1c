//! Warnings about parameters that no formula uses.

use quell_input::document::{Node, Table, Value};

use crate::study::reader::NumbersByName;

/// Keys whose texts are no formulas.
const WORDS: &[&str] = &[
    "title",
    "units",
    "coordinates",
    "states",
    "name",
    "law",
    "waveform",
    "direction",
    "contact",
    "file",
    "kind",
    "modes",
    "frequency_response",
    "normalisation",
    "sweep",
    "design",
    "uncertainty",
];

/// The warning about parameters that are used nowhere in a document, not even by another parameter.
pub(super) fn warning(document: &Table, numbers: &NumbersByName) -> Option<String> {
    let mut used = vec![false; numbers.names.len()];
    mark(document, &numbers.names, &mut used);
    let names = numbers.names.iter().zip(&used).filter(|(_, used)| !**used);
    let names: Vec<&str> = names.map(|(name, _)| name.as_str()).collect();
    match names.as_slice() {
        [] => None,
        [name] => Some(format!("no formula uses parameters.{name}: it has no effect")),
        _ => {
            let names = names.join(", parameters.");
            Some(format!("no formula uses parameters.{names}: they have no effect"))
        }
    }
}

fn mark(table: &Table, names: &[String], used: &mut [bool]) {
    let entries = table.iter().filter(|(key, node)| {
        // `[[contact]]` is a list of tables, `contact = "pad"` a name.
        !WORDS.contains(key) || (*key == "contact" && matches!(node.value, Value::List(_)))
    });
    for (_, node) in entries {
        mark_node(node, names, used);
    }
}

fn mark_node(node: &Node, names: &[String], used: &mut [bool]) {
    match &node.value {
        Value::Text(text) => {
            let word = |letter: char| letter.is_ascii_alphanumeric() || letter == '_';
            for part in text.split(|letter| !word(letter)) {
                if let Some(index) = names.iter().position(|name| name == part) {
                    used[index] = true;
                }
            }
        }
        Value::List(list) => list.iter().for_each(|node| mark_node(node, names, used)),
        Value::Table(table) => mark(table, names, used),
        Value::Number(_) | Value::Flag(_) | Value::Date(_) => {}
    }
}
