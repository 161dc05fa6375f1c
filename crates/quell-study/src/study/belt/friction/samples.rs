//! A law from measured samples, in the study or in a separate CSV file.
//!
//! The file: comment lines begin with `#`; the first other line names the columns, `slip_velocity` (in a study in SI
//! `slip_velocity_m_per_s`) and `coefficient`. Other columns are ignored.

use std::sync::Arc;

use quell_model::friction::samples::{COEFFICIENTS, MOST_TERMS, SPEEDS, TERMS};
use quell_model::parameter::{Bounds, STATIC_COEFFICIENT};
use quell_model::{Friction, InvalidValues, Samples};
use serde_json::Value as Json;

use super::expression::{complain, velocity_unit};
use super::measured::Measured;
use super::read_law::ReadLaw;
use crate::complaint::{Complaint, Fault, Origin};
use crate::study::data_file::{DataFile, Row};
use crate::study::document::{Node, Table, Value};
use crate::study::files::{Files, WantedFile};
use crate::study::reader::{Found, Reader};

/// What the file must be.
const WHAT: &str = "a CSV file of samples";

/// Path of the file's key.
const FILE: &str = "friction.file";

/// Column of slip velocities in the units of the study, and in SI.
const SPEED: &str = "slip_velocity";
const SI_SPEED: &str = "slip_velocity_m_per_s";

/// Reads the samples and fits them.
pub(super) fn read(reader: &mut Reader, table: &Table, header: Origin) -> Option<ReadLaw> {
    let level = reader.optional(table, "friction", STATIC_COEFFICIENT, None);
    let terms = match table.get("terms") {
        None => Some(None),
        Some(node) => {
            let bounds = Bounds { upper: MOST_TERMS as f64, ..Bounds::at_least(1.0) };
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "a whole number from 1 to MOST_TERMS"
            )]
            let whole = reader.within(TERMS, node, bounds, "", true).map(|count| count as usize);
            whole.map(Some)
        }
    };
    let (origin, file, samples) = given(reader, table, header)?;
    let static_coefficient = match level {
        Found::Value(level) => Some(level),
        Found::Absent => None,
        Found::Wrong => return None,
    };
    let (terms, unit) = (terms?, velocity_unit(reader));
    let same = |known: &Measured| {
        known.samples == samples
            && known.static_coefficient == static_coefficient
            && known.terms == terms
            && known.file == file
    };
    let fitted = reader.computed().get(same, || {
        let fit = Samples::fitted(&samples, static_coefficient, terms)?;
        let (file, samples) = (file.clone(), samples.clone());
        Ok(Measured { file, samples, static_coefficient, terms, fit })
    });
    let made = fitted.and_then(|measured| {
        let law = Samples::of_fit(measured.fit.clone(), static_coefficient, unit)?;
        Ok((measured, law))
    });
    match made {
        Ok((measured, law)) => {
            let key = if file.is_some() { FILE } else { COEFFICIENTS };
            reader.remember(COEFFICIENTS, key, origin.origin, 1.0);
            Some(ReadLaw { measured: Some(measured), ..ReadLaw::of(Friction::Samples(law)) })
        }
        Err(invalid) => {
            report(reader, table, origin, file.is_some(), invalid);
            None
        }
    }
}

/// Reports errors of the model under the keys of the study.
fn report(reader: &mut Reader, table: &Table, place: &Node, in_file: bool, invalid: InvalidValues) {
    let invalid = invalid.map(|mut invalid| {
        // A number of a list is reported with the list.
        let list = invalid.key.split('[').next().unwrap_or_default();
        if list == SPEEDS || list == COEFFICIENTS {
            invalid.allowed =
                format!("{}: {} must be {}", invalid.key, invalid.value, invalid.allowed);
            invalid.key = if in_file { FILE.to_owned() } else { list.to_owned() };
        }
        invalid
    });
    complain(reader, table, place, invalid);
}

/// Where the samples were written, the file that holds them, and the samples.
type GivenSamples<'t> = (&'t Node, Option<String>, Vec<(f64, f64)>);

