//! `attractor` of a system.

use quell_model::units::Quantity;
use serde_json::Value as Json;

use crate::complaint::Failure;
use crate::dataset::Dataset;
use crate::outcome::Presented;
use crate::outcome::attractor::{needs_exponents, text_of};
use crate::picture::exponents::{ExponentUnits, exponents};
use crate::plot::Figure;
use crate::run::system::found_attractor::{AttractorOfSystem, unit_of_rates};
use crate::run::system::rate_of;
use crate::study::{SystemSetup, SystemStudy};

impl Presented<SystemSetup> for AttractorOfSystem {
    const TITLED: bool = true;

    fn json(&self, study: &SystemStudy) -> Json {
        self.json(study)
    }

    fn sentence(&self, study: &SystemStudy) -> Option<String> {
        Some(self.sentence(study))
    }

    fn table(&self, study: &SystemStudy) -> String {
        text_of(self.measured(), |rate| rate_of(study.units(), rate))
    }

    fn datasets(&self, study: &SystemStudy) -> Vec<(&'static str, Dataset)> {
        self.dataset(study).map(|dataset| ("exponents", dataset)).into_iter().collect()
    }

    fn figure(&self, study: &SystemStudy) -> Option<Result<Figure, Failure>> {
        let units = ExponentUnits {
            time: (study.units().unit(Quantity::Time), 1.0),
            rate: (Some(unit_of_rates(study)).filter(|unit| *unit != "1"), 1.0),
        };
        let caption = self.sentence(study);
        let found = self.measured().map(|found| exponents(study.title(), found, &units, caption));
        Some(found.ok_or_else(needs_exponents))
    }
}
