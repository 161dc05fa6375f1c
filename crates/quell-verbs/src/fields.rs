//! Fields of a result in JSON: names, values in the units of the study, and reasons for null values.
//!
//! `units` contains the unit of every field, and `why` the reason for every null.

use std::fmt::Display;

use crate::study::UnitSystem;
use quell_model::units::Quantity;
use serde_json::{Map, Value as Json};

/// The unit of a slope per unit velocity of a study without units.
pub(crate) const PER_VELOCITY: &str = "1/length (per velocity/ω₀)";

/// The unit of a rate of a system.
pub fn rate_unit(units: UnitSystem) -> &'static str {
    match units {
        UnitSystem::None => "1 (per unit of time)",
        // Both systems of units have the second.
        _ => "1/s",
    }
}

/// An object under construction.
#[derive(Clone, Debug, Default)]
pub struct Fields {
    /// The units of the study; `None` of numbers that belong to no study, or to the equations of a disc.
    study: Option<UnitSystem>,
    object: Map<String, Json>,
    units: Map<String, Json>,
    why: Map<String, Json>,
}

impl Fields {
    /// An empty object for numbers that belong to no study, or to the equations of a disc.
    pub fn new() -> Self {
        Self { study: None, object: Map::new(), units: Map::new(), why: Map::new() }
    }

    /// An empty object for a study in these units.
    pub fn in_units(units: UnitSystem) -> Self {
        Self { study: Some(units), ..Self::new() }
    }

    /// Adds a word, a flag, a count, or any other value without unit.
    pub fn plain(&mut self, name: &str, value: impl Into<Json>) -> &mut Self {
        self.object.insert(name.to_owned(), value.into());
        self
    }

    /// Adds null, with the reason.
    pub fn unknown(&mut self, name: &str, why: impl Display) -> &mut Self {
        self.plain(name, Json::Null).why(name, why)
    }

    /// Adds a value without unit, or null with the reason.
    pub fn known_plain(
        &mut self,
        name: &str,
        value: Result<impl Into<Json>, impl Display>,
    ) -> &mut Self {
        match value {
            Ok(value) => self.plain(name, value),
            Err(why) => self.unknown(name, why),
        }
    }

    /// Adds a value, or an array of values, with its unit.
    pub fn measured(&mut self, name: &str, unit: &str, value: impl Into<Json>) -> &mut Self {
        self.units.insert(name.to_owned(), unit.into());
        self.plain(name, value)
    }

    /// Adds a quantity.
    pub fn number(&mut self, name: &str, quantity: Quantity, value: f64) -> &mut Self {
        self.known(name, quantity, Ok::<_, &str>(value))
    }

    /// Adds a quantity, or null with the reason.
    pub fn known(
        &mut self,
        name: &str,
        quantity: Quantity,
        value: Result<f64, impl Display>,
    ) -> &mut Self {
        self.units.insert(name.to_owned(), self.unit(quantity).into());
        self.finite(name, value)
    }

    /// Adds an array of a quantity; values that are not finite become null.
    pub fn numbers(&mut self, name: &str, quantity: Quantity, values: &[f64]) -> &mut Self {
        self.measured(name, self.unit(quantity), values.to_vec())
    }

    /// Adds an array of slopes per unit velocity.
    pub fn per_velocity(&mut self, name: &str, values: &[f64]) -> &mut Self {
        self.numbers(name, Quantity::PerVelocity, values);
        if self.study.is_none() {
            self.units.insert(name.to_owned(), PER_VELOCITY.into());
        }
        self
    }

    /// Adds rates; null with the reason for a missing value.
    pub fn rates(&mut self, name: &str, values: &[Option<f64>], why: &str) -> &mut Self {
        self.measured(name, self.rate_unit(), values.to_vec());
        if values.contains(&None) {
            self.why(name, why);
        }
        for (index, _) in values.iter().enumerate().filter(|(_, value)| value.is_none()) {
            self.why(&format!("{name}[{index}]"), why);
        }
        self
    }

