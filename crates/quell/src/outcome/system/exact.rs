//! `stability --exact` of a system.

use std::fmt::Write as _;

use serde_json::Value as Json;

use crate::outcome::Presented;
use crate::outcome::table::figure;
use crate::run::system::exact::ExactStability;
use crate::study::{SystemSetup, SystemStudy};

impl Presented<SystemSetup> for ExactStability {
    const TITLED: bool = true;

    fn json(&self, study: &SystemStudy) -> Json {
        self.json(study)
    }

    fn sentence(&self, study: &SystemStudy) -> Option<String> {
        Some(self.sentence(study))
    }

    fn table(&self, _: &SystemStudy) -> String {
        let mut text =
            format!("  {:>14}  {:>14}  {:>14}\n", "growth rate", "error at most", "frequency");
        for found in self.orbit.exponents.iter().filter(|found| found.exponent.im >= 0.0) {
            let _ = writeln!(
                text,
                "  {:>14}  {:>14}  {:>14}",
                figure(found.exponent.re),
                figure(found.error),
                figure(found.exponent.im)
            );
        }
        text
    }
}
