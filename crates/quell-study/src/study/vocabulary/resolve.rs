//! Finds the key that a path names.

use quell_model::friction::expression;

use super::key::{Key, Role, Section};
use super::keys::key;
use crate::study::suggest;

/// The key of any named number of a formula.
static CONSTANT: Key = Key {
    section: Section::Constants,
    name: "NAME",
    role: Role::Constant,
    about: "a named number of the formula",
};

/// A key with the index of its table in a list.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Address {
    /// The key.
    pub key: &'static Key,
    /// Index of the `[[dither]]` or `[[sweep]]`, from 0, if given.
    pub index: Option<usize>,
}

/// Finds what a path such as `dither[1].amplitude_n` names.
///
/// # Errors
/// The nearest existing path, if any is close enough.
pub fn resolve(path: &str) -> Result<Address, Option<String>> {
    let path = path.trim();
    let (table, name) = path.rsplit_once('.').unwrap_or(("", path));
    let (table, index) = match table.split_once('[') {
        Some((table, rest)) => match rest.strip_suffix(']').and_then(|text| text.parse().ok()) {
            Some(index) => (table, Some(index)),
            None => return Err(None),
        },
        None => (table, None),
    };
    let section = Section::ALL.iter().copied().find(|section| section.path() == table);
    if section == Some(Section::Constants) && index.is_none() && expression::is_name(name) {
        return Ok(Address { key: &CONSTANT, index: None });
    }
    let listed = matches!(
        section,
        Some(Section::Dither | Section::Sweep | Section::DiscMode | Section::DiscLoad)
    );
    let found = section.and_then(|section| key(section, name));
    match found {
        Some(key) if listed || index.is_none() => Ok(Address { key, index }),
        _ => Err(suggest::path(table, name, index)),
    }
}

/// The path that gives the same number in a study with units: a frequency ratio is given in hertz, and other paths are unchanged.
pub fn with_unit(path: &str) -> String {
    match path.strip_suffix("frequency_ratio") {
        Some(table) => format!("{table}frequency_hz"),
        None => path.to_owned(),
    }
}
