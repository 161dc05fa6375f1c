//! Numbers of a study of a system: bare, with a unit, by a twin in SI, or as a formula of parameters.

use std::f64::consts::TAU;

use quell_model::digits::digits;
use quell_model::friction::expression::NumberFormula;
use quell_model::parameter::{Bounds, Parameter};
use quell_model::units::Quantity;
use quell_model::units::measure::{self, Unread};
use serde_json::Value as Json;

use super::keys::{SystemTable, system_keys, twin};
use super::units::SystemUnits;
use crate::complaint::{Complaint, Fault, Origin};
use crate::study::document::{Node, Table, Value};
use crate::study::reader::{Found, Reader};
use crate::study::suggest;
use crate::study::vocabulary::join;

/// The units of the file and the values of its parameters: what turns a value of the file into a number.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Numbers {
    pub(super) units: SystemUnits,
    pub(super) names: Vec<String>,
    pub(super) values: Vec<f64>,
}

/// A value is wrong, which has been reported.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Reported;

/// What a number must be.
#[derive(Clone, Copy, Debug)]
pub(super) struct WantedNumber {
    pub(super) quantity: Option<Quantity>,
    /// In the units of the file.
    pub(super) bounds: Bounds,
    /// Whether the key gives the number in SI.
    pub(super) twin: bool,
}

impl WantedNumber {
    /// Any finite number of a quantity.
    pub(super) fn finite(quantity: Option<Quantity>) -> Self {
        Self { quantity, bounds: Bounds::FINITE, twin: false }
    }

    /// A number of the registry.
    pub(super) fn of(parameter: Parameter) -> Self {
        Self { quantity: Some(parameter.quantity), bounds: parameter.bounds, twin: false }
    }
}

/// A key that was found, bare or as its twin in SI.
pub(super) struct Keyed<'t> {
    pub(super) node: &'t Node,
    pub(super) key: String,
    pub(super) twin: bool,
}

impl Numbers {
    /// The number of a node in the units of the file.
    pub(super) fn number(
        &self,
        reader: &mut Reader,
        key: impl Fn() -> String,
        node: &Node,
        wanted: WantedNumber,
    ) -> Option<f64> {
        match self.value(node, wanted) {
            Ok(value) if wanted.bounds.contains(value) => Some(value),
            // The parameter that is wrong has been reported.
            Ok(value) if value.is_nan() && self.values.iter().any(|known| known.is_nan()) => None,
            Ok(value) => {
                let is = match &node.value {
                    Value::Text(_) => format!("; its value is {}", digits(value, 6)),
                    _ => String::new(),
                };
                let unit = match self.unit(wanted) {
                    Some(unit) => format!(", in {unit}"),
                    None => String::new(),
                };
                reader.wrong(&key(), node, format!("{}{unit}{is}", wanted.bounds));
                None
            }
            Err(why) => {
                reader.wrong(&key(), node, format!("{}{why}", wanted.bounds));
                None
            }
        }
    }

    /// The number of a node in the units of the file, not checked against bounds.
    ///
    /// # Errors
    /// Why it is not a number, to be added to a sentence.
    pub(super) fn value(&self, node: &Node, wanted: WantedNumber) -> Result<f64, String> {
        let factor = self.file_units(wanted);
        match &node.value {
            Value::Number(number) => Ok(number * factor),
            Value::Text(text) => match self.measured(text, wanted) {
                Some(Ok(number)) => Ok(number * factor),
                Some(Err(why)) => Err(why),
                None => Ok(self.formula(text)? * factor),
            },
            _ => Err(format!("; got {}", node.kind())),
        }
    }

    /// The value of a formula.
    ///
    /// # Errors
    /// What is wrong with it.
    fn formula(&self, text: &str) -> Result<f64, String> {
        let names: Vec<&str> = self.names.iter().map(String::as_str).collect();
        let formula = NumberFormula::parse(text, &names)
            .map_err(|error| format!(", or a formula of parameters; {error}"))?;
        Ok(formula.value(&self.values))
    }

