//! A CSV file of friction coefficients at slip velocities.
//!
//! Columns `slip_velocity` or `slip_velocity_m_per_s`, and `coefficient`.

use std::fmt;

use crate::data_file::{DataFile, Row};
use crate::files::WantedFile;
use crate::wrong_file::{WrongFile, WrongTable};

/// What the file must be.
const WHAT: &str = "a CSV file of samples";

/// The file.
pub const WANTED: WantedFile = WantedFile::of(WHAT);

/// The column of slip velocities in the units of the study.
pub const SPEED: &str = "slip_velocity";
/// The column of slip velocities in m/s.
pub const SI_SPEED: &str = "slip_velocity_m_per_s";

/// What is wrong with samples of friction coefficients.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum WrongSamples {
    /// Slip velocities are in m/s, and the study has no units. Other names of columns are not shown.
    OnlySi,
    /// No column has slip velocities.
    NoSpeed,
    /// No column has coefficients.
    NoCoefficient {
        /// The column of slip velocities.
        speed: &'static str,
    },
    /// A number is negative.
    Negative(WrongTable),
}

impl fmt::Display for WrongSamples {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::OnlySi => write!(
                f,
                "a CSV file with columns {SPEED} and coefficient; its column {SI_SPEED} needs a study with units"
            ),
            Self::NoSpeed => {
                write!(f, "a CSV file with columns {SPEED} or {SI_SPEED}, and coefficient")
            }
            Self::NoCoefficient { speed } => {
                write!(f, "a CSV file with columns {speed} and coefficient")
            }
            Self::Negative(why) => write!(
                f,
                "{why}; friction is assumed equal in both directions of slip: give samples of one direction, with both values positive"
            ),
        }
    }
}

impl std::error::Error for WrongSamples {}

impl From<WrongSamples> for WrongFile<WrongSamples> {
    fn from(why: WrongSamples) -> Self {
        Self::Contents(why)
    }
}

/// Samples, or what is wrong with their file.
pub type SampleResult<T> = Result<T, WrongFile<WrongSamples>>;

/// A file of samples: those of each column of slip velocities that it has, or what is wrong with them.
#[derive(Debug)]
pub struct SampleFile {
    plain: Option<SampleResult<Vec<(f64, f64)>>>,
    si: Option<SampleResult<Vec<(f64, f64)>>>,
}

impl SampleFile {
    /// Whether slip velocities are in m/s, and slip velocities with coefficients; `may_be_si` says whether the study has units.
    ///
    /// # Errors
    /// The wrong cell with its line; columns that are missing.
    pub fn samples(&self, may_be_si: bool) -> SampleResult<(bool, Vec<(f64, f64)>)> {
        match (&self.si, &self.plain) {
            (Some(si), _) if may_be_si => Ok((true, si.clone()?)),
            (_, Some(plain)) => Ok((false, plain.clone()?)),
            // Only a column in SI is named; other column names are not shown.
            (Some(_), None) => Err(WrongSamples::OnlySi.into()),
            (None, None) => Err(WrongSamples::NoSpeed.into()),
        }
    }
}

/// The columns of a text.
///
/// # Errors
/// What is wrong with the table; a wrong cell is reported where its column is used.
pub fn parse(text: &str) -> SampleResult<SampleFile> {
    let file = DataFile::new(text, WHAT)?;
    let column = |name: &'static str| Some(file.column(name)?).map(|at| samples(&file, at, name));
    Ok(SampleFile { plain: column(SPEED), si: column(SI_SPEED) })
}

/// Slip velocities of a column with coefficients; errors name the line.
fn samples(
    file: &DataFile<'_>,
    speed: usize,
    column: &'static str,
) -> SampleResult<Vec<(f64, f64)>> {
    let coefficient =
        file.column("coefficient").ok_or(WrongSamples::NoCoefficient { speed: column })?;
    let value = |row: &Row<'_>, at: usize, name: &str| -> SampleResult<f64> {
        let number = row.number(at, name, "a finite number ≥ 0", |number| {
            number.is_finite() && number >= 0.0
        });
        number.map_err(|why| {
            if row.is_negative(at) { WrongSamples::Negative(why).into() } else { why.into() }
        })
    };
    let sample = |row| Ok((value(row, speed, column)?, value(row, coefficient, "coefficient")?));
    file.rows().iter().map(sample).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> SampleResult<(bool, Vec<(f64, f64)>)> {
        parse(text)?.samples(true)
    }

    #[test]
    fn columns_are_found_by_name_and_wrong_cells_by_line() {
        let text = "# synthetic\ncoefficient, note, slip_velocity\n0.4,a,0\n\n0.3,b,0.5\n";
        assert_eq!(read(text), Ok((false, vec![(0.0, 0.4), (0.5, 0.3)])));
        let si = text.replace("slip_velocity", "slip_velocity_m_per_s");
        assert_eq!(read(&si), Ok((true, vec![(0.0, 0.4), (0.5, 0.3)])));
        let wrong = parse(&si)
            .expect("a table")
            .samples(false)
            .expect_err("a study without units")
            .to_string();
        assert!(wrong.contains("its column slip_velocity_m_per_s needs"), "{wrong}");
        for (row, part) in [
            ("-1,0.3", "one direction"),
            ("x,0.3", "line 3, slip_velocity: \"x\""),
            ("1", "line 3"),
        ] {
            let text = format!("slip_velocity,coefficient\n0,0.4\n{row}\n");
            let wrong = read(&text).expect_err(row).to_string();
            assert!(wrong.contains(part), "{row}: {wrong}");
        }
    }
}
