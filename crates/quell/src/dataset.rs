//! Labelled arrays with units and where they come from; CSV.
//!
//! Arrays lie over the product of the axes, the last axis fastest. CSV is one row a point,
//! axes first, after a header of comment lines (`pandas.read_csv(…, comment="#")`).

use std::fmt::Write as _;

use quell_model::units::{Quantity, Scales};

use crate::fields::PER_VELOCITY;
use crate::study::{Study, Subject};

/// One array with its name and unit.
#[derive(Clone, Debug, PartialEq)]
pub struct Array {
    /// Name, as in JSON.
    pub name: String,
    /// Unit.
    pub unit: String,
    /// Values; NaN only where there is none.
    pub values: Vec<f64>,
    /// Words that the values are codes of; empty where they are numbers.
    pub words: Vec<(u8, &'static str)>,
}

impl Array {
    /// Numbers.
    pub fn new(name: impl Into<String>, unit: impl Into<String>, values: Vec<f64>) -> Self {
        Self { name: name.into(), unit: unit.into(), values, words: Vec::new() }
    }

    /// Codes of words.
    pub fn of_words(name: impl Into<String>, words: Vec<(u8, &'static str)>, codes: &[u8]) -> Self {
        let values = codes.iter().copied().map(f64::from).collect();
        Self { name: name.into(), unit: "word".to_owned(), values, words }
    }

    /// A value as it stands in CSV; empty where there is none.
    fn write(&self, value: f64, text: &mut String) {
        if !self.words.is_empty() {
            let word = self.words.iter().find(|(code, _)| f64::from(*code) == value);
            text.push_str(word.map_or("", |(_, word)| word));
        } else if value.is_finite() {
            // Shortest digits that read back as the same number.
            let _ = write!(text, "{value:?}");
        }
    }
}

/// Where a dataset comes from.
#[derive(Clone, Debug, PartialEq)]
pub struct Provenance {
    /// What was computed, such as `simulate`.
    pub verb: &'static str,
    /// Title of the study.
    pub title: Option<String>,
    /// Text of the study file.
    pub text: String,
    /// Changes made to it, as `path=value`.
    pub changes: Vec<String>,
    /// Further facts, one line each.
    pub facts: Vec<String>,
}

/// Labelled arrays over axes.
#[derive(Clone, Debug, PartialEq)]
pub struct Dataset {
    provenance: Provenance,
    scales: Option<Scales>,
    axes: Vec<Array>,
    arrays: Vec<Array>,
}

impl Dataset {
    /// An empty dataset of a study.
    pub fn new(study: &Study, verb: &'static str) -> Self {
        Self::of(&Subject::from(study), verb)
    }

    /// An empty dataset of a study of whatever it is about.
    pub fn of(study: &Subject, verb: &'static str) -> Self {
        Self {
            provenance: Provenance {
                verb,
                title: study.title().map(str::to_owned),
                text: study.text().to_owned(),
                changes: study.changes().to_vec(),
                facts: Vec::new(),
            },
            scales: study.scales(),
            axes: Vec::new(),
            arrays: Vec::new(),
        }
    }

    /// Adds a fact to the provenance.
    #[must_use]
    pub fn fact(mut self, fact: impl Into<String>) -> Self {
        self.provenance.facts.push(fact.into());
        self
    }

    /// Adds an axis; in a study in SI its twin follows among the arrays where there is one axis.
    #[must_use]
    pub fn axis(mut self, name: &str, quantity: Quantity, values: Vec<f64>) -> Self {
        let twin = self.twin(name, quantity, &values);
        self.axes.push(array(name, quantity, values));
        self.arrays.extend(twin);
        self
    }

    /// Adds an array, and its SI twin in a study in SI.
    #[must_use]
    pub fn array(mut self, name: &str, quantity: Quantity, values: Vec<f64>) -> Self {
        let twin = self.twin(name, quantity, &values);
        self.arrays.push(array(name, quantity, values));
        self.arrays.extend(twin);
        self
    }

    /// Adds slopes per unit velocity, in a study in SI also per m/s.
    #[must_use]
    pub fn per_velocity(mut self, name: &str, values: Vec<f64>) -> Self {
        let (unit, si_unit, suffix) = PER_VELOCITY;
        let twin = self.scales.map(|scales| {
            let omega = scales.si_per_unit(Quantity::Velocity);
            let values = values.iter().map(|value| value / omega).collect();
            Array::new(format!("{name}_{suffix}"), si_unit, values)
        });
        self.arrays.push(Array::new(name, unit, values));
        self.arrays.extend(twin);
        self
    }