    /// A number with a unit, such as `5.7kN`, in the unit of its key; `None` if the text is something else.
    fn measured(&self, text: &str, wanted: WantedNumber) -> Option<Result<f64, String>> {
        if !measure::has_unit(text) {
            return None;
        }
        let unit = self.unit(wanted);
        if wanted.quantity == Some(Quantity::FrequencyRatio)
            && !wanted.twin
            && unit.is_some()
            && let Ok(hertz) = measure::read(text, Some("Hz"))
        {
            return Some(Ok(TAU * hertz));
        }
        match measure::read(text, unit) {
            Ok(number) => Some(Ok(number)),
            Err(Unread::NotANumber | Unread::UnknownUnit(_)) => None,
            Err(why @ Unread::NoUnitHere(_)) if self.units == SystemUnits::None => {
                Some(Err(format!("; {why}: units require system.units = \"SI\" or \"mm-t-s\"")))
            }
            Err(why) => Some(Err(format!("; {why}"))),
        }
    }

    /// Unit of the number that a key takes.
    fn unit(&self, wanted: WantedNumber) -> Option<&'static str> {
        match wanted.quantity? {
            Quantity::Ratio => Some("1"),
            quantity if wanted.twin => quantity.si_unit().map(|(unit, _)| unit),
            quantity => self.units.unit(quantity),
        }
    }

    /// The unit of a key in the units of the file.
    pub(super) fn file_units(&self, wanted: WantedNumber) -> f64 {
        match wanted.quantity.filter(|_| wanted.twin) {
            // A product rounds once more than a quotient: hertz are multiplied by 2π exactly as written.
            Some(Quantity::FrequencyRatio) => TAU,
            Some(quantity) => 1.0 / self.units.si_per_unit(quantity).unwrap_or(1.0),
            None => 1.0,
        }
    }

    /// A key of a table, or its twin in SI; both at once and twins without units are reported.
    pub(super) fn keyed<'t>(
        &self,
        reader: &mut Reader,
        table: &'t Table,
        prefix: &str,
        name: &str,
        other: Option<&str>,
    ) -> Option<Keyed<'t>> {
        let plain = table.get(name);
        let twin = other.and_then(|name| Some((name, table.get(name)?)));
        let Some((other, node)) = twin else {
            return plain.map(|node| Keyed { node, key: join(prefix, name), twin: false });
        };
        let key = join(prefix, other);
        if let Some(plain) = plain {
            let allowed = format!("give either {} or {key}, not both", join(prefix, name));
            reader.complain(Complaint::new(
                Fault::Conflict,
                key,
                node.origin,
                node.given(),
                allowed,
            ));
            return Some(Keyed { node: plain, key: join(prefix, name), twin: false });
        }
        if self.units == SystemUnits::None {
            let bare = join(prefix, name);
            let allowed = format!(
                "the study has no units, but {key} is in SI: use {bare}, or add system.units = \"SI\" or \"mm-t-s\""
            );
            let complaint = Complaint::new(Fault::Mixed, key, node.origin, node.given(), allowed);
            reader.complain(complaint.suggesting(Some(bare)));
            return None;
        }
        Some(Keyed { node, key, twin: true })
    }

    /// A number of the registry, if it is given.
    pub(super) fn optional(
        &self,
        reader: &mut Reader,
        table: &Table,
        prefix: &str,
        parameter: Parameter,
    ) -> Result<Option<f64>, Reported> {
        let other = parameter.si.first().map(|twin| twin.key);
        let before = reader.complaints_so_far();
        let found = self.keyed(reader, table, prefix, parameter.key(), other);
        let Some(Keyed { node, key, twin }) = found else {
            return if reader.complaints_so_far() == before { Ok(None) } else { Err(Reported) };
        };
        let wanted = WantedNumber { twin, ..WantedNumber::of(parameter) };
        self.number(reader, || key.clone(), node, wanted).map(Some).ok_or(Reported)
    }

    /// A required number of the registry.
    pub(super) fn needed(
        &self,
        reader: &mut Reader,
        table: &Table,
        prefix: &str,
        header: Origin,
        parameter: Parameter,
    ) -> Option<f64> {
        let found = self.optional(reader, table, prefix, parameter).ok()?;
        if found.is_none() {
            let Parameter { bounds, symbol, about, .. } = parameter;
            let or = match (self.units, parameter.si.first()) {
                (SystemUnits::None, _) | (_, None) => String::new(),
                (_, Some(twin)) => format!("; or {}", join(prefix, twin.key)),
            };
            let allowed = format!("{bounds} ({symbol}, {about}){or}");
            missing(reader, join(prefix, parameter.key()), header, allowed);
        }
        found
    }

    /// A row or matrix of a table: its node and whether it is in SI.
    pub(super) fn array<'t>(
        &self,
        reader: &mut Reader,
        table: &'t Table,
        prefix: &str,
        name: &str,
        quantity: Option<Quantity>,
    ) -> Option<Keyed<'t>> {
        let other = twin(name, quantity);
        self.keyed(reader, table, prefix, name, other.as_deref())
    }
}

