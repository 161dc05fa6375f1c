//! `stability --parameter` and `thresholds` of a system.

use std::fmt::Write as _;

use serde_json::Value as Json;

use super::width_of;
use crate::complaint::Failure;
use crate::dataset::Dataset;
use crate::outcome::Presented;
use crate::outcome::table::figure;
use crate::picture;
use crate::plot::Figure;
use crate::run::system::tracked::TrackedStability;
use crate::study::{SystemSetup, SystemStudy};
use crate::words::{plural, unit_after};
use quell_linear::growth::Verdict;

impl Presented<SystemSetup> for TrackedStability {
    const NAME: &'static str = "tracked-stability";
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
        let mut text = String::new();
        let unit = unit_after(study.unit_of(&self.request.parameter));
        let shown = self.tracked.thresholds.iter().map(|found| found.value);
        let shown = shown.chain(self.rests.iter().map(|rest| rest.value));
        let values = width_of(shown, &unit);
        let mut rests = self.rests.iter().peekable();
        let mut comes_to_rest = |text: &mut String, until: f64| {
            while let Some(rest) = rests.next_if(|rest| rest.value <= until) {
                let value = figure(rest.value) + &unit;
                let _ = writeln!(text, "  {value:<values$}{:<13}contact {}", "rest", rest.contact);
            }
        };
        for found in &self.tracked.thresholds {
            comes_to_rest(&mut text, found.value);
            let [before, beyond] = found.verdicts.map(Verdict::name);
            let verdicts = if before == beyond {
                format!("{before} on both sides")
            } else {
                format!("{before} below, {beyond} above")
            };
            let value = figure(found.value) + &unit;
            let _ = writeln!(text, "  {value:<values$}{:<13}{verdicts}", found.change.name());
        }
        comes_to_rest(&mut text, f64::INFINITY);
        for curve in &self.curves {
            let ends = curve.points.first().zip(curve.points.last());
            if let Some(((first, at_first), (last, at_last))) = ends {
                let _ = writeln!(
                    text,
                    "  curve ({}): from {} at {} to {} at {}, {} point{}",
                    at_first.change.name(),
                    figure(at_first.value),
                    figure(*first),
                    figure(at_last.value),
                    figure(*last),
                    curve.points.len(),
                    plural(curve.points.len())
                );
            }
        }
        text
    }

    fn datasets(&self, study: &SystemStudy) -> Vec<(&'static str, Dataset)> {
        let curves = self.dataset_of_curves(study).map(|curves| ("curves", curves));
        let eigenvalues = ("eigenvalues", self.dataset(study));
        // With a second parameter, the curves are the main answer.
        curves.into_iter().chain([eigenvalues]).collect()
    }

    fn figure(&self, study: &SystemStudy) -> Option<Result<Figure, Failure>> {
        Some(Ok(picture::system::tracked(study, self)))
    }
}
