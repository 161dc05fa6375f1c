//! Numbers: bare in the units of the study, quoted with a unit, by a key with the unit as a suffix, or as a formula of parameters.

use quell_input::complaint::{Complaint, Fault, Origin};
use quell_input::document::{Node, Table, Value};
use quell_input::said::Said;
use quell_model::digits::digits;
use quell_model::friction::expression::NumberFormula;
use quell_model::parameter::{Bounds, Parameter};
use quell_model::units::Quantity;
use quell_model::units::measure::{self, Unread};
use serde_json::Value as Json;

use super::Reader;
use super::no_number::NoNumber;
use super::units::EquationScale;
use crate::study::vocabulary::{KeyUnit, join};

/// The result of reading the keys of a parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::study) enum Found {
    /// A valid value, in the numbers of the equations.
    Value(f64),
    /// An invalid value, already reported.
    Wrong,
    /// No value.
    Absent,
}

impl Found {
    /// The value, or the default if absent.
    pub(in crate::study) fn or(self, default: f64) -> Option<f64> {
        self.if_given().map(|value| value.unwrap_or(default))
    }

    /// The value, `Some(None)` if absent, `None` if it is wrong.
    #[expect(clippy::option_option, reason = "invalid, absent, given")]
    pub(in crate::study) fn if_given(self) -> Option<Option<f64>> {
        match self {
            Self::Value(value) => Some(Some(value)),
            Self::Absent => Some(None),
            Self::Wrong => None,
        }
    }
}

/// What a number must be.
#[derive(Clone, Copy, Debug)]
pub(in crate::study) struct WantedNumber {
    /// What it measures; `None` for a number without a unit.
    pub(in crate::study) quantity: Option<Quantity>,
    /// The values that are allowed, in the numbers of the equations.
    pub(in crate::study) bounds: Bounds,
    /// The unit of its key.
    pub(in crate::study) unit: KeyUnit,
}

impl WantedNumber {
    /// Any finite number of a quantity in the unit of the study.
    pub(in crate::study) fn finite(quantity: Option<Quantity>) -> Self {
        Self { quantity, bounds: Bounds::FINITE, unit: KeyUnit::Study }
    }

    /// A number of the registry by one of its keys.
    pub(in crate::study) fn of(parameter: Parameter, key: &str) -> Self {
        let Parameter { quantity, bounds, .. } = parameter;
        Self { quantity: Some(quantity), bounds, unit: KeyUnit::of(parameter, key) }
    }
}

/// A key that was found.
pub(in crate::study) struct Keyed<'t> {
    pub(in crate::study) node: &'t Node,
    pub(in crate::study) key: String,
    pub(in crate::study) unit: KeyUnit,
}

impl Reader {
    /// A number of the registry, by any of its keys.
    pub(in crate::study) fn optional(
        &mut self,
        table: &Table,
        prefix: &str,
        parameter: Parameter,
    ) -> Found {
        let mut given = parameter.keys().filter_map(|key| Some((key, table.get(key)?)));
        let Some((name, node)) = given.next() else { return Found::Absent };
        if let Some((other, node)) = given.next() {
            self.not_both(&join(prefix, name), &join(prefix, other), node);
            return Found::Wrong;
        }
        let wanted = WantedNumber::of(parameter, name);
        let key = || join(prefix, name);
        if !self.may_have(wanted.unit) {
            self.without_units(&key(), node, Some(join(prefix, parameter.key())));
            return Found::Wrong;
        }
        let Some(value) = self.quantity(key, node, wanted) else { return Found::Wrong };
        if !self.units().is_of_the_file() {
            let of_one = self.units().written_per_one(parameter.quantity, wanted.unit);
            let names = (parameter.key(), name);
            self.remember(prefix, names, node.origin, of_one.unwrap_or(1.0));
        }
        Found::Value(value)
    }

