//! `design`: the least dither over a box of operating points.

use std::fmt::Write as _;

use serde_json::Value as Json;

use super::Presented;
use super::table::figure;
use crate::complaint::Failure;
use crate::dataset::{Array, Dataset};
use crate::picture;
use crate::plot::Figure;
use crate::run::design::LeastDitherFound;
use crate::run::waveforms::label;
use crate::study::{BeltSetup, BeltStudy};

impl Presented<BeltSetup> for LeastDitherFound {
    fn json(&self, study: &BeltStudy) -> Json {
        self.json(study)
    }

    fn sentence(&self, study: &BeltStudy) -> Option<String> {
        Some(self.sentence(study))
    }

    fn table(&self, _: &BeltStudy) -> String {
        let mut text = String::new();
        let numbers = [&self.amplitude].into_iter().chain(&self.others);
        let numbers: Vec<_> = numbers.collect();
        let _ = write!(text, "  {:<12}  {:<10}", "waveform", "method");
        for number in &numbers {
            let _ = write!(text, "  {:>24}", number.path);
        }
        text.push('\n');
        let mut line = |waveform: &str, method: &str, values: &[f64]| {
            let _ = write!(text, "  {waveform:<12}  {method:<10}");
            for (number, value) in numbers.iter().zip(values) {
                let _ = write!(text, "  {:>24}", figure(value * number.per_unit));
            }
            text.push('\n');
        };
        for (waveform, designed) in &self.waveforms {
            let name = label(waveform);
            match &designed.answer {
                Ok(found) => {
                    let row = |amplitude: f64, others: &[f64]| [&[amplitude], others].concat();
                    let (critical, averaged) = (&found.critical, &found.averaged);
                    line(&name, "exact", &row(critical.amplitude, &critical.others));
                    line(&name, "averaging", &row(averaged.amplitude, &averaged.others));
                }
                Err(_) => line(&name, "none", &[]),
            }
        }
        text
    }

    fn datasets(&self, study: &BeltStudy) -> Vec<(&'static str, Dataset)> {
        let tried = &self.answer().tried;
        let axis = (0..tried.len()).map(|number| number as f64).collect();
        let mut dataset = Dataset::new(study, "design")
            .fact(self.sentence(study))
            .with_axis(Array::new("number", "1", axis));
        let amplitudes = tried.iter().map(|point| point.amplitude * self.amplitude.per_unit);
        dataset = dataset.with(Array::new("amplitude", "given", amplitudes.collect()));
        for (place, number) in self.others.iter().enumerate() {
            let values = tried.iter().map(|point| point.others[place] * number.per_unit);
            let name = number.path.replace(['.', '['], "_").replace(']', "");
            dataset = dataset.with(Array::new(&name, "given", values.collect()));
        }
        let used = tried.iter().map(|point| {
            let used = point.use_of_limits();
            if used.is_finite() { used } else { f64::NAN }
        });
        vec![("design", dataset.with(Array::new("used", "1", used.collect())))]
    }

    fn figure(&self, study: &BeltStudy) -> Option<Result<Figure, Failure>> {
        Some(Ok(picture::design(study, self)))
    }
}
