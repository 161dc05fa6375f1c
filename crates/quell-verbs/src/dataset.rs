//! Labelled arrays with units and provenance, and their CSV form.
//!
//! Arrays have one value per point of the product of the axes, the last axis fastest. CSV has one row per point, axes first,
//! after a header of comment lines (`pandas.read_csv(…, comment="#")`).
//!
//! Numbers are in the units of the study: in SI if the study is in SI. Units are machine-readable (`m/s`, `dimensionless`);
//! the scale of a dimensionless number is given separately.

use std::fmt::Write as _;
use std::path::Path;

use quell_model::units::Quantity;

use crate::fields::PER_VELOCITY;
use crate::study::{Study, UnitSystem};

/// One array with its name and unit.
#[derive(Clone, Debug, PartialEq)]
pub struct Array {
    /// Name, as in JSON.
    pub name: String,
    /// Unit, as unit packages such as pint read it.
    pub unit: String,
    /// The scale of a dimensionless number of the equations, such as `1/ω₀`; empty if it has none.
    pub scaling: String,
    /// Values; NaN only where a value is missing.
    pub values: Vec<f64>,
    /// Words with their codes if the values are codes; empty if they are numbers.
    pub words: Vec<(u8, String)>,
}

impl Array {
    /// An array of numbers.
    pub fn new(name: impl Into<String>, unit: impl Into<String>, values: Vec<f64>) -> Self {
        let (unit, scaling) = readable(&unit.into());
        Self { name: name.into(), unit, scaling, values, words: Vec::new() }
    }

    /// An array of codes of words.
    pub fn of_words(name: impl Into<String>, words: Vec<(u8, &'static str)>, codes: &[u8]) -> Self {
        let values = codes.iter().copied().map(f64::from).collect();
        let words = words.into_iter().map(|(code, word)| (code, word.to_owned())).collect();
        Self { words, ..Self::new(name, "1", values) }
    }

    /// An axis of names, of which there are at most 256.
    pub fn of_names(name: impl Into<String>, names: &[String]) -> Self {
        let words: Vec<(u8, String)> = (0..=u8::MAX).zip(names.iter().cloned()).collect();
        let codes = words.iter().map(|(code, _)| f64::from(*code)).collect();
        Self { words, ..Self::new(name, "1", codes) }
    }

    /// Appends a value in its CSV form; nothing if it is missing.
    fn write(&self, value: f64, text: &mut String) {
        if !self.words.is_empty() {
            let word = self.words.iter().find(|(code, _)| f64::from(*code) == value);
            text.push_str(word.map_or("", |(_, word)| word.as_str()));
        } else if value.is_finite() {
            // Shortest digits that read back as the same number.
            let _ = write!(text, "{value:?}");
        }
    }
}

/// Provenance of a dataset.
#[derive(Clone, Debug, PartialEq)]
pub struct Provenance {
    /// The verb that computed it, such as `simulate`.
    pub verb: &'static str,
    /// Title of the study.
    pub title: Option<String>,
    /// Text of the study file; empty for an answer without a study.
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
    /// The units of the study; `None` of numbers that belong to no study, or to the equations of a disc.
    units: Option<UnitSystem>,
    axes: Vec<Array>,
    arrays: Vec<Array>,
}

impl Dataset {
    /// An empty dataset of a study of any kind.
    pub fn of(study: &Study, verb: &'static str) -> Self {
        Self {
            provenance: Provenance {
                verb,
                title: study.title().map(str::to_owned),
                text: study.text().to_owned(),
                changes: study.changes().to_vec(),
                facts: Vec::new(),
            },
            units: study.disc().is_err().then(|| study.units()),
            axes: Vec::new(),
            arrays: Vec::new(),
        }
    }

    /// An empty dataset of an answer about a data file, without a study.
    pub fn of_file(path: &Path, verb: &'static str) -> Self {
        Self::without_study(verb).fact(format!("data: {}", path.display()))
    }

    /// An empty dataset of dimensionless numbers, without a study.
    pub fn without_study(verb: &'static str) -> Self {
        let provenance = Provenance {
            verb,
            title: None,
            text: String::new(),
            changes: Vec::new(),
            facts: Vec::new(),
        };
        Self { provenance, units: None, axes: Vec::new(), arrays: Vec::new() }
    }