    /// Adds an axis as it is.
    #[must_use]
    pub fn with_axis(mut self, axis: Array) -> Self {
        self.axes.push(axis);
        self
    }

    /// Adds an array as it is.
    #[must_use]
    pub fn with(mut self, array: Array) -> Self {
        self.arrays.push(array);
        self
    }

    /// The axes.
    pub fn axes(&self) -> &[Array] {
        &self.axes
    }

    /// The arrays.
    pub fn arrays(&self) -> &[Array] {
        &self.arrays
    }

    /// Where it comes from, the axes, and the arrays: what hands them on without copying.
    pub fn into_parts(self) -> (Provenance, Vec<Array>, Vec<Array>) {
        (self.provenance, self.axes, self.arrays)
    }

    /// Where it comes from.
    pub fn provenance(&self) -> &Provenance {
        &self.provenance
    }

    fn twin(&self, name: &str, quantity: Quantity, values: &[f64]) -> Option<Array> {
        let (unit, suffix) = quantity.si_unit()?;
        let factor = self.scales?.si_per_unit(quantity);
        let values = values.iter().map(|value| value * factor).collect();
        Some(Array::new(format!("{name}_{suffix}"), unit, values))
    }

    /// As CSV.
    pub fn csv(&self) -> String {
        let mut text = self.header();
        let names: Vec<&str> =
            self.axes.iter().chain(&self.arrays).map(|array| array.name.as_str()).collect();
        text += &names.join(",");
        text.push('\n');
        let rows: usize = self.axes.iter().map(|axis| axis.values.len()).product();
        for row in 0..rows {
            let mut after = rows;
            let axes = self.axes.iter().map(|axis| {
                after /= axis.values.len();
                (axis, axis.values[row / after % axis.values.len()])
            });
            let value = |array: &Array| array.values.get(row).copied().unwrap_or(f64::NAN);
            let arrays = self.arrays.iter().map(|array| (array, value(array)));
            for (index, (array, value)) in axes.chain(arrays).enumerate() {
                if index > 0 {
                    text.push(',');
                }
                array.write(value, &mut text);
            }
            text.push('\n');
        }
        text
    }

    fn header(&self) -> String {
        let Provenance { verb, title, text, changes, facts } = &self.provenance;
        let mut lines = vec![format!("quell {} {verb}", env!("CARGO_PKG_VERSION"))];
        lines.extend(
            title.iter().map(|title| format!("title: {}", title.replace(['\n', '\r'], " "))),
        );
        lines.extend(facts.iter().cloned());
        let units: Vec<String> = self
            .axes
            .iter()
            .chain(&self.arrays)
            .map(|array| format!("{} [{}]", array.name, array.unit))
            .collect();
        lines.push(format!("units: {}", units.join(", ")));
        lines.extend(changes.iter().map(|change| format!("changed: {change}")));
        lines.push("study:".to_owned());
        lines.extend(text.lines().map(|line| format!("  {line}")));
        lines.iter().fold(String::new(), |mut header, line| {
            header.push_str("# ");
            header.push_str(line.trim_end());
            header.push('\n');
            header
        })
    }
}

fn array(name: &str, quantity: Quantity, values: Vec<f64>) -> Array {
    Array::new(name, quantity.scaled_unit(), values)
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "schema = 1\n[belt]\ndamping_ratio = 0\nnormal_load = 1\nbelt_velocity = 1\n\
        [friction]\nlaw = \"stribeck\"\nstatic_coefficient = 0.4\nminimum_coefficient = 0.2\n\
        reference_velocity = 1\n";

    #[test]
    fn rows_run_through_the_product_of_the_axes() {
        let study = Study::parse(TEXT, &[]).expect("valid");
        let csv = Dataset::new(&study, "map")
            .axis("a", Quantity::Ratio, vec![1.0, 2.0])
            .axis("b", Quantity::Ratio, vec![0.1, 0.2, 0.3])
            .array("c", Quantity::Force, vec![1.0, 2.0, 3.0, 4.0, f64::NAN, 1e-300])
            .csv();
        let rows: Vec<&str> = csv.lines().filter(|line| !line.starts_with('#')).collect();
        assert_eq!(rows[0], "a,b,c");
        assert_eq!(rows[1], "1.0,0.1,1.0");
        assert_eq!(rows[5], "2.0,0.2,");
        assert_eq!(rows[6], "2.0,0.3,1e-300");
        assert!(csv.contains("# units: a [1], b [1], c [length (force/k)]"));
        assert!(csv.contains("#   normal_load = 1\n"));
    }
}
