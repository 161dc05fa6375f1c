//! `bifurcation --ramp`.

use quell_model::units::Quantity;
use serde_json::Value as Json;

use super::Presented;
use super::table::TextTable;
use crate::complaint::Failure;
use crate::dataset::Dataset;
use crate::picture;
use crate::plot::Figure;
use crate::run::ramp::Ramp;
use crate::run::thresholds::side;
use crate::study::{BeltSetup, BeltStudy};

impl Presented<BeltSetup> for Ramp {
    const TITLED: bool = true;

    fn json(&self, study: &BeltStudy) -> Json {
        self.json(study)
    }

    fn sentence(&self, study: &BeltStudy) -> Option<String> {
        Some(self.sentence(study))
    }

    fn table(&self, study: &BeltStudy) -> String {
        let mut table = TextTable::new(study.scales());
        for switch in &self.switches {
            let name = if switch.to_quiet { "vibration ends at" } else { "vibration begins at" };
            table.number(name, self.ramped.quantity, switch.value);
            table.number("  at the time", Quantity::Time, switch.time);
        }
        for threshold in self.thresholds.iter().flatten() {
            let name = format!("exact: {} above", side(threshold.becomes));
            table.number(&name, self.ramped.quantity, threshold.value);
        }
        table.text()
    }

    fn datasets(&self, study: &BeltStudy) -> Vec<(&'static str, Dataset)> {
        vec![("ramp", self.dataset(study))]
    }

    fn figure(&self, study: &BeltStudy) -> Option<Result<Figure, Failure>> {
        Some(Ok(picture::ramp(study, self)))
    }
}
