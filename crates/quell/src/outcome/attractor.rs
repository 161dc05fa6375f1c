//! `attractor`: the motion on which a run ends, and its Lyapunov exponents.

use serde_json::Value as Json;

use super::Presented;
use crate::complaint::{Complaint, Failure, Fault, Origin};
use crate::dataset::Dataset;
use crate::picture::exponents::{ExponentUnits, exponents};
use crate::plot::Figure;
use crate::run::exponents::MeasuredExponents;
use crate::run::found_attractor::AttractorOfBelt;
use crate::study::{BeltSetup, BeltStudy};

impl Presented<BeltSetup> for AttractorOfBelt {
    const TITLED: bool = true;

    fn json(&self, study: &BeltStudy) -> Json {
        self.json(study)
    }

    fn sentence(&self, study: &BeltStudy) -> Option<String> {
        Some(self.sentence(study))
    }

    fn table(&self, study: &BeltStudy) -> String {
        text_of(self.measured(), |rate| AttractorOfBelt::rate(study, rate))
    }

    fn datasets(&self, study: &BeltStudy) -> Vec<(&'static str, Dataset)> {
        self.dataset(study).map(|dataset| ("exponents", dataset)).into_iter().collect()
    }

    fn figure(&self, study: &BeltStudy) -> Option<Result<Figure, Failure>> {
        let [time, rate] = AttractorOfBelt::units(study);
        let units = ExponentUnits { time: (Some(time.0), time.1), rate: (Some(rate.0), rate.1) };
        let caption = self.sentence(study);
        let found = self.measured().map(|found| exponents(study.title(), found, &units, caption));
        Some(found.ok_or_else(needs_exponents))
    }
}

/// The table of exponents; empty without any.
pub(super) fn text_of(
    measured: Option<&MeasuredExponents>,
    rate: impl Fn(f64) -> String,
) -> String {
    measured.map_or_else(String::new, |measured| measured.table(rate))
}

/// The failure of a picture without exponents.
pub(super) fn needs_exponents() -> Failure {
    let allowed = "given with --lyapunov, of a motion whose exponents are known: the picture shows their convergence";
    Complaint::new(Fault::Conflict, "--plot", Origin::Argument("--plot"), Json::Null, allowed)
        .into()
}