    /// Adds a fact to the provenance.
    #[must_use]
    pub fn fact(mut self, fact: impl Into<String>) -> Self {
        self.provenance.facts.push(fact.into());
        self
    }

    /// Adds an axis of numbers of the equations, in the units of the study.
    #[must_use]
    pub fn axis(mut self, name: &str, quantity: Quantity, values: Vec<f64>) -> Self {
        self.axes.push(self.in_units(name, quantity, values));
        self
    }

    /// Adds an array of numbers of the equations, in the units of the study.
    #[must_use]
    pub fn array(mut self, name: &str, quantity: Quantity, values: Vec<f64>) -> Self {
        self.arrays.push(self.in_units(name, quantity, values));
        self
    }

    /// Adds slopes per unit velocity.
    #[must_use]
    pub fn per_velocity(mut self, name: &str, values: Vec<f64>) -> Self {
        let mut array = self.in_units(name, Quantity::PerVelocity, values);
        if self.units.is_none() {
            (array.unit, array.scaling) = readable(PER_VELOCITY);
        }
        self.arrays.push(array);
        self
    }

    /// One row for each entry of each contact, given by its name and the number of its entries.
    pub(crate) fn by_contact<'a>(self, contacts: impl Iterator<Item = (&'a str, usize)>) -> Self {
        let (names, counts): (Vec<&str>, Vec<usize>) = contacts.unzip();
        let counts = counts.into_iter().enumerate();
        let place: Vec<f64> = counts.flat_map(|(index, count)| vec![index as f64; count]).collect();
        let rows = (0..place.len()).map(|row| row as f64).collect();
        self.fact(format!("contacts: {}", names.join(", ")))
            .with_axis(Array::new("row", "1", rows))
            .with(Array::new("contact_number", "1", place))
    }

    /// Adds an axis without conversion.
    #[must_use]
    pub fn with_axis(mut self, axis: Array) -> Self {
        self.axes.push(axis);
        self
    }

    /// Adds an array without conversion.
    #[must_use]
    pub fn with(mut self, array: Array) -> Self {
        self.arrays.push(array);
        self
    }

    /// The same dataset with other units: `one` gives, for the name and the unit of an array, what one of that unit is in another.
    #[must_use]
    pub fn rescaled(mut self, one: impl Fn(&str, &str) -> Option<(f64, &'static str)>) -> Self {
        for array in self.axes.iter_mut().chain(&mut self.arrays) {
            let Some((factor, unit)) = one(&array.name, &array.scaling) else { continue };
            array.values.iter_mut().for_each(|value| *value *= factor);
            (array.unit, array.scaling) = readable(unit);
        }
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

    /// Consumes the dataset and returns provenance, axes and arrays without copying.
    pub fn into_parts(self) -> (Provenance, Vec<Array>, Vec<Array>) {
        (self.provenance, self.axes, self.arrays)
    }

    /// The provenance.
    pub fn provenance(&self) -> &Provenance {
        &self.provenance
    }

    /// An array in the units of the study.
    fn in_units(&self, name: &str, quantity: Quantity, values: Vec<f64>) -> Array {
        let unit = match self.units {
            Some(units) => units.unit(quantity).unwrap_or("1"),
            None => quantity.scaled_unit(),
        };
        Array::new(name, unit, values)
    }

    /// The dataset as CSV.
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
        let scaled = self.axes.iter().chain(&self.arrays).filter(|array| !array.scaling.is_empty());
        let scalings: Vec<String> =
            scaled.map(|array| format!("{} [{}]", array.name, array.scaling)).collect();
        if !scalings.is_empty() {
            lines.push(format!("scaling: {}", scalings.join(", ")));
        }
        lines.extend(changes.iter().map(|change| format!("changed: {change}")));
        if !text.is_empty() {
            lines.push("study:".to_owned());
        }
        lines.extend(text.lines().map(|line| format!("  {line}")));
        lines.iter().fold(String::new(), |mut header, line| {
            header.push_str("# ");
            header.push_str(line.trim_end());
            header.push('\n');
            header
        })
    }
}

