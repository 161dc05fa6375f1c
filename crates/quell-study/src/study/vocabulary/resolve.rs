//! Finds the key that a path names.

use quell_model::friction::expression;
use quell_model::parameter::DITHER_AMPLITUDE;

use super::key::{Key, Role, Section, join};
use super::keys::key;
use super::size::{DITHER_SIZES, SignalMeasure, SizedSignal, measure_of};
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

/// The path of the same number in a study in SI or in a dimensionless one; an unknown path is returned unchanged.
pub fn in_system(path: &str, si: bool) -> String {
    let Ok(address) = resolve(path) else {
        return path.to_owned();
    };
    let key = match (address.key.role, si) {
        (Role::Number(parameter), true) if !parameter.is_pure() => {
            parameter.si.iter().find(|twin| !twin.rms).map(|twin| twin.key)
        }
        (Role::Size(_, size), true) if size.signal == SizedSignal::Force => {
            Some(in_newtons(size.measure))
        }
        (Role::Size(_, size), false) if size.signal == SizedSignal::Newtons => {
            Some(without_units(size.measure))
        }
        (Role::Twin(_, twin), false) if twin.rms => Some(without_units(measure_of(twin))),
        (Role::Twin(parameter, _), false) => Some(parameter.key()),
        _ => None,
    };
    match (key, path.rsplit_once('.')) {
        (Some(key), Some((table, _))) => join(table, key),
        _ => path.to_owned(),
    }
}

/// The key of the amplitude of a dither in newtons.
fn in_newtons(measure: SignalMeasure) -> &'static str {
    let twin = DITHER_AMPLITUDE.si.iter().find(|twin| measure_of(**twin) == measure);
    let size = DITHER_SIZES
        .iter()
        .find(|size| size.signal == SizedSignal::Newtons && size.measure == measure);
    let key = twin.map(|twin| twin.key).or(size.map(|size| size.key));
    key.unwrap_or(DITHER_AMPLITUDE.path)
}

/// The key of the amplitude of a dither in a study without units.
fn without_units(measure: SignalMeasure) -> &'static str {
    let size = DITHER_SIZES
        .iter()
        .find(|size| size.signal == SizedSignal::Force && size.measure == measure);
    size.map_or("amplitude", |size| size.key)
}
