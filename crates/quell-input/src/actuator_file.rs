//! A measured actuator in a file of its own: `file = "actuator.csv"`.
//!
//! Columns `frequency` (in the unit of the study) or `frequency_hz`, and at least one of `force_per_volt`, `force_per_ampere` and
//! `maximum_force` (with the suffixes `_n_per_v`, `_n_per_a`, `_n` in SI): magnitudes, at ascending frequencies.

use std::fmt;
use std::sync::Arc;

use crate::data_file::{self, DataFile};
use crate::files::{Files, WantedFile};
use crate::wrong_file::{WrongFile, WrongTable};

/// What the file must be.
const WHAT: &str = "a CSV file of an actuator's frequency response";

/// The columns and their names in SI.
pub const COLUMNS: [(&str, &str); 4] = [
    ("frequency", "frequency_hz"),
    ("force_per_volt", "force_per_volt_n_per_v"),
    ("force_per_ampere", "force_per_ampere_n_per_a"),
    ("maximum_force", "maximum_force_n"),
];

/// What is wrong with the columns of an actuator's frequency response.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum WrongActuator {
    /// A column is given in both units, with these names.
    Both([&'static str; 2]),
    /// No column has frequencies.
    NoFrequency,
    /// No column has a force.
    NoForce,
    /// There are fewer than two frequencies.
    OneFrequency,
    /// The frequency of this line, from 1, is not above that of the line before.
    NotAscending {
        /// The line.
        line: usize,
    },
}

impl fmt::Display for WrongActuator {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Both([plain, si]) => write!(f, "{WHAT} with either {plain} or {si}, not both"),
            Self::NoFrequency => write!(f, "{WHAT} with a column frequency or frequency_hz"),
            Self::NoForce => {
                write!(f, "{WHAT} with force_per_volt, force_per_ampere or maximum_force")
            }
            Self::OneFrequency => write!(f, "{WHAT} with at least two frequencies"),
            Self::NotAscending { line } => write!(f, "line {line}: frequencies must ascend"),
        }
    }
}

impl std::error::Error for WrongActuator {}

impl From<WrongActuator> for WrongFile<WrongActuator> {
    fn from(why: WrongActuator) -> Self {
        Self::Contents(why)
    }
}

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
    pub fn read(
        files: &mut Files,
        key: &str,
        name: &str,
    ) -> Result<Arc<Self>, WrongFile<WrongActuator>> {
        files.parsed(key, name, WantedFile::of(WHAT), |text| Ok(Self { columns: parse(text)? }))
    }
}

/// The columns of a text.
fn parse(text: &str) -> Result<[Option<GivenColumn>; 4], WrongFile<WrongActuator>> {
    let file = DataFile::new(text, WHAT)?;
    let column = |(plain, si)| -> Result<Option<GivenColumn>, WrongFile<WrongActuator>> {
        let places = [(plain, false), (si, true)];
        let mut there =
            places.into_iter().filter_map(|(name, si)| Some((name, si, file.column(name)?)));
        let Some((name, si, at)) = there.next() else { return Ok(None) };
        if there.next().is_some() {
            return Err(WrongActuator::Both([plain, places[1].0]).into());
        }
        let right = |value: f64| value.is_finite() && value > 0.0;
        let values = file.rows().iter().map(|row| row.number(at, name, "a number above 0", right));
        Ok(Some(GivenColumn { si, values: values.collect::<Result<_, WrongTable>>()? }))
    };
    let [frequency, volts, amperes, most] = COLUMNS;
    let columns = [column(frequency)?, column(volts)?, column(amperes)?, column(most)?];
    let Some(frequencies) = &columns[0] else {
        return Err(WrongActuator::NoFrequency.into());
    };
    if columns[1..].iter().all(Option::is_none) {
        return Err(WrongActuator::NoForce.into());
    }
    if frequencies.values.len() < 2 {
        return Err(WrongActuator::OneFrequency.into());
    }
    let falls = frequencies.values.windows(2).position(|pair| pair[1] <= pair[0]);
    if let Some(place) = falls {
        let line = file.rows().get(place + 1).map_or(0, data_file::Row::line);
        return Err(WrongActuator::NotAscending { line }.into());
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
            let said = parse(text).expect_err(text).to_string();
            assert!(said.contains(words), "{text:?}: {said}");
        }
    }
}
