//! A measured actuator in a file of its own: `file = "actuator.csv"`.
//!
//! Columns `frequency` (in the unit of the study) or `frequency_hz`, and at least one of `force_per_volt`, `force_per_ampere` and
//! `maximum_force` (with the suffixes `_n_per_v`, `_n_per_a`, `_n` in SI): magnitudes, at ascending frequencies.

use std::sync::Arc;

use crate::data_file::{self, DataFile};
use crate::files::{Files, WantedFile};

/// What the file must be.
const WHAT: &str = "a CSV file of an actuator's frequency response";

/// The columns and their names in SI.
pub const COLUMNS: [(&str, &str); 4] = [
    ("frequency", "frequency_hz"),
    ("force_per_volt", "force_per_volt_n_per_v"),
    ("force_per_ampere", "force_per_ampere_n_per_a"),
    ("maximum_force", "maximum_force_n"),
];

/// A column as the file gives it.
#[derive(Clone, Debug, PartialEq)]
pub struct GivenColumn {
    /// Whether it is in SI.
    pub si: bool,
    /// Its numbers.
    pub values: Vec<f64>,
}

/// The columns of a file, one place for each of [`COLUMNS`].
#[derive(Debug)]
pub struct ActuatorFile {
    /// The columns of [`COLUMNS`] in this order, those that the file has.
    pub columns: [Option<GivenColumn>; 4],
}

impl ActuatorFile {
    /// The file that `key` names.
    ///
    /// # Errors
    /// Why it cannot be read, or the line that is wrong.
    pub fn read(files: &mut Files, key: &str, name: &str) -> Result<Arc<Self>, String> {
        files.parsed(key, name, WantedFile::of(WHAT), |text| Ok(Self { columns: parse(text)? }))
    }
}

/// The columns of a text.
fn parse(text: &str) -> Result<[Option<GivenColumn>; 4], String> {
    let file = DataFile::new(text, WHAT)?;
    let column = |(plain, si): (&'static str, &'static str)| {
        let places = [(plain, false), (si, true)];
        let mut there =
            places.into_iter().filter_map(|(name, si)| Some((name, si, file.column(name)?)));
        let Some((name, si, at)) = there.next() else { return Ok(None) };
        if there.next().is_some() {
            return Err(format!("{WHAT} with either {plain} or {}, not both", places[1].0));
        }
        let right = |value: f64| value.is_finite() && value > 0.0;
        let values = file.rows().iter().map(|row| row.number(at, name, "a number above 0", right));
        Ok(Some(GivenColumn { si, values: values.collect::<Result<_, _>>()? }))
    };
    let [frequency, volts, amperes, most] = COLUMNS;
    let columns = [column(frequency)?, column(volts)?, column(amperes)?, column(most)?];
    let Some(frequencies) = &columns[0] else {
        return Err(format!("{WHAT} with a column frequency or frequency_hz"));
    };
    if columns[1..].iter().all(Option::is_none) {
        return Err(format!("{WHAT} with force_per_volt, force_per_ampere or maximum_force"));
    }
    if frequencies.values.len() < 2 {
        return Err(format!("{WHAT} with at least two frequencies"));
    }
    let falls = frequencies.values.windows(2).position(|pair| pair[1] <= pair[0]);
    if let Some(place) = falls {
        let row = file.rows().get(place + 1).map_or(0, data_file::Row::line);
        return Err(format!("line {row}: frequencies must ascend"));
    }
    Ok(columns)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_are_read_by_name() {
        let columns = parse("frequency_hz,force_per_volt\n10,0.5\n20,0.25\n").expect("right");
        let [Some(frequency), Some(volts), None, None] = columns else { panic!("two columns") };
        assert!(frequency.si && !volts.si);
        assert_eq!(volts.values, [0.5, 0.25]);
    }

    #[test]
    fn wrong_files_are_refused_with_the_line() {
        for (text, words) in [
            ("frequency,force_per_volt\n1,2\n", "two frequencies"),
            ("frequency,force_per_volt\n1,2\n1,2\n", "line 3: frequencies must ascend"),
            ("frequency,force_per_volt\n1,2\n2,0\n", "line 3, force_per_volt"),
            ("frequency,force_per_volt\n1,2\n2\n", "line 3, force_per_volt"),
            ("frequency,phase\n1,2\n2,3\n", "force_per_volt, force_per_ampere or maximum_force"),
            ("force_per_volt\n1\n2\n", "frequency or frequency_hz"),
            ("frequency,frequency_hz,maximum_force\n1,1,1\n2,2,1\n", "not both"),
            ("", "header"),
        ] {
            let said = parse(text).expect_err(text);
            assert!(said.contains(words), "{text:?}: {said}");
        }
    }
}
