//! `response --window` of belts and systems.

use quell_model::units::Quantity;
use serde_json::Value as Json;

use super::Presented;
use super::table::TextTable;
use crate::complaint::Failure;
use crate::dataset::Dataset;
use crate::fields::Fields;
use crate::picture;
use crate::plot::Figure;
use crate::run::system::in_units;
use crate::run::window::WindowedResponse;
use crate::study::{BeltSetup, BeltStudy, SystemSetup, SystemStudy};
use crate::words::in_words;

/// The columns of the answer.
fn columns(found: &WindowedResponse, dataset: Dataset) -> Dataset {
    let (times, displacement) = found.samples();
    dataset.axis("time", Quantity::Time, times).array(
        "displacement",
        Quantity::Displacement,
        displacement.to_vec(),
    )
}

impl Presented<BeltSetup> for WindowedResponse {
    fn json(&self, study: &BeltStudy) -> Json {
        let sentence = Presented::sentence(self, study).unwrap_or_default();
        Self::json(self, sentence, || Fields::new(study.scales()))
    }

    fn sentence(&self, study: &BeltStudy) -> Option<String> {
        Some(Self::sentence(self, |quantity, value| in_words(study, quantity, value)))
    }

    fn table(&self, study: &BeltStudy) -> String {
        let mut table = TextTable::new(study.scales());
        table.number("mean displacement", Quantity::Displacement, self.observed.mean());
        table.number("rms about it", Quantity::Displacement, self.observed.deviation());
        table.number("half peak-to-peak", Quantity::Displacement, 0.5 * self.observed.range());
        for (_, means) in &self.contacts {
            table.number("mean friction", Quantity::Force, means.friction);
            table.number("share of time in stick", Quantity::Ratio, means.stick_fraction);
        }
        table.text()
    }

    fn datasets(&self, study: &BeltStudy) -> Vec<(&'static str, Dataset)> {
        vec![("record", columns(self, Dataset::new(study, "response: window")))]
    }

    fn figure(&self, study: &BeltStudy) -> Option<Result<Figure, Failure>> {
        Some(Ok(picture::window::of_belt(study, self)))
    }
}

impl Presented<SystemSetup> for WindowedResponse {
    fn json(&self, study: &SystemStudy) -> Json {
        let sentence = Presented::sentence(self, study).unwrap_or_default();
        Self::json(self, sentence, || Fields::of_system(study.units()))
    }

    fn sentence(&self, study: &SystemStudy) -> Option<String> {
        Some(Self::sentence(self, |quantity, value| in_units(study.units(), quantity, value)))
    }

    fn table(&self, study: &SystemStudy) -> String {
        let each = self.contacts.iter().map(|(name, means)| {
            let force = in_units(study.units(), Quantity::Force, means.friction);
            let share = 100.0 * means.stick_fraction;
            format!("  contact {name}: mean friction {force}, in stick {share:.1} % of the time\n")
        });
        each.collect()
    }

    fn datasets(&self, study: &SystemStudy) -> Vec<(&'static str, Dataset)> {
        vec![("record", columns(self, Dataset::of(&study.into(), "response: window")))]
    }

    fn figure(&self, study: &SystemStudy) -> Option<Result<Figure, Failure>> {
        Some(Ok(picture::window::of_system(study, self)))
    }
}
