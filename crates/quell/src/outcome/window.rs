//! `response --window`.

use quell_model::units::Quantity;
use serde_json::Value as Json;

use super::Presented;
use super::table::figure_in_units;
use crate::complaint::Failure;
use crate::dataset::Dataset;
use crate::picture;
use crate::plot::Figure;
use crate::run::window::WindowedResponse;
use crate::study::{SystemSetup, SystemStudy};

impl Presented<SystemSetup> for WindowedResponse {
    const NAME: &'static str = "window";
    const TITLED: bool = true;

    fn json(&self, study: &SystemStudy) -> Json {
        Self::json(self, study)
    }

    fn sentence(&self, study: &SystemStudy) -> Option<String> {
        Some(Self::sentence(self, study))
    }

    fn table(&self, study: &SystemStudy) -> String {
        let each = self.contacts.iter().map(|(name, means)| {
            let force = figure_in_units(study.units(), Quantity::Force, means.friction);
            let share = 100.0 * means.stick_fraction;
            format!("  contact {name}: mean friction {force}, in stick {share:.1} % of the time\n")
        });
        each.collect()
    }

    fn datasets(&self, study: &SystemStudy) -> Vec<(&'static str, Dataset)> {
        let (times, displacement) = self.samples();
        let dataset = Dataset::of(&study.into(), "response: window");
        let displacement = displacement.to_vec();
        let dataset = dataset.axis("time", Quantity::Time, times);
        vec![("record", dataset.array("displacement", Quantity::Displacement, displacement))]
    }

    fn figure(&self, study: &SystemStudy) -> Option<Result<Figure, Failure>> {
        Some(Ok(picture::window(study, self)))
    }
}
