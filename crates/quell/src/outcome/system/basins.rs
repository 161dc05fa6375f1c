//! `basins` of a system.

use std::fmt::Write as _;

use serde_json::Value as Json;

use crate::complaint::Failure;
use crate::dataset::Dataset;
use crate::outcome::Presented;
use crate::outcome::table::figure;
use crate::picture;
use crate::plot::Figure;
use crate::run::basins::Share;
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

    fn table(&self, study: &SystemStudy) -> String {
        let mut text = String::new();
        let percent = |fraction: f64| format!("{:.1} %", 100.0 * fraction);
        if let (None, [portrait]) = (&self.over, self.portraits.as_slice()) {
            for basin in &portrait.basins {
                let share = percent(basin.share.fraction);
                let _ = writeln!(text, "  {share:<10}{}", basin.attractor.words(study.units()));
            }
            if portrait.unknown.starts > 0 {
                let share = percent(portrait.unknown.fraction);
                let _ = writeln!(text, "  {share:<10}outcome unknown");
            }
            return text;
        }
        let path = self.over.as_ref().map_or("", |over| over.parameter.as_str());
        let width = path.len().max(14) + 2;
        let _ = writeln!(text, "\n  {path:<width$}{:<26}{:<12}motions", "quiet", "unknown");
        for portrait in &self.portraits {
            let value = portrait.value.map_or_else(String::new, figure);
            let quiet = portrait.quiet.map_or_else(|| "unknown".to_owned(), Share::percent);
            let unknown = percent(portrait.unknown.fraction);
            let count = portrait.basins.len();
            let _ = writeln!(text, "  {value:<width$}{quiet:<26}{unknown:<12}{count}");
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
