//! `stability --exact` of a system.

use std::fmt::Write as _;

use serde_json::Value as Json;

use crate::outcome::Presented;
use crate::outcome::table::figure;
use crate::run::system::exact::ExactStability;
use crate::study::{SystemSetup, SystemStudy, UnitSystem};

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
        let (factor, rate, frequency) = match study.units() {
            UnitSystem::None => (1.0, "growth rate", "frequency"),
            _ => (1.0 / std::f64::consts::TAU, "rate/(1/s)", "frequency/Hz"),
        };
        let mut text = format!("  {rate:>14}  {:>14}  {frequency:>14}\n", "error at most");
        for found in self.orbit.exponents.iter().filter(|found| found.exponent.im >= 0.0) {
            let _ = writeln!(
                text,
                "  {:>14}  {:>14}  {:>14}",
                figure(found.exponent.re),
                figure(found.error),
                figure(factor * found.exponent.im)
            );
        }
        text
    }
}
