//! What a path of a study of a system leads to.

use quell_model::parameter::Parameter;
use quell_model::units::Quantity;

use crate::study::document::{Node, Table, Value};
use crate::study::reader::{KeyUnit, WantedNumber};
use crate::study::vocabulary::size::{DITHER_SIZES, SizedSignal};

/// A step from a value of the document to one inside it.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum PathStep {
    Key(String),
    Index(usize),
}

/// A path that was followed to its end.
#[derive(Debug)]
pub(super) struct FoundPath {
    pub(super) steps: Vec<PathStep>,
    pub(super) about: &'static str,
    pub(super) parameter: Option<Parameter>,
    pub(super) quantity: Option<Quantity>,
    pub(super) twin: bool,
    pub(super) is_number: bool,
    /// Keys of the same table that the value replaces.
    pub(super) replaces: Vec<String>,
}

impl FoundPath {
    /// The unit of the key at its end.
    pub(super) fn unit(&self) -> KeyUnit {
        match self.steps.last() {
            Some(PathStep::Key(name)) => self.unit_of(name),
            _ if self.twin => self.suffix(),
            _ => KeyUnit::Study,
        }
    }

    /// The unit of another key of the same number.
    pub(super) fn unit_of(&self, name: &str) -> KeyUnit {
        match self.parameter {
            Some(parameter) if parameter.keys().any(|key| key == name) => {
                WantedNumber::of(parameter, name).unit
            }
            _ if DITHER_SIZES
                .iter()
                .any(|size| size.key == name && size.signal == SizedSignal::Newtons) =>
            {
                self.suffix()
            }
            _ if self.twin => self.suffix(),
            _ => KeyUnit::Study,
        }
    }

    fn suffix(&self) -> KeyUnit {
        let unit = self.quantity.and_then(Quantity::si_unit);
        unit.map_or(KeyUnit::Study, |(unit, _)| KeyUnit::Suffix(unit))
    }

    /// The value at its end.
    pub(super) fn node<'d>(&self, document: &'d Table) -> Option<&'d Node> {
        node_at(document, &self.steps)
    }
}

/// The value at the end of these steps.
pub(super) fn node_at<'d>(document: &'d Table, steps: &[PathStep]) -> Option<&'d Node> {
    let (PathStep::Key(first), rest) = steps.split_first()? else { return None };
    let mut node = document.get(first)?;
    for step in rest {
        node = match (&node.value, step) {
            (Value::Table(table), PathStep::Key(name)) => table.get(name)?,
            (Value::List(list), PathStep::Index(index)) => list.get(*index)?,
            _ => return None,
        };
    }
    Some(node)
}

/// A path that leads nowhere.
#[derive(Debug, Default)]
pub(super) struct LostPath {
    /// The nearest path.
    pub(super) nearest: Option<String>,
    /// What is wrong, if more is known than that the path does not exist.
    pub(super) allowed: Option<String>,
}

impl LostPath {
    pub(super) fn because(allowed: impl Into<String>) -> Self {
        Self { allowed: Some(allowed.into()), ..Self::default() }
    }
}
