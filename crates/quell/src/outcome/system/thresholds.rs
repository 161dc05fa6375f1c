//! `thresholds` of a dithered system, and curves of thresholds in two parameters.

use std::fmt::Write as _;

use serde_json::Value as Json;

use super::width_of;
use crate::complaint::Failure;
use crate::dataset::Dataset;
use crate::outcome::Presented;
use crate::outcome::table::figure;
use crate::outcome::thresholds::rows_of_curves;
use crate::picture;
use crate::plot::Figure;
use crate::run::system::curves::{SystemCurves, kind_in_words};
use crate::run::system::thresholds::MotionThresholdsFound;
use crate::run::system::thresholds::STEPS_TRIED;
use crate::run::thresholds::side;
use crate::study::{SystemSetup, SystemStudy};

impl Presented<SystemSetup> for MotionThresholdsFound {
    const TITLED: bool = true;

    fn json(&self, study: &SystemStudy) -> Json {
        self.json(study)
    }

    fn sentence(&self, study: &SystemStudy) -> Option<String> {
        Some(self.sentence(study))
    }

    fn table(&self, study: &SystemStudy) -> String {
        let mut text = String::new();
        let unit = study.unit_of(&self.request.parameter).filter(|unit| *unit != "1");
        let unit = unit.map_or(String::new(), |unit| format!(" {unit}"));
        let thresholds = self.local.iter().flat_map(|local| &local.thresholds);
        let of_runs = self.runs.iter().flat_map(|(_, switches)| &switches.changes);
        let shown = thresholds.map(|found| found.value).chain(of_runs.map(|change| change.value));
        let values = width_of(shown, &unit);
        let found = self.local.iter().flat_map(|local| &local.thresholds);
        let kinds: Vec<(String, _)> =
            found.map(|found| (kind_in_words(study, found.kind, &found.contacts), found)).collect();
        let width = kinds.iter().map(|(kind, _)| kind.chars().count() + 2).fold(16, usize::max);
        for (kind, found) in kinds {
            let value = figure(found.value) + &unit;
            let sides = format!("{} below, {} above", side(found.was), side(found.becomes));
            let _ = writeln!(text, "  {value:<values$}{kind:<width$}{sides}");
        }
        for (protocol, switches) in &self.runs {
            let _ = writeln!(
                text,
                "run {} (at {} values; a pair of changes between two of them is missed):",
                protocol.words(study),
                STEPS_TRIED + 1
            );
            let first = figure(self.request.window.0) + &unit;
            let _ = writeln!(text, "  {first:<values$}{}", self.words(&switches.first));
            for change in &switches.changes {
                let value = figure(change.value) + &unit;
                let kind = change.kind.map_or_else(
                    || format!("± {}", figure(change.error)),
                    |kind| kind.name().to_owned(),
                );
                let _ = writeln!(
                    text,
                    "  {value:<values$}{kind:<16}{} above",
                    self.words(&change.becomes)
                );
            }
        }
        text
    }

    fn datasets(&self, study: &SystemStudy) -> Vec<(&'static str, Dataset)> {
        self.dataset(study).map(|dataset| ("branch", dataset)).into_iter().collect()
    }

    fn figure(&self, study: &SystemStudy) -> Option<Result<Figure, Failure>> {
        Some(Ok(picture::system_thresholds::thresholds(study, self)))
    }
}

impl Presented<SystemSetup> for SystemCurves {
    const TITLED: bool = true;

    fn json(&self, study: &SystemStudy) -> Json {
        self.json(study)
    }

    fn sentence(&self, study: &SystemStudy) -> Option<String> {
        Some(self.sentence(study))
    }

    fn table(&self, study: &SystemStudy) -> String {
        let curves = self.found.curves.iter().map(|curve| (self.kind(study, curve), curve));
        let names = [&self.request.along, &self.request.parameter].map(|path| {
            let unit = study.unit_of(path).filter(|unit| *unit != "1");
            unit.map_or_else(|| path.clone(), |unit| format!("{path} ({unit})"))
        });
        rows_of_curves(curves, &names, [&figure, &figure])
    }

    fn datasets(&self, study: &SystemStudy) -> Vec<(&'static str, Dataset)> {
        vec![("curves", self.dataset(study))]
    }

    fn figure(&self, study: &SystemStudy) -> Option<Result<Figure, Failure>> {
        Some(Ok(picture::system_thresholds::curves(study, self)))
    }
}
