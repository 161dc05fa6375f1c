//! Basins of a system in sentences, JSON and a dataset.

use quell_model::units::Quantity;
use serde_json::Value as Json;

use super::attractor::SystemAttractor;
use super::basins::{MOST_PERIODS_OF_A_START, SystemBasins};
use super::start::{state_names, state_quantity};
use crate::dataset::{Array, Dataset};
use crate::fields::Fields;
use crate::run::basins::Share;
use crate::study::SystemStudy;
use crate::words::plural;

/// A share as a percentage with its bounds.
fn percent(share: Share) -> String {
    let digits = |value: f64| {
        let text = format!("{:.1}", 100.0 * value);
        text.trim_end_matches(".0").to_owned()
    };
    format!("{} % ({} to {} %)", digits(share.fraction), digits(share.low), digits(share.high))
}

fn put_share(fields: &mut Fields, share: Share) {
    fields
        .plain("starts", share.starts)
        .number("fraction", Quantity::Ratio, share.fraction)
        .number("fraction_low", Quantity::Ratio, share.low)
        .number("fraction_high", Quantity::Ratio, share.high)
        .number("fraction_error", Quantity::Ratio, share.error());
}

impl SystemBasins {
    /// The shares of the motions in a few sentences.
    pub fn sentence(&self, study: &SystemStudy) -> String {
        let count = self.ends.len();
        let parts = self.basins.iter().map(|basin| {
            format!(
                "{} of {count} starts end on: {}",
                percent(basin.share),
                basin.attractor.words()
            )
        });
        let mut sentences: Vec<String> = parts.map(|part| part + ".").collect();
        let other = state_names(study.system()).len() - 2;
        let [first, second] = &self.names;
        sentences.push(match other {
            0 => format!("The starts are in the plane of {first} and {second}."),
            _ => format!(
                "The starts are in the plane of {first} and {second}; the other {other} number{} of the state start {}.",
                plural(other),
                self.start
            ),
        });
        if let (unknown @ 1.., Some(why)) = &self.unknown {
            sentences.push(format!(
                "The outcome of {unknown} start{} is unknown: {why}.",
                plural(*unknown)
            ));
        }
        if let Ok(verdict) = &self.local {
            sentences.push(format!("The base response is {verdict}."));
        }
        sentences.join(" ")
    }

    /// The unit of an axis.
    fn unit(&self, study: &SystemStudy, axis: usize) -> &'static str {
        let names = state_names(study.system());
        let place = names.iter().position(|name| *name == self.names[axis]);
        let quantity = place.and_then(|place| state_quantity(study.system(), place));
        quantity.and_then(|quantity| study.units().unit(quantity)).unwrap_or("1")
    }

    /// As JSON.
    pub fn json(&self, study: &SystemStudy) -> Json {
        let mut fields = Fields::of_system(study.units());
        fields
            .plain("ok", true)
            .plain("sentence", self.sentence(study))
            .plain("plane", self.names.to_vec())
            .plain("start", self.start.clone())
            .plain("most_periods", MOST_PERIODS_OF_A_START);
        for (axis, name) in ["across", "up"].into_iter().enumerate() {
            fields.measured(name, self.unit(study, axis), self.values[axis].clone());
        }
        match &self.local {
            Ok(verdict) => fields.plain("local_verdict", *verdict),
            Err(why) => fields.unknown("local_verdict", why.as_str()),
        };
        fields
            .number("quiet_fraction", Quantity::Ratio, self.quiet.fraction)
            .number("quiet_fraction_low", Quantity::Ratio, self.quiet.low)
            .number("quiet_fraction_high", Quantity::Ratio, self.quiet.high);
        let attractors = self.basins.iter().map(|basin| {
            let mut inner = Fields::of_system(study.units());
            put_share(&mut inner, basin.share);
            inner.plain("periods_to_settle", basin.periods);
            basin.attractor.put(&mut inner, study);
            inner
        });
        let attractors: Vec<Fields> = attractors.collect();
        fields.list("attractors", attractors);
        let ends: Vec<Json> = self.ends.iter().map(|end| Json::from(*end)).collect();
        fields.plain("ends", ends).plain("unknown_starts", self.unknown.0);
        fields.plain("warnings", study.warnings().to_vec());
        fields.finish()
    }

    /// The motion of each start over the plane.
    pub fn dataset(&self, study: &SystemStudy) -> Dataset {
        let ends = self.ends.iter().map(|end| end.map_or(f64::NAN, |place| place as f64));
        let is_quiet = |place: usize| self.basins[place].attractor.is_quiet();
        let quiet = self.ends.iter().map(|end| end.map_or(2, |place| u8::from(is_quiet(place))));
        let quiet: Vec<u8> = quiet.collect();
        let mut dataset = Dataset::of(&study.into(), "basins");
        for (place, words) in
            self.basins.iter().map(|basin| &basin.attractor).map(SystemAttractor::words).enumerate()
        {
            dataset = dataset.fact(format!("attractor {place}: {words}"));
        }
        let axis = |number: usize| {
            let values = self.values[number].clone();
            Array::new(self.names[number].as_str(), self.unit(study, number), values)
        };
        // The last axis runs fastest.
        dataset
            .with_axis(axis(1))
            .with_axis(axis(0))
            .with(Array::new("attractor", "1", ends.collect()))
            .with(Array::of_words("quiet", vec![(0, "no"), (1, "yes"), (2, "unknown")], &quiet))
    }
}
