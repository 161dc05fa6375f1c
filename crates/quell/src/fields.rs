//! Fields of a result in JSON: names, units, SI twins, and why something is null.
//!
//! In a study in SI each field `x` stands beside its twin with the suffix of its unit
//! (`time`, `time_s`). `units` names the unit of every field; `why` says for every null why
//! it is one.

use crate::quantity::unit_of;
use quell_model::units::{Quantity, Scales};
use serde_json::{Map, Value as Json};

/// A slope per unit velocity: its unit, its SI unit, and the suffix for that.
pub(crate) const PER_VELOCITY: (&str, &str, &str) =
    ("1/length (per velocity/ω₀)", "s/m", "s_per_m");

/// An object under construction.
#[derive(Clone, Debug)]
pub struct Fields {
    scales: Option<Scales>,
    object: Map<String, Json>,
    units: Map<String, Json>,
    why: Map<String, Json>,
}

impl Fields {
    /// An empty object for a study with these scales.
    pub fn new(scales: Option<Scales>) -> Self {
        Self { scales, object: Map::new(), units: Map::new(), why: Map::new() }
    }

    /// The scales of the study.
    pub fn scales(&self) -> Option<Scales> {
        self.scales
    }

    /// A word, a flag, a count, or anything else without unit.
    pub fn plain(&mut self, name: &str, value: impl Into<Json>) -> &mut Self {
        self.object.insert(name.to_owned(), value.into());
        self
    }

    /// Null, and why.
    pub fn unknown(&mut self, name: &str, why: impl Into<String>) -> &mut Self {
        self.plain(name, Json::Null).why(name, why)
    }

    /// A quantity, with its SI twin in a study in SI.
    pub fn number(&mut self, name: &str, quantity: Quantity, value: f64) -> &mut Self {
        self.known(name, quantity, Ok(value))
    }

    /// A quantity, or null and why.
    pub fn known(
        &mut self,
        name: &str,
        quantity: Quantity,
        value: Result<f64, String>,
    ) -> &mut Self {
        let value = value.and_then(|value| {
            if value.is_finite() { Ok(value) } else { Err(format!("the value is {value}")) }
        });
        let twin = self.twin(name, quantity);
        self.name_units(name, quantity, twin.as_ref());
        match value {
            Ok(value) => {
                self.object.insert(name.to_owned(), value.into());
                if let Some((key, factor, _)) = twin {
                    self.object.insert(key, (value * factor).into());
                }
            }
            Err(why) => {
                self.unknown(name, why);
                if let Some((key, ..)) = twin {
                    self.object.insert(key, Json::Null);
                }
            }
        }
        self
    }

    /// An array of a quantity; what is not finite becomes null.
    pub fn numbers(&mut self, name: &str, quantity: Quantity, values: &[f64]) -> &mut Self {
        let twin = self.twin(name, quantity);
        self.name_units(name, quantity, twin.as_ref());
        self.object.insert(name.to_owned(), values.into());
        if let Some((key, factor, _)) = twin {
            let values: Vec<f64> = values.iter().map(|value| value * factor).collect();
            self.object.insert(key, values.into());
        }
        self
    }

    /// An array of slopes per unit velocity, in SI per m/s.
    pub fn per_velocity(&mut self, name: &str, values: &[f64]) -> &mut Self {
        self.object.insert(name.to_owned(), values.into());
        self.units.insert(name.to_owned(), PER_VELOCITY.0.into());
        if let Some(scales) = self.scales {
            let (_, unit, suffix) = PER_VELOCITY;
            let omega = scales.si_per_unit(Quantity::Velocity);
            let values: Vec<f64> = values.iter().map(|value| value / omega).collect();
            self.object.insert(format!("{name}_{suffix}"), values.into());
            self.units.insert(format!("{name}_{suffix}"), unit.into());
        }
        self
    }

    /// A growth rate per unit τ, in SI per second; or null and why.
    pub fn rate(&mut self, name: &str, value: Result<f64, String>) -> &mut Self {
        self.units.insert(name.to_owned(), "ω₀".into());
        let twin = self.scales.map(|scales| (format!("{name}_per_s"), scales.angular_frequency()));
        if let Some((key, _)) = &twin {
            self.units.insert(key.clone(), "1/s".into());
        }
        match value {
            Ok(value) => {
                self.object.insert(name.to_owned(), value.into());
                if let Some((key, omega)) = twin {
                    self.object.insert(key, (value * omega).into());
                }
            }
            Err(why) => {
                self.unknown(name, why);
                if let Some((key, _)) = twin {
                    self.object.insert(key, Json::Null);
                }
            }
        }
        self
    }

