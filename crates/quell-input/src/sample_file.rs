//! A CSV file of friction coefficients at slip velocities.
//!
//! Columns `slip_velocity` or `slip_velocity_m_per_s`, and `coefficient`.

use crate::data_file::{DataFile, Row};
use crate::files::WantedFile;

/// What the file must be.
const WHAT: &str = "a CSV file of samples";

/// The file.
pub const WANTED: WantedFile = WantedFile::of(WHAT);

/// The column of slip velocities in the units of the study.
pub const SPEED: &str = "slip_velocity";
/// The column of slip velocities in m/s.
pub const SI_SPEED: &str = "slip_velocity_m_per_s";

/// A file of samples: those of each column of slip velocities that it has, or what is wrong with them.
#[derive(Debug)]
pub struct SampleFile {
    plain: Option<Result<Vec<(f64, f64)>, String>>,
    si: Option<Result<Vec<(f64, f64)>, String>>,
}

impl SampleFile {
    /// Whether slip velocities are in m/s, and slip velocities with coefficients; `may_be_si` says whether the study has units.
    ///
    /// # Errors
    /// The wrong cell with its line; columns that are missing.
    pub fn samples(&self, may_be_si: bool) -> Result<(bool, Vec<(f64, f64)>), String> {
        match (&self.si, &self.plain) {
            (Some(si), _) if may_be_si => Ok((true, si.clone()?)),
            (_, Some(plain)) => Ok((false, plain.clone()?)),
            // Only a column in SI is named; other column names are not shown.
            (Some(_), None) => Err(format!(
                "a CSV file with columns {SPEED} and coefficient; its column {SI_SPEED} needs a study with units"
            )),
            (None, None) => {
                Err(format!("a CSV file with columns {SPEED} or {SI_SPEED}, and coefficient"))
            }
        }
    }
}

/// The columns of a text.
///
/// # Errors
/// What is wrong with the table; a wrong cell is reported where its column is used.
pub fn parse(text: &str) -> Result<SampleFile, String> {
    let file = DataFile::new(text, WHAT)?;
    let column = |name| Some(file.column(name)?).map(|at| samples(&file, at, name));
    Ok(SampleFile { plain: column(SPEED), si: column(SI_SPEED) })
}

/// Slip velocities of a column with coefficients; errors name the line.
fn samples(file: &DataFile<'_>, speed: usize, column: &str) -> Result<Vec<(f64, f64)>, String> {
    let coefficient = file
        .column("coefficient")
        .ok_or_else(|| format!("a CSV file with columns {column} and coefficient"))?;
    let value = |row: &Row<'_>, at: usize, name: &str| {
        let number = row.number(at, name, "a finite number ≥ 0", |number| {
            number.is_finite() && number >= 0.0
        });
        number.map_err(|why| {
            if row.is_negative(at) {
                format!(
                    "{why}; friction is assumed equal in both directions of slip: give samples of one direction, with \
                     both values positive"
                )
            } else {
                why
            }
        })
    };
    let sample = |row| Ok((value(row, speed, column)?, value(row, coefficient, "coefficient")?));
    file.rows().iter().map(sample).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<(bool, Vec<(f64, f64)>), String> {
        parse(text)?.samples(true)
    }

    #[test]
    fn columns_are_found_by_name_and_wrong_cells_by_line() {
        let text = "# synthetic\ncoefficient, note, slip_velocity\n0.4,a,0\n\n0.3,b,0.5\n";
        assert_eq!(read(text), Ok((false, vec![(0.0, 0.4), (0.5, 0.3)])));
        let si = text.replace("slip_velocity", "slip_velocity_m_per_s");
        assert_eq!(read(&si), Ok((true, vec![(0.0, 0.4), (0.5, 0.3)])));
        let wrong = parse(&si).expect("a table").samples(false).expect_err("a study without units");
        assert!(wrong.contains("its column slip_velocity_m_per_s needs"), "{wrong}");
        for (row, part) in [
            ("-1,0.3", "one direction"),
            ("x,0.3", "line 3, slip_velocity: \"x\""),
            ("1", "line 3"),
        ] {
            let text = format!("slip_velocity,coefficient\n0,0.4\n{row}\n");
            let wrong = read(&text).expect_err(row);
            assert!(wrong.contains(part), "{row}: {wrong}");
        }
    }
}
