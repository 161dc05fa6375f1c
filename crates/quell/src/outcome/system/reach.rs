//! `resonances` of a system.

use std::fmt::Write as _;

use std::f64::consts::TAU;

use serde_json::Value as Json;

use crate::complaint::Failure;
use crate::dataset::Dataset;
use crate::outcome::Presented;
use crate::outcome::table::figure;
use crate::picture;
use crate::plot::Figure;
use crate::run::system::reach::{Reaches, UNBOUNDED_RESONANCE};
use crate::study::{SystemSetup, SystemStudy, UnitSystem};

impl Presented<SystemSetup> for Reaches {
    const NAME: &'static str = "reach";
    const TITLED: bool = true;

    fn json(&self, study: &SystemStudy) -> Json {
        self.json(study)
    }

    fn sentence(&self, study: &SystemStudy) -> Option<String> {
        Some(self.sentence(study))
    }

    fn table(&self, study: &SystemStudy) -> String {
        let mut text = String::new();
        let (factor, frequency, slip) = match study.units() {
            UnitSystem::None => (1.0, "frequency", "slip/dither"),
            UnitSystem::Si => (1.0 / TAU, "frequency/Hz", "slip/(m/s/N)"),
            UnitSystem::MmTonneSecond => (1.0 / TAU, "frequency/Hz", "slip/(mm/s/N)"),
        };
        for pair in &self.pairs {
            let contact = &study.system().contacts[pair.contact].name;
            let _ = writeln!(text, "  contact {contact}, dither[{}]", pair.dither);
            let _ = writeln!(text, "  {frequency:>14}  {slip:>14}");
            for at in &pair.extremes {
                let kind = match (at.peak, at.out_of_reach) {
                    (true, _) => "resonance",
                    (false, false) => "minimum",
                    (false, true) => "antiresonance, out of reach",
                };
                let frequency = figure(factor * at.frequency);
                let _ = match at.slip_per_amplitude {
                    Some(slip) => writeln!(text, "  {frequency:>14}  {:>14}  {kind}", figure(slip)),
                    None => writeln!(text, "  {frequency:>14}  {UNBOUNDED_RESONANCE}"),
                };
            }
        }
        text
    }

    fn datasets(&self, study: &SystemStudy) -> Vec<(&'static str, Dataset)> {
        vec![("responses", self.dataset(study))]
    }

    fn figure(&self, study: &SystemStudy) -> Option<Result<Figure, Failure>> {
        Some(Ok(picture::system::reach(study, self)))
    }
}