    /// A required number of the registry.
    pub(in crate::study) fn number(
        &mut self,
        table: &Table,
        prefix: &str,
        header: Origin,
        parameter: Parameter,
    ) -> Option<f64> {
        let found = self.optional(table, prefix, parameter);
        if found == Found::Absent {
            self.missing_number(prefix, header, parameter);
        }
        found.if_given().flatten()
    }

    /// Reports a number that is missing, with all keys that could give it.
    pub(in crate::study) fn missing_number(
        &mut self,
        prefix: &str,
        header: Origin,
        parameter: Parameter,
    ) {
        let Parameter { bounds, quantity, .. } = parameter;
        let own = KeyUnit::of(parameter, parameter.key());
        let unit = self.unit_of(Some(quantity), own).filter(|unit| *unit != "1");
        let named = parameter.si.iter().find_map(|other| other.own).filter(|_| unit.is_some());
        let (symbol, about) = named.unwrap_or((parameter.symbol, parameter.about));
        let others = parameter.si.iter().filter(|_| self.units().take_suffixes());
        let others: Vec<String> = others.map(|other| join(prefix, other.key)).collect();
        let others = if others.is_empty() {
            String::new()
        } else {
            format!("; or {}", others.join(", or "))
        };
        let unit = unit.map_or_else(String::new, |unit| format!(", in {unit}"));
        let allowed = format!("{bounds}{unit} ({symbol}, {about}){others}");
        self.missing(join(prefix, parameter.key()), header, allowed);
    }

    /// Reports the second of two keys for the same number.
    pub(in crate::study) fn not_both(&mut self, first: &str, second: &str, node: &Node) {
        let allowed = format!("give either {first} or {second}, not both");
        let given = node.given();
        self.complain(Complaint::new(Fault::Conflict, second, node.origin, given, allowed));
    }

    /// Reports a missing key.
    pub(in crate::study) fn missing(
        &mut self,
        key: impl Into<String>,
        header: Origin,
        allowed: impl Into<Said>,
    ) {
        self.complain(Complaint::new(Fault::Missing, key, header, Json::Null, allowed));
    }

