//! `basins`: the motion on which each start ends.

use std::fmt::Write as _;

use quell_model::units::Quantity;
use serde_json::Value as Json;

use super::Presented;
use super::table::{figure, figure_in_units};
use crate::complaint::Failure;
use crate::dataset::Dataset;
use crate::picture;
use crate::plot::Figure;
use crate::run::basins::{Basins, Portrait, Share, quiescence};
use crate::run::system::attractor::in_words;
use crate::study::{SystemSetup, SystemStudy};

impl Presented<SystemSetup> for Basins {
    const NAME: &'static str = "basins";
    const TITLED: bool = true;

    fn json(&self, study: &SystemStudy) -> Json {
        self.json(study)
    }

    fn sentence(&self, study: &SystemStudy) -> Option<String> {
        Some(self.sentence(study))
    }

    fn notes(&self, study: &SystemStudy) -> Vec<String> {
        self.notes(study)
    }

    fn table(&self, study: &SystemStudy) -> String {
        let mut text = format!("  {}\n", self.starts_in_words(study));
        match (&self.over, self.portraits.as_slice()) {
            (None, [portrait]) => text += &motions(study, portrait),
            (over, portraits) => {
                let path = over.as_ref().map_or("", |over| over.parameter.as_str());
                let width = path.len().max(18);
                let [_, fall] = quiescence(self.in_band());
                let _ = writeln!(
                    text,
                    "\n  {path:<width$}  {:<15}share of starts that {fall}",
                    "stability"
                );
                for portrait in portraits {
                    let value = portrait.value.map_or_else(String::new, figure);
                    let local = portrait.local.as_ref().map_or("unknown", |verdict| *verdict);
                    let share = portrait.quiet.map_or_else(|| "unknown".to_owned(), Share::percent);
                    let _ = writeln!(text, "  {value:<width$}  {local:<15}{share}");
                }
            }
        }
        let _ = writeln!(text, "  bounds: {}", self.meaning());
        text
    }

    fn datasets(&self, study: &SystemStudy) -> Vec<(&'static str, Dataset)> {
        vec![("basins", self.dataset(study))]
    }

    fn figure(&self, study: &SystemStudy) -> Option<Result<Figure, Failure>> {
        Some(picture::basins(study, self))
    }
}

fn motions(study: &SystemStudy, portrait: &Portrait) -> String {
    let mut text = String::new();
    for basin in &portrait.basins {
        let (share, attractor) = (basin.share, &basin.attractor);
        let quiet = match (attractor.quiet, portrait.in_band) {
            (false, _) => "",
            (true, true) => "in step with the dither, ",
            (true, false) => "quiet, ",
        };
        let stick = attractor.stick.iter().map(|share| figure(*share)).collect::<Vec<_>>();
        let _ = writeln!(
            text,
            "  {:>6.2} % ({:.2} to {:.2})  {quiet}{}, peak-to-peak {}, stick fraction {}",
            100.0 * share.fraction,
            100.0 * share.low,
            100.0 * share.high,
            in_words(attractor, study.units()),
            figure_in_units(study.units(), Quantity::Displacement, attractor.size()),
            if stick.is_empty() { "0".to_owned() } else { stick.join(", ") },
        );
    }
    if portrait.unknown.starts > 0 {
        let _ = writeln!(text, "  {:>6.2} % outcome unknown", 100.0 * portrait.unknown.fraction);
    }
    text
}