/// A unit in the notation of unit packages such as pint, and the scale of the numbers.
pub fn readable(unit: &str) -> (String, String) {
    let (head, inner) = unit.split_once(" (").unwrap_or((unit, ""));
    let scaling = inner.strip_suffix(')').unwrap_or(inner);
    match head {
        "" | "1" => ("dimensionless".to_owned(), scaling.to_owned()),
        "degrees" => ("degree".to_owned(), scaling.to_owned()),
        // Decibels are logarithmic, and unit packages treat them differently.
        "dB/s" => ("1/s".to_owned(), "dB".to_owned()),
        _ if head.contains('ω') || head.contains("length") => {
            ("dimensionless".to_owned(), unit.to_owned())
        }
        _ => {
            let plain = head.replace('·', "*").replace('²', "**2").replace('³', "**3");
            (plain, scaling.to_owned())
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "schema = 1\n[belt]\ndamping_ratio = 0\nnormal_load = 1\nbelt_velocity = 1\n\
        [friction]\nlaw = \"stribeck\"\nstatic_coefficient = 0.4\nminimum_coefficient = 0.2\n\
        reference_velocity = 1\n";

    #[test]
    fn rows_enumerate_the_product_of_the_axes() {
        let study = Study::parse(TEXT, &[]).expect("valid");
        let without_units = Dataset { units: None, ..Dataset::of(&study, "map") };
        let csv = without_units
            .axis("a", Quantity::Ratio, vec![1.0, 2.0])
            .axis("b", Quantity::Ratio, vec![0.1, 0.2, 0.3])
            .array("c", Quantity::Force, vec![1.0, 2.0, 3.0, 4.0, f64::NAN, 1e-300])
            .csv();
        let rows: Vec<&str> = csv.lines().filter(|line| !line.starts_with('#')).collect();
        assert_eq!(rows[0], "a,b,c");
        assert_eq!(rows[1], "1.0,0.1,1.0");
        assert_eq!(rows[5], "2.0,0.2,");
        assert_eq!(rows[6], "2.0,0.3,1e-300");
        assert!(csv.contains("# units: a [dimensionless], b [dimensionless], c [dimensionless]"));
        assert!(csv.contains("# scaling: c [length (force/k)]\n"));
        assert!(csv.contains("#   normal_load = 1\n"));
    }

    #[test]
    fn the_numbers_of_a_study_in_si_are_in_si() {
        let text = TEXT
            .replace("damping_ratio = 0", "mass_kg = 2\nstiffness_n_per_m = 200\ndamping_ratio = 0")
            .replace("normal_load", "normal_force_n")
            .replace("belt_velocity", "belt_velocity_m_per_s")
            .replace("reference_velocity", "reference_velocity_m_per_s");
        let study = Study::parse(&text, &[]).expect("valid");
        let csv = Dataset::of(&study, "simulate")
            .axis("time", Quantity::Time, vec![1.0])
            .array("velocity", Quantity::Velocity, vec![5.0])
            .array("sticking", Quantity::Count, vec![1.0])
            .csv();
        let rows: Vec<&str> = csv.lines().filter(|line| !line.starts_with('#')).collect();
        assert_eq!(rows, ["time,velocity,sticking", "1.0,5.0,1.0"]);
        let units = "# units: time [s], velocity [m/s], sticking [dimensionless]";
        assert!(csv.contains(units), "{csv}");
        let plane = Dataset::of(&study, "basins")
            .axis("velocity", Quantity::Velocity, vec![1.0, 2.0])
            .axis("displacement", Quantity::Displacement, vec![0.0]);
        assert!(plane.arrays().is_empty() && plane.axes()[0].values == [1.0, 2.0]);
        assert!(!csv.contains("length") && !csv.contains("# scaling"));
    }

    #[test]
    fn units_are_machine_readable() {
        for (unit, wanted, scaling) in [
            ("1", "dimensionless", ""),
            ("length (force/k)", "dimensionless", "length (force/k)"),
            ("m (force/k)", "m", "force/k"),
            ("1/ω₀", "dimensionless", "1/ω₀"),
            ("1 (c/(2mω₀))", "dimensionless", "c/(2mω₀)"),
            ("N·s/m", "N*s/m", ""),
            ("N (rms)", "N", "rms"),
            ("kg/m³", "kg/m**3", ""),
            ("ω_ref", "dimensionless", "ω_ref"),
        ] {
            assert_eq!(readable(unit), (wanted.to_owned(), scaling.to_owned()), "{unit}");
        }
    }
}
