//! `thresholds`: values of a parameter at which the response changes, and curves of thresholds in two parameters.

use std::fmt::Write as _;

use quell_dynamics::orbit::ThresholdCurveEnd;
use quell_numerics::interval::RealInterval;
use serde_json::Value as Json;

use super::Presented;
use super::system::width_of;
use super::table::figure;
use crate::complaint::Failure;
use crate::dataset::Dataset;
use crate::picture;
use crate::plot::Figure;
use crate::run::thresholds::curves::{Curves, kind_in_words};
use crate::run::thresholds::{TRIED, Thresholds, events_in_words, side};
use crate::study::{SystemSetup, SystemStudy};
use crate::words::{capital, quantity_at, unit_after};

impl Presented<SystemSetup> for Thresholds {
    const NAME: &'static str = "thresholds";
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
        let unit = unit_after(study.unit_of(&self.request.parameter));
        let RealInterval { lower: from, upper: to } = self.request.window;
        let number = capital(&quantity_at(&self.request.parameter));
        let [from, to] = [from, to].map(|value| format!("{}{unit}", figure(value)));
        let mut text = format!("\n{number} from {from} to {to}, {}:\n", self.subject());
        if self.local.as_ref().is_ok_and(|local| local.thresholds.is_empty()) {
            text += "  no local threshold\n";
        }
        let thresholds = self.local.iter().flat_map(|local| &local.thresholds);
        let of_runs = self.runs.iter().flat_map(|(_, switches)| &switches.changes);
        let of_events = self.local.iter().flat_map(|local| &local.changes);
        let shown = thresholds
            .map(|found| found.value)
            .chain(of_runs.map(|change| change.value))
            .chain(of_events.map(|change| change.value));
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
        let changes: Vec<_> = self.local.iter().flat_map(|local| &local.changes).collect();
        if !changes.is_empty() {
            text.push_str("events in a period:\n");
        }
        for change in changes {
            let value = figure(change.value) + &unit;
            let [below, above] =
                [&change.below, &change.above].map(|side| events_in_words(study, side.as_ref()));
            let _ = writeln!(text, "  {value:<values$}{below} below, {above} above");
        }
        for (protocol, switches) in &self.runs {
            let _ = writeln!(
                text,
                "run {} (at {} values; a pair of changes between two of them may be missed):",
                protocol.words(study),
                TRIED + 1
            );
            let first = figure(self.request.window.lower) + &unit;
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
        Some(Ok(picture::thresholds(study, self)))
    }
}

impl Presented<SystemSetup> for Curves {
    const NAME: &'static str = "threshold-curves";
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
        let [x, y] = [&self.request.along, &self.request.parameter].map(|path| {
            let unit = study.unit_of(path).filter(|unit| *unit != "1");
            unit.map_or_else(|| path.clone(), |unit| format!("{path} ({unit})"))
        });
        let mut text = String::new();
        for curve in &self.found.curves {
            let ([first, last], kind) =
                (curve.ends.map(ThresholdCurveEnd::name), self.kind(study, curve));
            let _ = writeln!(text, "\n{kind}, from one end ({first}) to the other ({last}):");
            let _ = writeln!(text, "  {x:<14}  {y:<14}");
            let every = curve.points.len().div_ceil(12).max(1);
            let last = curve.points.len().saturating_sub(1);
            for (number, point) in curve.points.iter().enumerate() {
                if number % every == 0 || number == last {
                    let [along, value] = [point.along, point.value].map(figure);
                    let _ = writeln!(text, "  {along:<14}  {value:<14}");
                }
            }
        }
        text
    }

    fn datasets(&self, study: &SystemStudy) -> Vec<(&'static str, Dataset)> {
        vec![("curves", self.dataset(study))]
    }

    fn figure(&self, study: &SystemStudy) -> Option<Result<Figure, Failure>> {
        Some(Ok(picture::curves(study, self)))
    }
}