    /// A list, row or matrix of a quantity, by its key or by the key with the suffix of the SI unit.
    pub(in crate::study) fn keyed<'t>(
        &mut self,
        table: &'t Table,
        prefix: &str,
        name: &str,
        quantity: Option<Quantity>,
    ) -> Result<Option<Keyed<'t>>, Reported> {
        let suffixed = quantity.and_then(|quantity| suffixed(name, quantity));
        let other = suffixed.as_ref().and_then(|(name, unit)| Some((name, unit, table.get(name)?)));
        let plain = table.get(name);
        match (plain, other) {
            (Some(_), Some((other, _, node))) => {
                self.not_both(&join(prefix, name), &join(prefix, other), node);
                Err(Reported)
            }
            (Some(node), None) => {
                Ok(Some(Keyed { node, key: join(prefix, name), unit: KeyUnit::Study }))
            }
            (None, Some((other, unit, node))) => {
                let key = join(prefix, other);
                if !self.units().take_suffixes() {
                    self.without_units(&key, node, Some(join(prefix, name)));
                    return Err(Reported);
                }
                Ok(Some(Keyed { node, key, unit: KeyUnit::Suffix(unit) }))
            }
            (None, None) => Ok(None),
        }
    }

    /// The number of a node in the numbers of the equations; `None` if it is wrong, which has been reported.
    pub(in crate::study) fn quantity(
        &mut self,
        key: impl Fn() -> String,
        node: &Node,
        wanted: WantedNumber,
    ) -> Option<f64> {
        let written = match self.written(node, wanted) {
            Ok(written) => written,
            Err(why) => {
                let allowed = format!("{}{why}", self.range(wanted));
                self.wrong(&key(), node, allowed);
                return None;
            }
        };
        let (number, unit) = written;
        // The parameter that is wrong has been reported.
        if number.is_nan() && self.named.has_wrong() {
            return None;
        }
        let value = wanted
            .quantity
            .map_or(Some(number), |quantity| self.units().in_equations(number, quantity, unit));
        let whole = wanted.quantity != Some(Quantity::Count) || number.fract() == 0.0;
        let within = match value {
            Some(value) => wanted.bounds.contains(value),
            // Without scales the sign can still be checked.
            None => number.is_finite() && wanted.bounds.has_sign_of(number),
        };
        if !(whole && within) {
            let is = match &node.value {
                Value::Text(text) if !measure::has_unit(text) => {
                    format!("; its value is {}", digits(number, 6))
                }
                _ => String::new(),
            };
            let allowed = format!("{}{is}", self.range(wanted));
            self.wrong(&key(), node, allowed);
            return None;
        }
        if value.is_none() && unit == KeyUnit::Ratio {
            let allowed = "a frequency instead, such as dither.frequency: only a system of one coordinate with a spring has a natural \
                           frequency to which a ratio refers";
            self.wrong(&key(), node, allowed);
        } else if value.is_none() {
            self.without_units(&key(), node, None);
        }
        value
    }

    /// The number of a node as it is written, if it is one; nothing is reported.
    pub(in crate::study) fn number_of(&self, node: &Node, quantity: Quantity) -> Option<f64> {
        self.written(node, WantedNumber::finite(Some(quantity))).ok().map(|(number, _)| number)
    }

    /// A finite number within bounds, in `unit` if it is not empty: one that is no number of the equations.
    pub(in crate::study) fn within(
        &mut self,
        key: &str,
        node: &Node,
        bounds: Bounds,
        unit: &'static str,
        whole: bool,
    ) -> Option<f64> {
        let quantity = if whole { Some(Quantity::Count) } else { None };
        let unit = if unit.is_empty() { KeyUnit::Study } else { KeyUnit::Suffix(unit) };
        self.quantity(|| key.to_owned(), node, WantedNumber { quantity, bounds, unit })
    }

    /// What is allowed, in the unit of the key.
    fn range(&self, wanted: WantedNumber) -> String {
        let WantedNumber { quantity, bounds, unit } = wanted;
        let of_one =
            quantity.map_or(Some(1.0), |quantity| self.units().written_per_one(quantity, unit));
        // Without its scales only the sign of an end is known.
        let size = |end: f64| match of_one {
            _ if end == 0.0 => end,
            Some(of_one) => end * of_one,
            None => f64::INFINITY.copysign(end),
        };
        let bounds = Bounds { lower: size(bounds.lower), upper: size(bounds.upper), ..bounds };
        let text = bounds.to_string();
        let text = if quantity == Some(Quantity::Count) {
            text.replacen("number", "whole number", 1)
        } else {
            text
        };
        match self.unit_of(quantity, unit) {
            None | Some("1") => text,
            Some(unit) => format!("{text}, in {unit}"),
        }
    }

    /// Unit of a number by a key, if it has one.
    fn unit_of(&self, quantity: Option<Quantity>, unit: KeyUnit) -> Option<&'static str> {
        match (quantity, unit) {
            (_, KeyUnit::Suffix(unit)) => Some(unit),
            (_, KeyUnit::Ratio) | (Some(Quantity::Ratio), _) => Some("1"),
            (Some(Quantity::Angle), KeyUnit::Study) => Some("rad"),
            (Some(quantity), KeyUnit::Study) => {
                quantity.own_unit().or_else(|| self.units().file.unit(quantity))
            }
            (None, KeyUnit::Study) => None,
        }
    }

    /// The number that a node gives, and the unit in which it gives it.
    fn written(&self, node: &Node, wanted: WantedNumber) -> Result<(f64, KeyUnit), NoNumber> {
        let kind = || NoNumber::OtherKind(node.kind());
        match &node.value {
            Value::Number(number) => Ok((*number, wanted.unit)),
            Value::Text(text) => match self.measured(text, wanted) {
                Some(Ok(written)) => Ok(written),
                Some(Err(why)) => Err(why),
                None if self.units().is_of_the_file() => Ok((self.formula(text)?, wanted.unit)),
                None if text.trim().parse::<f64>().is_ok() => Err(NoNumber::Quoted(node.kind())),
                None => Err(kind()),
            },
            _ => Err(kind()),
        }
    }

    /// The value of a formula of parameters.
    fn formula(&self, text: &str) -> Result<f64, NoNumber> {
        let names: Vec<&str> = self.named.names.iter().map(String::as_str).collect();
        let formula = NumberFormula::parse(text, &names).map_err(NoNumber::Formula)?;
        Ok(formula.value(&self.named.values))
    }

    /// A number with a unit, such as `5.7kN`, and the unit to which it is converted; `None` if the text is something else.
    fn measured(
        &self,
        text: &str,
        wanted: WantedNumber,
    ) -> Option<Result<(f64, KeyUnit), NoNumber>> {
        if !measure::has_unit(text) {
            return None;
        }
        let units = self.units();
        // Frequencies are also given in cycles, and SI stands for the units of a study that has scales alone.
        let other = wanted.quantity.filter(|_| wanted.unit == KeyUnit::Study);
        let other = other.and_then(Quantity::si_unit).map(|(unit, _)| unit);
        let other = other.filter(|unit| *unit == "Hz" || units.file.is_none());
        if let Some(unit) = other.filter(|_| units.take_suffixes())
            && let Ok(number) = measure::read(text, Some(unit))
        {
            return Some(Ok((number, KeyUnit::Suffix(unit))));
        }
        let unit = self.unit_of(wanted.quantity, wanted.unit);
        match measure::read(text, unit) {
            Ok(number) => Some(Ok((number, wanted.unit))),
            Err(Unread::NotANumber | Unread::UnknownUnit(_)) if units.is_of_the_file() => None,
            Err(why @ Unread::NoUnitHere(_)) if !units.take_suffixes() => {
                Some(Err(NoNumber::NoUnits { why, needed: units.needed() }))
            }
            Err(why) => Some(Err(NoNumber::Unit(why))),
        }
    }

    /// Whether a key with this unit can be read.
    fn may_have(&self, unit: KeyUnit) -> bool {
        match unit {
            KeyUnit::Suffix(_) => self.units().take_suffixes(),
            KeyUnit::Study | KeyUnit::Ratio => true,
        }
    }

    /// Reports a number with a unit in a study that has neither units nor the scales for it; `plain` is the key without the unit.
    pub(in crate::study) fn without_units(
        &mut self,
        key: &str,
        node: &Node,
        plain: Option<String>,
    ) {
        let units = self.units();
        let of_a_disc = matches!(units.scale, EquationScale::Disc(_));
        // What is wrong with the scales of a study with units has been reported.
        if !units.file.is_none() && !of_a_disc {
            return;
        }
        let without = plain.as_ref().map(|plain| format!("{plain}, without a unit, or "));
        let (fault, is) = if of_a_disc {
            (Fault::Conflict, "what its unit is worth is not known")
        } else {
            (Fault::Mixed, "the study is dimensionless")
        };
        let allowed = format!("{}{}: {is}", without.unwrap_or_default(), units.needed());
        let complaint = Complaint::new(fault, key, node.origin, node.given(), allowed);
        self.complain(complaint.suggesting(plain.filter(|_| !of_a_disc)));
    }
}

/// A value is wrong, which has been reported.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::study) struct Reported;

/// The key of a quantity with the suffix of its SI unit, and the unit.
pub(in crate::study) fn suffixed(name: &str, quantity: Quantity) -> Option<(String, &'static str)> {
    let (unit, suffix) = quantity.si_unit()?;
    Some((format!("{name}_{suffix}"), unit))
}

/// Numbers that formulas use by name; those that are wrong are NaN.
#[derive(Clone, Debug, Default, PartialEq)]
pub(in crate::study) struct NumbersByName {
    pub(in crate::study) names: Vec<String>,
    pub(in crate::study) values: Vec<f64>,
}

impl NumbersByName {
    fn has_wrong(&self) -> bool {
        self.values.iter().any(|value| value.is_nan())
    }
}
