//! `attractor`: the motion on which a run ends, and its Lyapunov exponents.

use quell_model::units::Quantity;
use serde_json::Value as Json;

use super::Presented;
use crate::complaint::{Complaint, Failure, Fault, Origin};
use crate::dataset::Dataset;
use crate::picture::exponents::{ExponentUnits, exponents};
use crate::plot::Figure;
use crate::run::exponents::MeasuredExponents;
use crate::run::found_attractor::{FoundAttractor, unit_of_rates};
use crate::run::system::rate_of;
use crate::study::{SystemSetup, SystemStudy};

impl Presented<SystemSetup> for FoundAttractor {
    const NAME: &'static str = "attractor";
    const TITLED: bool = true;

    fn json(&self, study: &SystemStudy) -> Json {
        self.json(study)
    }

    fn sentence(&self, study: &SystemStudy) -> Option<String> {
        Some(self.sentence(study))
    }

    fn table(&self, study: &SystemStudy) -> String {
        let table = |found: &MeasuredExponents| found.table(|rate| rate_of(study.units(), rate));
        self.measured().map_or_else(String::new, table)
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

/// The failure of a picture without exponents.
fn needs_exponents() -> Failure {
    let allowed = "given with --lyapunov, of a motion whose exponents are known: the picture shows their convergence";
    Complaint::new(Fault::Conflict, "--plot", Origin::Argument("--plot"), Json::Null, allowed)
        .into()
}