/// The numbers of a table over time in a study of a system.
#[derive(Clone, Copy)]
pub(in crate::study) struct CourseNumbers<'a>(pub(super) &'a Numbers);

impl CourseNumbers<'_> {
    /// Whether the study has units, so that keys in SI are allowed.
    pub(in crate::study) fn has_units(self) -> bool {
        self.0.units != SystemUnits::None
    }

    /// The unit of a key in the units of the file.
    pub(in crate::study) fn factor(self, quantity: Quantity, twin: bool) -> f64 {
        self.0.file_units(WantedNumber { quantity: Some(quantity), bounds: Bounds::FINITE, twin })
    }

    /// A number of the registry in the units of the file, if it is given.
    pub(in crate::study) fn optional(
        self,
        reader: &mut Reader,
        table: &Table,
        prefix: &str,
        parameter: Parameter,
    ) -> Found {
        match self.0.optional(reader, table, prefix, parameter) {
            Ok(Some(value)) => Found::Value(value),
            Ok(None) => Found::Absent,
            Err(Reported) => Found::Wrong,
        }
    }

    /// A number in the units of the file.
    pub(in crate::study) fn number(
        self,
        reader: &mut Reader,
        key: &str,
        node: &Node,
        quantity: Quantity,
        bounds: Bounds,
        twin: bool,
    ) -> Option<f64> {
        let wanted = WantedNumber { quantity: Some(quantity), bounds, twin };
        self.0.number(reader, || key.to_owned(), node, wanted)
    }
}

/// Reports a missing key.
pub(super) fn missing(
    reader: &mut Reader,
    key: impl Into<String>,
    header: Origin,
    allowed: impl Into<String>,
) {
    reader.complain(Complaint::new(Fault::Missing, key, header, Json::Null, allowed));
}

/// Reports keys that a table of a system does not have.
pub(super) fn unknown_keys(reader: &mut Reader, table: &Table, prefix: &str, which: SystemTable) {
    let keys = system_keys(which);
    for (name, node) in table.iter() {
        let known = |key: &&super::keys::SystemKey| {
            key.name == name || key.twins().iter().any(|twin| twin == name)
        };
        if keys.iter().any(|key| known(&key)) {
            continue;
        }
        let there: Vec<&str> = keys.iter().map(|key| key.name).collect();
        let nearest = suggest::word(name, there.iter().copied());
        let complaint = Complaint::new(
            Fault::Unknown,
            join(prefix, name),
            node.origin,
            node.given(),
            there.join(", "),
        );
        reader.complain(complaint.suggesting(nearest.map(|name| join(prefix, &name))));
    }
}
