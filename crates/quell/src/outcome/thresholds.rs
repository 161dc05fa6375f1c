//! `thresholds`: exact values of a parameter at which the response changes, and curves of thresholds in two parameters.

use std::fmt::Write as _;

use serde_json::Value as Json;

use super::Presented;
use super::table::figure;
use crate::complaint::Failure;
use crate::dataset::Dataset;
use crate::picture;
use crate::plot::Figure;
use crate::run::curves::{Curves, ThresholdCurve, ThresholdCurveEnd};
use crate::run::thresholds::{Signature, TRIED, Thresholds, becomes, side};
use crate::run::varied::Named;
use crate::study::{BeltSetup, BeltStudy};

impl Presented<BeltSetup> for Thresholds {
    fn json(&self, study: &BeltStudy) -> Json {
        self.json(study)
    }

    fn sentence(&self, study: &BeltStudy) -> Option<String> {
        Some(self.sentence(study))
    }

    fn table(&self, study: &BeltStudy) -> String {
        table(study, self)
    }

    fn figure(&self, study: &BeltStudy) -> Option<Result<Figure, Failure>> {
        Some(Ok(picture::thresholds(study, self)))
    }
}

impl Presented<BeltSetup> for Curves {
    fn json(&self, study: &BeltStudy) -> Json {
        self.json(study)
    }

    fn sentence(&self, study: &BeltStudy) -> Option<String> {
        Some(self.sentence(study))
    }

    fn table(&self, study: &BeltStudy) -> String {
        table_of_curves(study, self)
    }

    fn datasets(&self, study: &BeltStudy) -> Vec<(&'static str, Dataset)> {
        vec![("curves", self.dataset(study))]
    }

    fn figure(&self, study: &BeltStudy) -> Option<Result<Figure, Failure>> {
        Some(Ok(picture::curves(study, self)))
    }
}

fn table_of_curves(study: &BeltStudy, done: &Curves) -> String {
    let [parameter, across] = &done.asked;
    let names = [across, parameter].map(|named| named.key().to_owned());
    let figures: [&dyn Fn(f64) -> String; 2] =
        [&|along| figure_at(study, across, along), &|value| figure_at(study, parameter, value)];
    let curves = done.curves.iter().map(|curve| (curve.kind.name().to_owned(), curve));
    rows_of_curves(curves, &names, figures)
}

/// Curves with their kinds in words, some points of each, in the columns of the second and of the first parameter.
pub(super) fn rows_of_curves<'a, S: 'a>(
    curves: impl Iterator<Item = (String, &'a ThresholdCurve<S>)>,
    [x, y]: &[String; 2],
    [along, value]: [&dyn Fn(f64) -> String; 2],
) -> String {
    let mut text = String::new();
    for (kind, curve) in curves {
        let [first, last] = curve.ends.map(ThresholdCurveEnd::name);
        let _ = writeln!(text, "\n{kind}, from one end ({first}) to the other ({last}):");
        let _ = writeln!(text, "  {x:<14}  {y:<14}");
        let every = curve.points.len().div_ceil(12).max(1);
        let last = curve.points.len().saturating_sub(1);
        for (number, point) in curve.points.iter().enumerate() {
            if number % every == 0 || number == last {
                let _ = writeln!(text, "  {:<14}  {:<14}", along(point.along), value(point.value));
            }
        }
    }
    text
}

/// A value of a number of the equations as its key gives it, with its unit in a study with units.
fn figure_at(study: &BeltStudy, named: &Named, value: f64) -> String {
    match named.value(value) {
        (unit, value) if study.scales().is_some() && unit != "1" => {
            format!("{} {unit}", figure(value))
        }
        (_, value) => figure(value),
    }
}

fn table(study: &BeltStudy, done: &Thresholds) -> String {
    let question = &done.question;
    let path = done.asked.key();
    let figure = |value: f64| figure_at(study, &done.asked, value);
    let whole = |value: f64| done.asked.words(study, value);
    let response =
        if study.belt().dithers().is_empty() { "steady sliding" } else { "the base response" };
    let mut text =
        format!("\n{path} from {} to {}, {response}:\n", whole(question.from), whole(question.to));
    for threshold in &done.local.thresholds {
        let _ = writeln!(
            text,
            "  {:<14}  {:<15}  {} below, {} above",
            figure(threshold.value),
            threshold.kind.name(),
            side(threshold.was),
            side(threshold.becomes)
        );
    }
    if done.local.thresholds.is_empty() {
        text.push_str("  no local threshold\n");
    }
    for change in &done.local.changes {
        let words = |signature: &Option<_>| {
            signature.as_ref().map_or_else(|| "none".to_owned(), Signature::words)
        };
        let (below, above) = (words(&change.below), words(&change.above));
        let _ = writeln!(text, "  {:<14}  {below} below, {above} above", figure(change.value));
    }
    for (protocol, switches) in &done.protocols {
        let _ = writeln!(
            text,
            "runs {} (at {} values; a pair of changes between two of them is missed):",
            protocol.name().replace('_', " "),
            TRIED + 1
        );
        let first = becomes(switches.first, done.in_band);
        if switches.changes.is_empty() {
            let _ = writeln!(text, "  {first} at every value of the range");
        } else {
            let _ = writeln!(text, "  {:<14}  {first}", figure(question.from));
        }
        for switch in &switches.changes {
            let value = figure(switch.value);
            let error = if switch.is_close() {
                String::new()
            } else {
                format!(" (± {})", figure(switch.error))
            };
            let _ = writeln!(
                text,
                "  {value:<14}  {} above{error}",
                becomes(switch.becomes, done.in_band)
            );
        }
    }
    text
}
