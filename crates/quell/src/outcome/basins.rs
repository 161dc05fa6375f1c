//! `basins`: the response on which each start ends.

use std::fmt::Write as _;

use quell_model::units::Quantity;
use serde_json::Value as Json;

use super::Presented;
use super::table::{figure, figure_of};
use crate::complaint::Failure;
use crate::dataset::Dataset;
use crate::picture;
use crate::plot::Figure;
use crate::run::attractor::words;
use crate::run::basins::{Basins, Portrait, quiescence};
use crate::study::{BeltSetup, BeltStudy};

impl Presented<BeltSetup> for Basins {
    const TITLED: bool = true;

    fn json(&self, study: &BeltStudy) -> Json {
        self.json(study)
    }

    fn sentence(&self, study: &BeltStudy) -> Option<String> {
        Some(self.sentence(study))
    }

    fn table(&self, study: &BeltStudy) -> String {
        table(study, self)
    }

    fn datasets(&self, study: &BeltStudy) -> Vec<(&'static str, Dataset)> {
        vec![("basins", self.dataset(study))]
    }

    fn figure(&self, study: &BeltStudy) -> Option<Result<Figure, Failure>> {
        Some(picture::basins(study, self))
    }
}

fn table(study: &BeltStudy, done: &Basins) -> String {
    let mut text = String::new();
    let _ = writeln!(text, "  {}", done.starts_in_words(study));
    match (&done.varied, done.portraits.as_slice()) {
        (None, [portrait]) => text += &attractors(study, portrait),
        (varied, portraits) => {
            let path = varied.as_ref().map_or("", |varied| varied.path.as_str());
            let [_, fall] = quiescence(done.in_band());
            let _ = writeln!(text, "\n  {path:<18}  base response   share of starts that {fall}");
            for portrait in portraits {
                let value = portrait.value.map_or_else(String::new, figure);
                let local = portrait.local.as_ref().map_or("unknown", |verdict| verdict.name());
                let share = portrait.quiet.map_or_else(
                    || "unknown".to_owned(),
                    |share| {
                        format!(
                            "{} ({} to {})",
                            figure(share.fraction),
                            figure(share.low),
                            figure(share.high)
                        )
                    },
                );
                let _ = writeln!(text, "  {value:<18}  {local:<14}  {share}");
            }
        }
    }
    let _ = writeln!(text, "  bounds: {}", done.meaning());
    text
}

fn attractors(study: &BeltStudy, portrait: &Portrait) -> String {
    let mut text = String::new();
    for (basin, share) in portrait.gathered.basins.iter().zip(&portrait.shares) {
        let attractor = &basin.attractor;
        let quiet = portrait.quiet_word(attractor);
        let quiet = quiet.map_or_else(String::new, |word| format!("{word}, "));
        let _ = writeln!(
            text,
            "  {:>6.2} % ({:.2} to {:.2})  {quiet}{}, peak-to-peak {}, stick fraction {}",
            100.0 * share.fraction,
            100.0 * share.low,
            100.0 * share.high,
            words(portrait.scales, attractor, portrait.period),
            figure_of(study, Quantity::Displacement, attractor.size()),
            figure(attractor.stick_fraction),
        );
    }
    text
}
