//! `response` under noise, of belts and systems.

use quell_model::units::Quantity;
use quell_numerics::order::ascending;
use serde_json::Value as Json;

use super::Presented;
use super::table::TextTable;
use crate::complaint::Failure;
use crate::dataset::Dataset;
use crate::fields::Fields;
use crate::picture;
use crate::plot::Figure;
use crate::run::noise_response::NoiseResponse;
use crate::run::system::in_units;
use crate::study::{BeltSetup, BeltStudy, SystemSetup, SystemStudy};
use crate::words::{digits, in_words};

/// The numbers without units, as rows.
fn table(found: &NoiseResponse, table: &mut TextTable, band: &str) {
    for (label, value) in found.rows() {
        table.word(&label, &value);
    }
    table.word("band of E, up to", band);
}

impl Presented<BeltSetup> for NoiseResponse {
    fn json(&self, study: &BeltStudy) -> Json {
        let sentence = Presented::sentence(self, study).unwrap_or_default();
        self.json_of_belt(Fields::new(study.scales()), sentence)
    }

    fn sentence(&self, study: &BeltStudy) -> Option<String> {
        Some(Self::sentence(self, |quantity, value| in_words(study, quantity, value)))
    }

    fn table(&self, study: &BeltStudy) -> String {
        let mut text = TextTable::new(study.scales());
        table(self, &mut text, &format!("{} ω₀", self.band_end));
        let of = |value: Option<f64>| value.ok_or_else(|| "unknown".to_owned());
        let cost = self.costs.first().and_then(|cost| cost.as_ref().ok());
        text.known("rms force of the dither", Quantity::Force, of(cost.map(|cost| cost.force)));
        text.known("  rms stroke", Quantity::Displacement, of(cost.map(|cost| cost.displacement)));
        text.known("  power", Quantity::Power, of(cost.map(|cost| cost.power)));
        text.text()
    }

    fn datasets(&self, study: &BeltStudy) -> Vec<(&'static str, Dataset)> {
        vec![("runs", self.columns(Dataset::new(study, "response: seeds")))]
    }

    fn figure(&self, study: &BeltStudy) -> Option<Result<Figure, Failure>> {
        Some(Ok(picture::noise_response::of_belt(study, self)))
    }
}

impl Presented<SystemSetup> for NoiseResponse {
    fn json(&self, study: &SystemStudy) -> Json {
        let sentence = Presented::sentence(self, study).unwrap_or_default();
        self.json_of_system(|| Fields::of_system(study.units()), sentence)
    }

    fn sentence(&self, study: &SystemStudy) -> Option<String> {
        Some(Self::sentence(self, |quantity, value| in_units(study.units(), quantity, value)))
    }

    fn table(&self, study: &SystemStudy) -> String {
        let mut text = TextTable::new(None);
        let with = |quantity: Quantity, value: f64| in_units(study.units(), quantity, value);
        table(self, &mut text, &with(Quantity::FrequencyRatio, self.band_end));
        for (contact, name) in self.contacts.iter().enumerate() {
            let mut stuck: Vec<f64> =
                self.runs.iter().map(|run| run.contacts[contact].stick_fraction).collect();
            ascending(&mut stuck);
            let [least, most] = [0, stuck.len() - 1].map(|place| digits(stuck[place]));
            text.word(
                &format!("contact {name}, share of time in stick"),
                &format!("{least} to {most}"),
            );
        }
        for (index, cost) in self.costs.iter().enumerate() {
            let words = match cost {
                Ok(cost) => format!(
                    "{}, stroke {}, power {}",
                    with(Quantity::Force, cost.force),
                    with(Quantity::Displacement, cost.displacement),
                    with(Quantity::Power, cost.power)
                ),
                Err(why) => format!("unknown: {why}"),
            };
            text.word(&format!("dither[{index}], rms force"), &words);
        }
        text.text()
    }

    fn datasets(&self, study: &SystemStudy) -> Vec<(&'static str, Dataset)> {
        vec![("runs", self.columns(Dataset::of(&study.into(), "response: seeds")))]
    }

    fn figure(&self, study: &SystemStudy) -> Option<Result<Figure, Failure>> {
        Some(Ok(picture::noise_response::of_system(study, self)))
    }
}
