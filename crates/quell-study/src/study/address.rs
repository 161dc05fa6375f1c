//! The number of a study that a path names, and the units of a study before it is read.

use quell_input::document::{Node, Table, Value};
use quell_model::units::{Quantity, UnitSystem};

use super::belt::units::belt_units;
use super::vocabulary::UNITS;

/// The number of a study that a path names.
#[derive(Clone, Debug, PartialEq)]
pub struct NumberAddress {
    /// The number, however it is written: the same for every path and key that give it.
    pub number: String,
    /// Description, in one line.
    pub about: &'static str,
    /// Symbol in the equations, if it is a number of the registry.
    pub symbol: Option<&'static str>,
    /// Its quantity, if it has one.
    pub quantity: Option<Quantity>,
    /// Unit of its value in words; `1` without a unit.
    pub unit: &'static str,
    /// The unit to which a value with a unit, such as `5.7kN`, is converted; `None` where none can be.
    pub measured_in: Option<&'static str>,
}

/// The units of the bare numbers of a document.
pub(super) fn units_of(document: &Table) -> UnitSystem {
    let named = |table: &str| {
        let table = document.get(table).and_then(Node::table)?;
        match table.get(UNITS).map(|node| &node.value) {
            Some(Value::Text(name)) => UnitSystem::from_name(name),
            _ => None,
        }
    };
    let given = ["belt", "disc", "system"].into_iter().find_map(named);
    given.unwrap_or_else(|| belt_units(document))
}
