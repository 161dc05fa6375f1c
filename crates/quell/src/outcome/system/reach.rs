//! `resonances` of a system.

use std::fmt::Write as _;

use serde_json::Value as Json;

use crate::complaint::Failure;
use crate::dataset::Dataset;
use crate::outcome::Presented;
use crate::outcome::table::{NumberColumns, figure, frequency_heading, heading};
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
        let (frequency, factor) = frequency_heading(study.units());
        let unit = match study.units() {
            UnitSystem::None => None,
            UnitSystem::Si => Some("(m/s)/N"),
            UnitSystem::MmTonneSecond => Some("(mm/s)/N"),
        };
        let slip = heading("slip velocity per dither", unit);
        let (columns, headings) = NumberColumns::under(&[frequency, slip.as_str()]);
        for pair in &self.pairs {
            let contact = &study.system().contacts[pair.contact].name;
            let _ = writeln!(text, "  contact {contact}, dither[{}]", pair.dither);
            let _ = writeln!(text, "{headings}");
            for at in &pair.extremes {
                let kind = match (at.peak, at.out_of_reach) {
                    (true, _) => "resonance",
                    (false, false) => "minimum",
                    (false, true) => "antiresonance, out of reach",
                };
                let frequency = figure(factor * at.frequency);
                let _ = match at.slip_per_amplitude {
                    Some(slip) => {
                        writeln!(text, "{}  {kind}", columns.line(&[frequency, figure(slip)]))
                    }
                    None => writeln!(text, "{}  {UNBOUNDED_RESONANCE}", columns.line(&[frequency])),
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
