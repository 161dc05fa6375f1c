//! `bifurcation --ramp`: a slow ramp compared with exact thresholds.

use quell_model::units::Quantity;
use serde_json::Value as Json;

use super::Presented;
use super::table::{TextTable, figure_in_units};
use crate::complaint::Failure;
use crate::dataset::Dataset;
use crate::picture;
use crate::plot::Figure;
use crate::run::manoeuvre::VibrationLimits;
use crate::run::ramp::Ramp;
use crate::study::{SystemSetup, SystemStudy};

impl Presented<SystemSetup> for Ramp {
    const NAME: &'static str = "ramp";
    const TITLED: bool = true;

    fn json(&self, study: &SystemStudy) -> Json {
        self.json(study)
    }

    fn sentence(&self, study: &SystemStudy) -> Option<String> {
        Some(self.sentence(study))
    }

    fn table(&self, study: &SystemStudy) -> String {
        let with = |quantity, value| figure_in_units(study.units(), quantity, value);
        let mut table = TextTable::default();
        for switch in &self.switches {
            table.word(event(switch.to_quiet), &with(self.ramped.quantity, switch.value));
            table.word("  at the time", &with(Quantity::Time, switch.time));
        }
        for threshold in self.thresholds.iter().flatten() {
            let name = format!("exact: {} above", threshold.becomes);
            table.word(&name, &with(self.ramped.quantity, threshold.value));
        }
        if let Some(VibrationLimits { begins_above: begins, ends_below: ends }) = self.limits() {
            table.word("vibration counts from", &with(Quantity::Displacement, begins));
            table.word("  and until below", &with(Quantity::Displacement, ends));
        }
        table.text()
    }

    fn datasets(&self, study: &SystemStudy) -> Vec<(&'static str, Dataset)> {
        vec![("ramp", self.dataset(study))]
    }

    fn figure(&self, study: &SystemStudy) -> Option<Result<Figure, Failure>> {
        Some(Ok(picture::ramp::ramp(study, self)))
    }
}

fn event(to_quiet: bool) -> &'static str {
    if to_quiet { "vibration ends at" } else { "vibration begins at" }
}