    /// The unit of a rate.
    fn rate_unit(&self) -> &'static str {
        self.study.map_or("ω₀", rate_unit)
    }

    /// Adds a growth rate.
    pub fn rate(&mut self, name: &str, value: f64) -> &mut Self {
        self.known_rate(name, Ok::<_, &str>(value))
    }

    /// Adds a growth rate, or null with the reason.
    pub fn known_rate(&mut self, name: &str, value: Result<f64, impl Display>) -> &mut Self {
        self.units.insert(name.to_owned(), self.rate_unit().into());
        self.finite(name, value)
    }

    /// Adds a finite value, or null with the reason.
    fn finite(&mut self, name: &str, value: Result<f64, impl Display>) -> &mut Self {
        let finite =
            |value: f64| if value.is_finite() { Ok(value) } else { Err(beyond_range(value)) };
        self.known_plain(name, value.map_err(|why| why.to_string()).and_then(finite))
    }

    /// Adds a growth rate in decibels per second, of a study in SI.
    pub fn decibels(&mut self, name: &str, value: f64) -> &mut Self {
        self.units.insert(name.to_owned(), "dB/s".into());
        self.plain(name, value)
    }

    /// Adds an object inside this one.
    pub fn nested(&mut self, name: &str, inner: Self) -> &mut Self {
        let object = self.take(name, inner);
        self.object.insert(name.to_owned(), Json::Object(object));
        self
    }

    /// Adds an array of objects.
    pub fn list(&mut self, name: &str, items: impl IntoIterator<Item = Self>) -> &mut Self {
        let items: Vec<Json> = items
            .into_iter()
            .enumerate()
            .map(|(index, item)| Json::Object(self.take(&format!("{name}[{index}]"), item)))
            .collect();
        self.object.insert(name.to_owned(), items.into());
        self
    }

    /// Adds the reason why an element `name[index]` is null; for a whole field see [`Fields::unknown`].
    pub fn why(&mut self, name: &str, why: impl Display) -> &mut Self {
        self.why.insert(name.to_owned(), why.to_string().into());
        self
    }

    /// The finished object, with `units` and `why`.
    pub fn finish(mut self) -> Json {
        if self.study.is_some() {
            let lists = self.object.iter().flat_map(|(name, value)| arrays(name, value));
            let without: Vec<String> = lists.filter(|path| !self.why.contains_key(path)).collect();
            for path in without {
                self.why.insert(path, NOT_FINITE.into());
            }
        }
        if !self.units.is_empty() {
            self.object.insert("units".to_owned(), Json::Object(self.units));
        }
        if !self.why.is_empty() {
            self.object.insert("why".to_owned(), Json::Object(self.why));
        }
        Json::Object(self.object)
    }

    /// The unit of a quantity in a study with units; `None` in others, and of a ratio.
    pub fn unit_of_study(&self, quantity: Quantity) -> Option<&'static str> {
        quantity.si_unit().and(self.study?.unit(quantity))
    }

    /// The unit of a quantity.
    fn unit(&self, quantity: Quantity) -> &'static str {
        match self.study {
            Some(units) => units.unit(quantity).unwrap_or("1"),
            None => quantity.scaled_unit(),
        }
    }

    /// Adopts the units and reasons of an inner object, and returns its fields. A name that has another unit there is written with its
    /// object: `voltage.peak`.
    fn take(&mut self, path: &str, inner: Self) -> Map<String, Json> {
        let object = path.split('[').next().unwrap_or_default();
        for (name, unit) in inner.units {
            match self.units.get(&name) {
                Some(known) if *known == unit => {}
                Some(_) => _ = self.units.insert(format!("{object}.{name}"), unit),
                None => _ = self.units.insert(name, unit),
            }
        }
        for (name, why) in inner.why {
            self.why.insert(format!("{path}.{name}"), why);
        }
        inner.object
    }
}

/// The unit of the field `key` at a path that ends with it: of the longest end of the path that has one, and no part of a key such as
/// `dither.amplitude`.
pub fn unit_at<'u>(units: &'u Map<String, Json>, path: &str, key: &str) -> Option<&'u str> {
    let ends = path.match_indices('.').map(|(at, _)| &path[at + 1..]);
    let ends = [path].into_iter().chain(ends).take_while(|end| end.len() > key.len());
    ends.chain([key]).find_map(|end| units.get(end)?.as_str())
}

/// Why a number that is not finite is null.
const NOT_FINITE: &str = "a value is beyond the range of floating-point numbers";

fn beyond_range(value: f64) -> String {
    format!("the value is {value}: it is beyond the range of floating-point numbers")
}

/// Paths of the arrays of numbers that have nulls, at or below a path: values that are not finite.
fn arrays(path: &str, value: &Json) -> Vec<String> {
    match value {
        Json::Object(inner) => {
            let inner = inner.iter().filter(|(name, _)| *name != "why");
            inner.flat_map(|(name, value)| arrays(&format!("{path}.{name}"), value)).collect()
        }
        Json::Array(items) if items.iter().any(Json::is_object) => {
            let items = items.iter().enumerate().filter(|(_, item)| has_null(item));
            items.flat_map(|(index, item)| arrays(&format!("{path}[{index}]"), item)).collect()
        }
        Json::Array(_) if has_null(value) => vec![path.to_owned()],
        _ => Vec::new(),
    }
}

fn has_null(value: &Json) -> bool {
    match value {
        Json::Array(items) => items.iter().any(has_null),
        Json::Object(inner) => inner.values().any(has_null),
        value => value.is_null(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn a_name_with_two_units_has_both() {
        let mut fields = Fields::new();
        for (name, unit) in [("force", "N"), ("voltage", "V")] {
            let mut inner = Fields::new();
            inner.measured("peak", unit, 1.0);
            fields.nested(name, inner);
        }
        let units = &fields.finish()["units"];
        assert_eq!((&units["peak"], &units["voltage.peak"]), (&json!("N"), &json!("V")));
        let at = |path: &str, key: &str| unit_at(units.as_object().expect("units"), path, key);
        assert_eq!(at("drive.voltage.peak", "peak"), Some("V"));
        assert_eq!(at("drive.force.peak", "peak"), Some("N"));
        assert_eq!(at("critical.dither.peak", "dither.peak"), None);
    }

    #[test]
    fn a_study_in_si_has_its_numbers_in_si() {
        let mut fields = Fields::in_units(UnitSystem::Si);
        fields.number("time", Quantity::Time, 3.0).number("stick_fraction", Quantity::Ratio, 0.5);
        let mut inner = Fields::in_units(UnitSystem::Si);
        inner.known("residual_vibration", Quantity::Ratio, Err("nothing to quench"));
        fields.list("points", [inner]);
        let json = fields.finish();
        assert_eq!(json["time"], 3.0);
        assert_eq!(json["units"]["time"], "s");
        assert!(json.get("time_s").is_none());
        assert_eq!(json["units"]["stick_fraction"], "1");
        assert!(json["points"][0]["residual_vibration"].is_null());
        assert_eq!(json["why"]["points[0].residual_vibration"], "nothing to quench");
        assert!(json.get("stick_fraction_1").is_none());
    }

    #[test]
    fn values_that_are_not_finite_are_null_with_a_reason() {
        let mut fields = Fields::new();
        fields.number("growth", Quantity::Ratio, f64::NAN);
        let json = fields.finish();
        assert!(json["growth"].is_null() && json["why"]["growth"].is_string());
        assert!(json.get("growth_s").is_none());
    }
}