    /// A growth in decibels per second, of a study in SI; or null and why.
    pub fn decibels(&mut self, name: &str, value: Result<f64, String>) -> &mut Self {
        self.units.insert(name.to_owned(), "dB/s".into());
        match value {
            Ok(value) => self.plain(name, value),
            Err(why) => self.unknown(name, why),
        }
    }

    /// An object inside this one.
    pub fn nested(&mut self, name: &str, inner: Self) -> &mut Self {
        let object = self.take(name, inner);
        self.object.insert(name.to_owned(), Json::Object(object));
        self
    }

    /// An array of objects.
    pub fn list(&mut self, name: &str, items: impl IntoIterator<Item = Self>) -> &mut Self {
        let items: Vec<Json> = items
            .into_iter()
            .enumerate()
            .map(|(index, item)| Json::Object(self.take(&format!("{name}[{index}]"), item)))
            .collect();
        self.object.insert(name.to_owned(), items.into());
        self
    }

    /// Says why an element of what was put, `name[index]`, is null; [`Fields::unknown`] is for a whole field.
    pub fn why(&mut self, name: &str, why: impl Into<String>) -> &mut Self {
        self.why.insert(name.to_owned(), why.into().into());
        self
    }

    /// The finished object, with `units` and `why`.
    pub fn finish(mut self) -> Json {
        if !self.units.is_empty() {
            self.object.insert("units".to_owned(), Json::Object(self.units));
        }
        if !self.why.is_empty() {
            self.object.insert("why".to_owned(), Json::Object(self.why));
        }
        Json::Object(self.object)
    }

    fn twin(&self, name: &str, quantity: Quantity) -> Option<(String, f64, &'static str)> {
        let (unit, suffix) = quantity.si_unit()?;
        let factor = self.scales?.si_per_unit(quantity);
        Some((format!("{name}_{suffix}"), factor, unit))
    }

    fn name_units(
        &mut self,
        name: &str,
        quantity: Quantity,
        twin: Option<&(String, f64, &'static str)>,
    ) {
        let unit = unit_of(quantity, self.scales.is_some());
        self.units.insert(name.to_owned(), unit.into());
        if let Some((key, _, unit)) = twin {
            self.units.insert(key.clone(), (*unit).into());
        }
    }

    /// Takes over the units and reasons of an inner object.
    fn take(&mut self, path: &str, inner: Self) -> Map<String, Json> {
        for (name, unit) in inner.units {
            self.units.insert(name, unit);
        }
        for (name, why) in inner.why {
            self.why.insert(format!("{path}.{name}"), why);
        }
        inner.object
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_study_in_si_answers_in_both() {
        let scales = Scales::new(2.0, 200.0).expect("valid");
        let mut fields = Fields::new(Some(scales));
        fields.number("time", Quantity::Time, 30.0).number("stick_fraction", Quantity::Ratio, 0.5);
        let mut inner = Fields::new(Some(scales));
        inner.known("efficiency", Quantity::Ratio, Err("nothing to quench".into()));
        fields.list("points", [inner]);
        let json = fields.finish();
        assert_eq!(json["time"], 30.0);
        assert_eq!(json["time_s"], 3.0);
        assert_eq!(json["units"]["time_s"], "s");
        assert_eq!(json["units"]["stick_fraction"], "1");
        assert!(json["points"][0]["efficiency"].is_null());
        assert_eq!(json["why"]["points[0].efficiency"], "nothing to quench");
        assert!(json.get("stick_fraction_1").is_none());
    }

    #[test]
    fn what_is_not_finite_is_null_with_a_reason() {
        let mut fields = Fields::new(None);
        fields.number("growth", Quantity::Ratio, f64::NAN);
        let json = fields.finish();
        assert!(json["growth"].is_null() && json["why"]["growth"].is_string());
        assert!(json.get("growth_s").is_none());
    }
}
