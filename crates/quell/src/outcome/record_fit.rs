//! `fit --record`: numbers of a study with standard errors, what the record does not determine, and tables for the study.

use std::fmt::Write as _;

use serde_json::{Value as Json, json};

use super::Outcome;
use super::estimates::{explained_in_words, in_words, numbers, parameters, rows};
use super::read_file::{read, read_in_words};
use crate::complaint::Failure;
use crate::dataset::{Array, Dataset};
use crate::fields::Fields;
use crate::input::Inputs;
use crate::picture;
use crate::plot::Figure;
use crate::run::record_fit::{FreeNumber, RecordFit};
use crate::words::{digits, listed};

/// How derivatives by numbers of a study are computed.
const DERIVATIVES: &str =
    "central differences of exact trajectories; by shift, offset and gain exact";

impl Outcome for RecordFit {
    fn inputs(&self) -> Inputs {
        self.study.inputs().with_files([self.record.path()])
    }

    fn name(&self) -> &'static str {
        "record-fit"
    }

    fn json(&self) -> Json {
        let unit = self.record.unit.unwrap_or("1");
        let mut fields = Fields::new();
        fields.plain("ok", true).plain("sentence", sentence(self));
        fields.nested("parameters", parameters(&self.named, |_| true));
        numbers(&mut fields, &self.named, unit);
        fields
            .plain("converged", self.converged)
            .plain("derivatives", DERIVATIVES)
            .plain("starts", self.tried)
            .plain("file", self.record.path().display().to_string())
            .plain("columns", self.record.columns.to_vec())
            .plain("read", read(&self.record.read))
            .plain("recorded_quantity", self.record.quantity.name());
        match shift_counts_from(self) {
            Some(words) => fields.plain("shift_from", words),
            None => fields
                .unknown("shift_from", "the shift is not free: the record begins with the run"),
        };
        let others = self.others.iter().map(|other| {
            let mut entry = Fields::new();
            let mut values = Fields::new();
            for (parameter, value) in self.named.parameters.iter().zip(&other.values) {
                values.measured(&parameter.name, &parameter.unit, *value);
            }
            entry.nested("parameters", values).measured("rss", "1", other.rss);
            entry
        });
        fields.list("other_minima", others.collect::<Vec<_>>());
        let weak: Vec<Json> = self
            .named
            .estimates
            .weak
            .iter()
            .map(|weak| {
                let shares: Vec<Json> = weak
                    .shares
                    .iter()
                    .map(|(place, share)| json!({ "name": self.named.parameters[*place].name, "share": share }))
                    .collect();
                json!({ "ratio": weak.ratio, "combination": shares })
            })
            .collect();
        fields.plain("not_determinable", weak);
        let (numbers, uncertainty) = self.fragments();
        fields.plain("tables", json!({ "numbers": numbers, "uncertainty": uncertainty }));
        fields.plain("warnings", self.warnings());
        fields.finish()
    }

    fn title(&self) -> Option<&str> {
        self.study.title()
    }

    fn sentence(&self) -> Option<String> {
        Some(sentence(self))
    }

    fn table(&self) -> String {
        let mut text = rows(&self.named, |_| true);
        if let Some(words) = shift_counts_from(self) {
            let _ = writeln!(text, "  record.shift counts from {words}");
        }
        if let Some(said) = read_in_words(&self.record.read) {
            let _ = writeln!(text, "  {said}");
        }
        let (numbers, uncertainty) = self.fragments();
        for part in [numbers, uncertainty] {
            if !part.is_empty() {
                let _ = write!(text, "\n{part}");
            }
        }
        text
    }

    fn datasets(&self) -> Vec<(&'static str, Dataset)> {
        let unit = self.record.unit.unwrap_or("1");
        let dataset = Dataset::of(&self.fitted_study, "fit --record")
            .fact(format!("data: {}", self.record.path().display()))
            .with_axis(Array::new(
                "time",
                self.record.time_unit.unwrap_or("1"),
                self.record.times.clone(),
            ))
            .with(Array::new("measured", unit, self.record.values.clone()))
            .with(Array::new("fitted", unit, self.values.clone()))
            .with(Array::new("point_residual", unit, self.residuals()));
        vec![("record", dataset)]
    }

    fn figure(&self) -> Option<Result<Figure, Failure>> {
        Some(Ok(picture::record_fit(self)))
    }
}

/// Where a free shift counts from.
fn shift_counts_from(done: &RecordFit) -> Option<&'static str> {
    done.free.contains(&FreeNumber::Shift).then_some(if done.from_highest {
        "the highest displacement after settling"
    } else {
        "the end of the settling time"
    })
}

fn sentence(done: &RecordFit) -> String {
    let values: Vec<String> =
        (0..done.free.len()).map(|place| in_words(&done.named, place)).collect();
    let (count, quantity) = (done.record.times.len(), done.record.quantity.name());
    let residual = digits(done.named.estimates.residual());
    let (values, share) = (listed(&values), explained_in_words(&done.named));
    match share {
        Some(share) if !done.named.estimates.explain() => format!(
            "The study does not explain the record: the explained share of the variance of {count} samples of the {quantity} is {share}, \
             with a residual standard deviation of {residual}. The values of the least sum of squares have no standard errors: {values}."
        ),
        Some(share) => format!(
            "{count} samples of the {quantity} are fitted with a residual standard deviation of {residual}, which explains {share} of \
             their variance: {values}."
        ),
        None => format!(
            "{count} samples of the {quantity} are fitted with a residual standard deviation of {residual}: {values}."
        ),
    }
}
