//! `basins` of a system.

use std::fmt::Write as _;

use serde_json::Value as Json;

use crate::complaint::Failure;
use crate::dataset::Dataset;
use crate::outcome::Presented;
use crate::picture;
use crate::plot::Figure;
use crate::run::system::basins::SystemBasins;
use crate::study::{SystemSetup, SystemStudy};

impl Presented<SystemSetup> for SystemBasins {
    const TITLED: bool = true;

    fn json(&self, study: &SystemStudy) -> Json {
        self.json(study)
    }

    fn sentence(&self, study: &SystemStudy) -> Option<String> {
        Some(self.sentence(study))
    }

    fn table(&self, _: &SystemStudy) -> String {
        let mut text = String::new();
        for basin in &self.basins {
            let share = format!("{:.1} %", 100.0 * basin.share.fraction);
            let _ = writeln!(text, "  {share:<10}{}", basin.attractor.words());
        }
        if self.unknown.0 > 0 {
            let share = 100.0 * self.unknown.0 as f64 / self.ends.len() as f64;
            let _ = writeln!(text, "  {:<10}outcome unknown", format!("{share:.1} %"));
        }
        text
    }

    fn datasets(&self, study: &SystemStudy) -> Vec<(&'static str, Dataset)> {
        vec![("basins", self.dataset(study))]
    }

    fn figure(&self, study: &SystemStudy) -> Option<Result<Figure, Failure>> {
        Some(picture::system_basins::basins(study, self))
    }
}
