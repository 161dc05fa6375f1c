//! `resonances` of a system.

use std::fmt::Write as _;

use serde_json::Value as Json;

use crate::complaint::Failure;
use crate::dataset::Dataset;
use crate::outcome::Presented;
use crate::outcome::table::figure;
use crate::picture;
use crate::plot::Figure;
use crate::run::system::reach::Reaches;
use crate::study::{SystemSetup, SystemStudy};

impl Presented<SystemSetup> for Reaches {
    const TITLED: bool = true;

    fn json(&self, study: &SystemStudy) -> Json {
        self.json(study)
    }

    fn sentence(&self, study: &SystemStudy) -> Option<String> {
        Some(self.sentence(study))
    }

    fn table(&self, study: &SystemStudy) -> String {
        let mut text = String::new();
        for pair in &self.pairs {
            let contact = &study.system().contacts[pair.contact].name;
            for at in &pair.extremes {
                let kind = if at.peak { "reaches best" } else { "reaches least" };
                let _ = writeln!(
                    text,
                    "  dither {} {kind} contact {contact} at {}: slip {} per unit of dither{}",
                    pair.dither,
                    figure(at.frequency),
                    figure(at.slip_per_amplitude),
                    if at.out_of_reach { ", out of reach" } else { "" }
                );
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
