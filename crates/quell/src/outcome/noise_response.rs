//! `response` under noise.

use quell_model::units::Quantity;
use serde_json::Value as Json;

use super::Presented;
use super::table::TextTable;
use crate::complaint::Failure;
use crate::dataset::Dataset;
use crate::picture;
use crate::plot::Figure;
use crate::run::noise_response::NoiseResponse;
use crate::study::{BeltSetup, BeltStudy};

impl Presented<BeltSetup> for NoiseResponse {
    fn json(&self, study: &BeltStudy) -> Json {
        Self::json(self, study)
    }

    fn sentence(&self, study: &BeltStudy) -> Option<String> {
        Some(Self::sentence(self, study))
    }

    fn table(&self, study: &BeltStudy) -> String {
        let mut table = TextTable::new(study.scales());
        for (label, value) in self.rows() {
            table.word(&label, &value);
        }
        let of = |value: Option<f64>| value.ok_or_else(|| "unknown".to_owned());
        let cost = self.cost.as_ref().ok();
        table.known("rms force of the dither", Quantity::Force, of(cost.map(|cost| cost.force)));
        table.known("  rms stroke", Quantity::Displacement, of(cost.map(|cost| cost.displacement)));
        table.known("  power", Quantity::Power, of(cost.map(|cost| cost.power)));
        table.text()
    }

    fn datasets(&self, study: &BeltStudy) -> Vec<(&'static str, Dataset)> {
        vec![("runs", self.dataset(study))]
    }

    fn figure(&self, study: &BeltStudy) -> Option<Result<Figure, Failure>> {
        Some(Ok(picture::noise_response(study, self)))
    }
}
