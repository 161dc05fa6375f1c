//! The number that a path names, in a study of any kind.

use super::address::{NumberAddress, units_of};
use super::document::Table;
use super::system::{keys, path};
use super::vocabulary::{self, Role, join};

/// What a path names in a document.
///
/// # Errors
/// The nearest path that names a number.
pub(super) fn resolve(document: &Table, path: &str) -> Result<NumberAddress, Option<String>> {
    if keys::is_described(document) {
        return path::resolve_in(document, path);
    }
    let address = vocabulary::resolve(path)?;
    let key = address.key;
    if !key.takes_number() {
        return Err(None);
    }
    let units = units_of(document);
    let index = address.index.unwrap_or(0);
    let name = match (key.role, key.parameter()) {
        (Role::Constant, _) => path.trim().rsplit('.').next().unwrap_or_default(),
        (_, Some(parameter)) => parameter.key(),
        (_, None) => key.name,
    };
    Ok(NumberAddress {
        number: join(&format!("{}[{index}]", key.section.path()), name),
        about: key.about,
        symbol: key.symbol(),
        quantity: key.parameter().map(|parameter| parameter.quantity),
        unit: key.unit_in_words(units),
        measured_in: key.measured_in(units),
    })
}
