//! `response` under noise.

use quell_model::units::Quantity;
use quell_numerics::order::ascending;
use serde_json::Value as Json;

use super::Presented;
use super::table::{TextTable, figure_in_units};
use crate::complaint::Failure;
use crate::dataset::Dataset;
use crate::fields::Fields;
use crate::picture;
use crate::plot::Figure;
use crate::run::noise_response::NoiseResponse;
use crate::run::system::in_units;
use crate::study::{SystemSetup, SystemStudy};
use crate::words::digits;

/// The numbers without units, as rows.
fn table(found: &NoiseResponse, table: &mut TextTable, band: &str) {
    for (label, value) in found.rows() {
        table.word(&label, &value);
    }
    table.word("band of E, up to", band);
}

impl Presented<SystemSetup> for NoiseResponse {
    const NAME: &'static str = "noise-response";
    const TITLED: bool = true;

    fn json(&self, study: &SystemStudy) -> Json {
        let sentence = Presented::sentence(self, study).unwrap_or_default();
        self.json(|| Fields::in_units(study.units()), sentence)
    }

    fn sentence(&self, study: &SystemStudy) -> Option<String> {
        Some(Self::sentence(self, |quantity, value| in_units(study.units(), quantity, value)))
    }

    fn table(&self, study: &SystemStudy) -> String {
        let mut text = TextTable::default();
        let with = |quantity, value| figure_in_units(study.units(), quantity, value);
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
                    "force {}, stroke {}, both rms; power {}",
                    with(Quantity::Force, cost.force),
                    with(Quantity::Displacement, cost.displacement),
                    with(Quantity::Power, cost.power)
                ),
                Err(why) => format!("unknown: {why}"),
            };
            text.word(&format!("dither[{index}]"), &words);
        }
        text.text()
    }

    fn datasets(&self, study: &SystemStudy) -> Vec<(&'static str, Dataset)> {
        vec![("runs", self.columns(Dataset::of(&study.into(), "response: seeds")))]
    }

    fn figure(&self, study: &SystemStudy) -> Option<Result<Figure, Failure>> {
        Some(Ok(picture::noise_response::figure(study, self)))
    }
}