/// The samples, from the study or from its file.
fn given<'t>(reader: &mut Reader, table: &'t Table, header: Origin) -> Option<GivenSamples<'t>> {
    let (column, other) = if reader.is_si() { (SI_SPEED, SPEED) } else { (SPEED, SI_SPEED) };
    if let Some(node) = table.get(other) {
        let allowed = format!("does not match the units of this study: use friction.{column}");
        let key = format!("friction.{other}");
        let complaint = Complaint::new(Fault::Mixed, key, node.origin, Json::Null, allowed);
        reader.complain(complaint.suggesting(Some(format!("friction.{column}"))));
        return None;
    }
    if let Some(node) = table.get("file") {
        for name in [column, "coefficient"] {
            if let Some(other) = table.get(name) {
                let key = format!("friction.{name}");
                let allowed = format!("the samples are already given by {FILE}; remove this key");
                reader.complain(Complaint::new(
                    Fault::Conflict,
                    key,
                    other.origin,
                    Json::Null,
                    allowed,
                ));
                return None;
            }
        }
        let name = reader.text(FILE, node)?;
        return match in_file(reader.files(), FILE, &name).and_then(|file| file.samples(column)) {
            Ok(samples) => Some((node, Some(name), samples)),
            Err(why) => {
                reader.complain(Complaint::new(Fault::Path, FILE, node.origin, name, why));
                None
            }
        };
    }
    let speeds = list(reader, table, header, column);
    let coefficients = list(reader, table, header, "coefficient");
    let ((node, speeds), (other, coefficients)) = (speeds?, coefficients?);
    if speeds.len() != coefficients.len() {
        let allowed = format!("{} values, as many as friction.{column} has", speeds.len());
        let given = coefficients.len();
        let complaint = Complaint::new(Fault::Value, COEFFICIENTS, other.origin, given, allowed);
        reader.complain(complaint);
        return None;
    }
    Some((node, None, speeds.into_iter().zip(coefficients).collect()))
}

/// An array of numbers.
fn list<'t>(
    reader: &mut Reader,
    table: &'t Table,
    header: Origin,
    name: &str,
) -> Option<(&'t Node, Vec<f64>)> {
    let key = format!("friction.{name}");
    let Some(node) = table.get(name) else {
        let allowed =
            format!("an array of numbers; or give {FILE}, a CSV file with a column {name}");
        reader.complain(Complaint::new(Fault::Missing, key, header, Json::Null, allowed));
        return None;
    };
    let Value::List(list) = &node.value else {
        reader.wrong(&key, node, format!("an array of numbers; got {}", node.kind()));
        return None;
    };
    let numbers: Vec<Option<f64>> = list
        .iter()
        .enumerate()
        .map(|(index, node)| {
            reader.within(&format!("{key}[{index}]"), node, Bounds::NOT_NEGATIVE, "", false)
        })
        .collect();
    Some((node, numbers.into_iter().collect::<Option<_>>()?))
}

/// A file of samples: those of each column of slip velocities that it has, or what is wrong with them.
#[derive(Debug)]
pub(in crate::study) struct SampleFile {
    plain: Option<Result<Vec<(f64, f64)>, String>>,
    si: Option<Result<Vec<(f64, f64)>, String>>,
}

impl SampleFile {
    /// Whether its slip velocities are in SI alone.
    pub(in crate::study) fn is_in_si(&self) -> bool {
        self.si.is_some() && self.plain.is_none()
    }

    /// Slip velocity of a column, and coefficient.
    fn samples(&self, column: &str) -> Result<Vec<(f64, f64)>, String> {
        let (own, other, name) = if column == SPEED {
            (&self.plain, &self.si, SI_SPEED)
        } else {
            (&self.si, &self.plain, SPEED)
        };
        own.clone().unwrap_or_else(|| {
            // Only a column in the other unit system is named; other column names are not shown.
            let other = other.as_ref().map_or_else(String::new, |_| {
                format!("; its column {name} does not match the units of this study")
            });
            Err(format!("a CSV file with columns {column} and coefficient{other}"))
        })
    }
}

/// The samples of the file that `key` names.
///
/// # Errors
/// Why it cannot be read.
pub(in crate::study) fn in_file(
    files: &mut Files,
    key: &str,
    name: &str,
) -> Result<Arc<SampleFile>, String> {
    files.parsed(key, name, WantedFile::of(WHAT), parse)
}

fn parse(text: &str) -> Result<SampleFile, String> {
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

    fn read(text: &str, column: &str) -> Result<Vec<(f64, f64)>, String> {
        parse(text)?.samples(column)
    }

    #[test]
    fn columns_are_found_by_name_and_wrong_cells_by_line() {
        let text = "# synthetic\ncoefficient, note, slip_velocity\n0.4,a,0\n\n0.3,b,0.5\n";
        assert_eq!(read(text, "slip_velocity"), Ok(vec![(0.0, 0.4), (0.5, 0.3)]));
        let wrong = read(text, "slip_velocity_m_per_s").expect_err("no such column");
        assert!(
            wrong.contains(
                "columns slip_velocity_m_per_s and coefficient; its column slip_velocity"
            ),
            "{wrong}"
        );
        for (row, part) in [
            ("-1,0.3", "one direction"),
            ("x,0.3", "line 3, slip_velocity: \"x\""),
            ("1", "line 3"),
        ] {
            let text = format!("slip_velocity,coefficient\n0,0.4\n{row}\n");
            let wrong = read(&text, "slip_velocity").expect_err(row);
            assert!(wrong.contains(part), "{row}: {wrong}");
        }
    }
}
