//! `stability --exact` of a system.

use serde_json::Value as Json;

use crate::outcome::Presented;
use crate::outcome::table::{NumberColumns, figure, frequency_heading, rate_heading};
use crate::run::system::exact::ExactStability;
use crate::study::{SystemSetup, SystemStudy};

impl Presented<SystemSetup> for ExactStability {
    const NAME: &'static str = "exact-stability";
    const TITLED: bool = true;

    fn json(&self, study: &SystemStudy) -> Json {
        self.json(study)
    }

    fn sentence(&self, study: &SystemStudy) -> Option<String> {
        Some(self.sentence(study))
    }

    fn table(&self, study: &SystemStudy) -> String {
        let (frequency, factor) = frequency_heading(study.units());
        let rate = rate_heading(study.units());
        let (columns, heading) = NumberColumns::under(&[rate.as_str(), "error at most", frequency]);
        let mut lines = vec![heading];
        for found in self.orbit.exponents.iter().filter(|found| found.exponent.im >= 0.0) {
            let cells = [found.exponent.re, found.error, factor * found.exponent.im];
            lines.push(columns.line(&cells.map(figure)));
        }
        lines.join("\n") + "\n"
    }
}
