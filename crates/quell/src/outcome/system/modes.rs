//! `modes` of a system.

use serde_json::Value as Json;

use super::{ListedMotion, motions};
use crate::complaint::Failure;
use crate::dataset::Dataset;
use crate::outcome::Presented;
use crate::picture;
use crate::plot::Figure;
use crate::run::system::modes::SystemModes;
use crate::study::{SystemSetup, SystemStudy};

impl Presented<SystemSetup> for SystemModes {
    const NAME: &'static str = "modes";
    const TITLED: bool = true;

    fn json(&self, study: &SystemStudy) -> Json {
        self.json(study)
    }

    fn sentence(&self, study: &SystemStudy) -> Option<String> {
        Some(self.sentence(study))
    }

    fn notes(&self, _: &SystemStudy) -> Vec<String> {
        self.notes()
    }

    fn table(&self, study: &SystemStudy) -> String {
        motions(study.units(), ListedMotion::Natural, self.modes.iter())
    }

    fn datasets(&self, study: &SystemStudy) -> Vec<(&'static str, Dataset)> {
        vec![("modes", self.dataset(study))]
    }

    fn figure(&self, study: &SystemStudy) -> Option<Result<Figure, Failure>> {
        Some(Ok(picture::system_modes::modes(study, self)))
    }
}
