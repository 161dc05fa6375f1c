//! `design`: the least dither over a box of operating points.

use std::fmt::Write as _;

use serde_json::Value as Json;

use super::Presented;
use super::table::figure;
use crate::complaint::Failure;
use crate::dataset::{Array, Dataset};
use crate::picture;
use crate::plot::Figure;
use crate::run::design::{DesignedDither, LeastDitherFound};
use crate::study::{DiscSetup, DiscStudy, SystemSetup, SystemStudy};

impl Presented<SystemSetup> for LeastDitherFound {
    const NAME: &'static str = "design";
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

    fn table(&self, _: &SystemStudy) -> String {
        table(self)
    }

    fn datasets(&self, study: &SystemStudy) -> Vec<(&'static str, Dataset)> {
        let dataset = Dataset::of(&study.into(), "design").fact(self.sentence(study));
        vec![("design", choices(self, dataset))]
    }

    fn figure(&self, study: &SystemStudy) -> Option<Result<Figure, Failure>> {
        Some(Ok(picture::design(study, self)))
    }
}

impl Presented<DiscSetup> for LeastDitherFound {
    const NAME: &'static str = "design";
    const TITLED: bool = true;

    fn json(&self, study: &DiscStudy) -> Json {
        self.json(study)
    }

    fn sentence(&self, study: &DiscStudy) -> Option<String> {
        Some(self.sentence(study))
    }

    fn notes(&self, study: &DiscStudy) -> Vec<String> {
        self.notes(study)
    }

    fn table(&self, _: &DiscStudy) -> String {
        table(self)
    }

    fn datasets(&self, study: &DiscStudy) -> Vec<(&'static str, Dataset)> {
        let dataset = Dataset::of(&study.into(), "design").fact(self.sentence(study));
        vec![("design", choices(self, dataset))]
    }

    fn figure(&self, study: &DiscStudy) -> Option<Result<Figure, Failure>> {
        Some(Ok(picture::disc_design(study, self)))
    }
}

/// The exact and the averaged least dither of every waveform.
fn table(found: &LeastDitherFound) -> String {
    let mut text = String::new();
    let numbers: Vec<_> = [&found.amplitude].into_iter().chain(&found.others).collect();
    let labels: Vec<String> = found.tried.iter().map(DesignedDither::label).collect();
    let width = labels.iter().map(|label| label.chars().count()).max().unwrap_or(0).max(12);
    let _ = write!(text, "  {:<width$}  {:<10}", "waveform", "method");
    for number in &numbers {
        let _ = write!(text, "  {:>24}", number.path);
    }
    text.push('\n');
    let mut line = |waveform: &str, method: &str, values: &[f64]| {
        let _ = write!(text, "  {waveform:<width$}  {method:<10}");
        for (number, value) in numbers.iter().zip(values) {
            let _ = write!(text, "  {:>24}", figure(value * number.per_unit));
        }
        text.push('\n');
    };
    for (tried, name) in found.tried.iter().zip(&labels) {
        match &tried.designed.answer {
            Ok(found) => {
                let row = |amplitude: f64, others: &[f64]| [&[amplitude], others].concat();
                let (critical, averaged) = (&found.critical, &found.averaged);
                line(name, "exact", &row(critical.amplitude, &critical.others));
                line(name, "averaging", &row(averaged.amplitude, &averaged.others));
            }
            Err(_) => line(name, "none", &[]),
        }
    }
    text
}

/// Every choice that was tried.
fn choices(found: &LeastDitherFound, dataset: Dataset) -> Dataset {
    let tried = &found.answer().tried;
    let axis = (0..tried.len()).map(|number| number as f64).collect();
    let mut dataset = dataset.with_axis(Array::new("number", "1", axis));
    let amplitudes = tried.iter().map(|point| point.amplitude * found.amplitude.per_unit);
    dataset = dataset.with(Array::new("amplitude", "given", amplitudes.collect()));
    for (place, number) in found.others.iter().enumerate() {
        let values = tried.iter().map(|point| point.others[place] * number.per_unit);
        let name = number.path.replace(['.', '['], "_").replace(']', "");
        dataset = dataset.with(Array::new(&name, "given", values.collect()));
    }
    let used = tried.iter().map(|point| {
        let used = point.use_of_limits();
        if used.is_finite() { used } else { f64::NAN }
    });
    dataset.with(Array::new("used", "1", used.collect()))
}
