//! Names of coordinates, states, components and contacts.

use quell_input::document::{Table, Value};

use crate::study::reader::Reader;
use crate::study::vocabulary::join;

/// The largest number of coordinates, states or modes.
pub(super) const MOST_COORDINATES: usize = 2000;

/// The prefix of the keys read here.
pub(super) const PREFIX: &str = "system";

/// Names of coordinates or states, each once.
pub(super) fn names(reader: &mut Reader, table: &Table, key: &str) -> Option<Vec<String>> {
    let node = table.get(key)?;
    let key = join(PREFIX, key);
    let Value::List(list) = &node.value else {
        reader.wrong(&key, node, format!("an array of names; got {}", node.kind()));
        return None;
    };
    if list.is_empty() || list.len() > MOST_COORDINATES {
        let allowed = format!("an array of 1 to {MOST_COORDINATES} names; got {}", list.len());
        reader.wrong(&key, node, allowed);
        return None;
    }
    let mut names: Vec<String> = Vec::with_capacity(list.len());
    let mut right = true;
    for (index, node) in list.iter().enumerate() {
        let at = format!("{key}[{index}]");
        match &node.value {
            Value::Text(text) if names.contains(text) => {
                reader.wrong(&at, node, "a name that no other coordinate has");
                right = false;
            }
            Value::Text(text) if is_plain_name(text) => names.push(text.clone()),
            _ => {
                reader.wrong(&at, node, NAME);
                right = false;
            }
        }
    }
    right.then_some(names)
}

/// What a name of a coordinate, a component or a contact must be.
pub(super) const NAME: &str = "a name in quotes without the characters . [ ] = , and on one line";

/// Whether a name can be part of a path.
pub(super) fn is_plain_name(name: &str) -> bool {
    let is_special = |c: char| ".[]=,".contains(c) || c.is_control();
    !name.trim().is_empty() && name.trim() == name && !name.contains(is_special)
}

#[cfg(test)]
mod tests {
    use super::is_plain_name;

    #[test]
    fn names_fit_into_a_path_and_a_line() {
        for name in ["x", "pad x", "µ_1", "b-2"] {
            assert!(is_plain_name(name), "{name:?}");
        }
        for name in ["", " ", "a ", "a.b", "a[0]", "a=1", "a,b", "a\nb", "a\tb", "a\u{1b}[31m"] {
            assert!(!is_plain_name(name), "{name:?}");
        }
    }
}
