//! `simulate` of a disc: the answer about its system, with amplitude and growth.

use serde_json::Value as Json;

use super::simulate::figure_with;
use crate::complaint::Failure;
use crate::dataset::Dataset;
use crate::disc_units::{DiscUnits, FORCE, in_units_of_study};
use crate::outcome::Presented;
use crate::picture;
use crate::plot::Figure;
use crate::run::disc::motion::DiscSimulation;
use crate::study::{DiscSetup, DiscStudy};

impl Presented<DiscSetup> for DiscSimulation {
    const NAME: &'static str = "simulation";
    const TITLED: bool = true;

    fn json(&self, study: &DiscStudy) -> Json {
        in_units_of_study(study, self.json(study))
    }

    fn sentence(&self, study: &DiscStudy) -> Option<String> {
        Some(self.sentence(study))
    }

    fn notes(&self, study: &DiscStudy) -> Vec<String> {
        self.notes(study)
    }

    fn table(&self, _: &DiscStudy) -> String {
        self.motion.table(&self.system)
    }

    fn datasets(&self, study: &DiscStudy) -> Vec<(&'static str, Dataset)> {
        let Some(units) = DiscUnits::of(study) else { return self.motion.datasets(&self.system) };
        // States are those of the equations, with which another run may begin. Without a law the slip velocity is 1 and the load is given.
        let under_law = study.disc().law().is_some();
        let one = |name: &str, _: &str| match name.rsplit('.').next() {
            Some("time") => units.one(name, "1/ω_ref"),
            Some("friction") => units.one(name, FORCE),
            Some("normal") if under_law => units.one(name, FORCE),
            Some("slip_velocity") if under_law => units.one(name, "r₀ω_ref"),
            _ => None,
        };
        let datasets = self.motion.datasets(&self.system).into_iter();
        datasets.map(|(name, dataset)| (name, dataset.rescaled(one))).collect()
    }

    fn sound(&self, _: &DiscStudy) -> Option<Result<Vec<u8>, Failure>> {
        self.motion.sound(&self.system)
    }

    fn figure(&self, study: &DiscStudy) -> Option<Result<Figure, Failure>> {
        // The system of a disc has the friction of its dither: without it, it is no disc without dither.
        let figure = figure_with(&self.motion, &self.system, false)?;
        Some(figure.map(|figure| picture::disc::of_motion(figure, study)))
    }
}
