//! The answer of `receptance`: sentence, fields and dataset.

use num_complex::Complex64;
use quell_model::units::Quantity;
use serde_json::Value as Json;

use super::{ContactsAre, PairReceptance, Receptances, VERB};
use crate::dataset::{Array, Dataset};
use crate::fields::Fields;
use crate::run::system::frequency_in_words;
use crate::study::{SystemStudy, UnitSystem};
use crate::words::{counted, digits, unit_after};

/// Why a value is unknown.
const UNBOUNDED: &str = "unbounded: an undamped resonance, or a rigid motion at frequency 0";

impl Receptances {
    /// The name of a pair: output over input.
    pub fn name_of(&self, pair: &PairReceptance) -> String {
        format!("{}/{}", self.outputs[pair.output], self.inputs[pair.input])
    }

    /// The pair with the largest value, with its place and magnitude.
    fn largest(&self) -> Option<(&PairReceptance, usize, f64)> {
        let sizes = self.pairs.iter().filter_map(|pair| {
            let (place, size) = pair.largest()?;
            Some((pair, place, size))
        });
        sizes.max_by(|a, b| a.2.total_cmp(&b.2))
    }

    /// The largest receptance.
    pub fn sentence(&self, study: &SystemStudy) -> String {
        let Some((pair, place, size)) = self.largest() else {
            return "No receptance is bounded at any of the frequencies.".to_owned();
        };
        let of = match self.pairs.len() {
            1 => String::new(),
            many => format!(" of {}", counted(many, "receptance")),
        };
        format!(
            "The largest value{of} is {}{}, of {} to a force along {}, at {}.",
            digits(size),
            unit_after(unit(study)),
            self.outputs[pair.output],
            self.inputs[pair.input],
            frequency_in_words(study.units(), self.frequencies[place]),
        )
    }

    /// What the contacts are, and where values are unknown.
    pub fn notes(&self) -> Vec<String> {
        let contacts = match self.contacts {
            ContactsAre::Sliding => "The contacts slide, with friction carried along.",
            ContactsAre::Springs => "The contacts are springs without friction.",
            ContactsAre::Absent => "The contacts are left out.",
        };
        let unknown = |pair: &PairReceptance| pair.values.iter().filter(|at| at.is_none()).count();
        let unknown = self.pairs.first().map_or(0, unknown);
        let left = (unknown > 0).then(|| {
            let verb = if unknown == 1 { "has" } else { "have" };
            format!("{} {verb} no value ({UNBOUNDED}).", counted(unknown, "frequency"))
        });
        std::iter::once(contacts.to_owned()).chain(left).collect()
    }

    /// As JSON.
    pub fn json(&self, study: &SystemStudy) -> Json {
        let units = study.units();
        let mut fields = Fields::in_units(units);
        let [first, last] = [self.frequencies.first(), self.frequencies.last()]
            .map(|end| end.copied().unwrap_or(0.0));
        fields
            .plain("ok", true)
            .plain("sentence", self.sentence(study))
            .plain("contacts", self.contacts.name())
            .plain("verdict", self.verdict.name())
            .plain("outputs", self.outputs.clone())
            .plain("inputs", self.inputs.clone())
            .number("from", Quantity::FrequencyRatio, first)
            .number("to", Quantity::FrequencyRatio, last)
            .plain("points", self.frequencies.len());
        let unit = unit(study).unwrap_or("1");
        let pairs = self.pairs.iter().map(|pair| {
            let mut inner = Fields::in_units(units);
            inner
                .plain("output", self.outputs[pair.output].clone())
                .plain("input", self.inputs[pair.input].clone());
            match pair.largest() {
                Some((place, size)) => inner.measured("largest", unit, size).number(
                    "frequency",
                    Quantity::FrequencyRatio,
                    self.frequencies[place],
                ),
                None => inner.unknown("largest", UNBOUNDED).unknown("frequency", UNBOUNDED),
            };
            inner
        });
        fields.list("receptances", pairs.collect::<Vec<_>>());
        fields.plain("warnings", self.warnings.clone());
        fields.finish()
    }

    /// Real and imaginary parts over output, input and frequency: the file of a study with `frequency_response`.
    pub fn dataset(&self, study: &SystemStudy) -> Dataset {
        let per = study.units().unit(Quantity::FrequencyRatio).unwrap_or("1");
        let unit = unit(study).unwrap_or("1");
        let part = |of: fn(Complex64) -> f64| -> Vec<f64> {
            let values = self.pairs.iter().flat_map(|pair| &pair.values);
            values.map(|value| value.map_or(f64::NAN, of)).collect()
        };
        Dataset::of(&study.into(), VERB)
            .with_axis(Array::of_names("output", &self.outputs))
            .with_axis(Array::of_names("input", &self.inputs))
            .with_axis(Array::new("frequency", per, self.frequencies.clone()))
            .with(Array::new("re", unit, part(|value| value.re)))
            .with(Array::new("im", unit, part(|value| value.im)))
    }
}

/// The unit of displacement over force.
pub fn unit(study: &SystemStudy) -> Option<&'static str> {
    match study.units() {
        UnitSystem::None => None,
        UnitSystem::Si => Some("m/N"),
        UnitSystem::MmTonneSecond => Some("mm/N"),
    }
}
