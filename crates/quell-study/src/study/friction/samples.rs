//! A law from measured samples, in the study or in a separate CSV file.

use quell_input::complaint::{Complaint, Fault, Origin};
use quell_input::document::{Node, Table, Value};
use quell_input::sample_file::{self, SI_SPEED, SPEED};
use quell_model::friction::samples::{COEFFICIENTS, MOST_TERMS, SPEEDS};
use quell_model::parameter::{Bounds, STATIC_COEFFICIENT};
use quell_model::units::Quantity;
use quell_model::{Friction, InvalidValues, Samples};
use serde_json::Value as Json;

use super::expression::{complain, velocity_unit};
use super::measured::Measured;
use super::read_law::ReadLaw;
use crate::study::reader::Reader;
use crate::study::vocabulary::{KeyUnit, join};

/// Reads the samples and fits them.
pub(super) fn read(
    reader: &mut Reader,
    table: &Table,
    path: &str,
    header: Origin,
) -> Option<ReadLaw> {
    let level = reader.optional(table, path, STATIC_COEFFICIENT).if_given();
    let terms = match table.get("terms") {
        None => Some(None),
        Some(node) => {
            let bounds = Bounds { upper: MOST_TERMS as f64, ..Bounds::at_least(1.0) };
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "a whole number from 1 to MOST_TERMS"
            )]
            let whole = reader
                .within(&join(path, "terms"), node, bounds, "", true)
                .map(|count| count as usize);
            whole.map(Some)
        }
    };
    let (origin, file, samples) = given(reader, table, path, header)?;
    let (static_coefficient, terms, unit) = (level?, terms?, velocity_unit(reader));
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
            let key = if file.is_some() { "file" } else { "coefficient" };
            reader.remember(path, ("coefficient", key), origin.origin, 1.0);
            Some(ReadLaw { measured: Some(measured), ..ReadLaw::of(Friction::Samples(law)) })
        }
        Err(invalid) => {
            report(reader, (table, path), origin, file.is_some(), invalid);
            None
        }
    }
}

/// Reports errors of the model under the keys of the study.
fn report(
    reader: &mut Reader,
    (table, path): (&Table, &str),
    place: &Node,
    in_file: bool,
    invalid: InvalidValues,
) {
    let invalid = invalid.map(|mut invalid| {
        // A number of a list is reported with the list.
        let list = invalid.key.split('[').next().unwrap_or_default();
        if list == SPEEDS || list == COEFFICIENTS {
            invalid.allowed =
                format!("{}: {} must be {}", invalid.key, invalid.value, invalid.allowed);
            invalid.key = if in_file { "friction.file".to_owned() } else { list.to_owned() };
        }
        invalid
    });
    complain(reader, table, path, place, invalid);
}

/// Where the samples were written, the file that holds them, and the samples.
type GivenSamples<'t> = (&'t Node, Option<String>, Vec<(f64, f64)>);

/// The samples, from the study or from its file, their speeds in the unit of the study.
fn given<'t>(
    reader: &mut Reader,
    table: &'t Table,
    path: &str,
    header: Origin,
) -> Option<GivenSamples<'t>> {
    let key = join(path, "file");
    if let Some(node) = table.get("file") {
        for name in [SPEED, SI_SPEED, "coefficient"] {
            if let Some(other) = table.get(name) {
                let allowed = format!("the samples are already given by {key}; remove this key");
                let (key, origin) = (join(path, name), other.origin);
                reader.complain(Complaint::new(Fault::Conflict, key, origin, Json::Null, allowed));
                return None;
            }
        }
        let name = reader.text(&key, node)?;
        let may_be_si = reader.units().take_suffixes();
        let file = reader.files().parsed(&key, &name, sample_file::WANTED, sample_file::parse);
        let found = file.and_then(|file| file.samples(may_be_si));
        let (is_si, samples) = reader.in_file((&key, node), &name, found)?;
        let unit = if is_si { KeyUnit::Suffix("m/s") } else { KeyUnit::Study };
        let own = |(speed, coefficient)| Some((in_study(reader, speed, unit)?, coefficient));
        let samples = samples.into_iter().map(own).collect::<Option<_>>()?;
        return Some((node, Some(name), samples));
    }
    let found = reader.keyed(table, path, SPEED, Some(Quantity::Velocity)).ok()?;
    let (name, unit) = match &found {
        Some(found) if found.unit != KeyUnit::Study => (SI_SPEED, found.unit),
        _ => (SPEED, KeyUnit::Study),
    };
    let speeds = list(reader, table, (path, header), name, unit);
    let coefficients = list(reader, table, (path, header), "coefficient", KeyUnit::Study);
    let ((node, speeds), (other, coefficients)) = (speeds?, coefficients?);
    if speeds.len() != coefficients.len() {
        let allowed = format!("{} values, as many as {} has", speeds.len(), join(path, name));
        let (key, given) = (join(path, "coefficient"), coefficients.len());
        reader.complain(Complaint::new(Fault::Value, key, other.origin, given, allowed));
        return None;
    }
    let speeds: Option<Vec<f64>> =
        speeds.into_iter().map(|speed| in_study(reader, speed, unit)).collect();
    Some((node, None, speeds?.into_iter().zip(coefficients).collect()))
}

/// A speed in the unit of the study.
fn in_study(reader: &Reader, speed: f64, unit: KeyUnit) -> Option<f64> {
    reader.units().in_file(speed, Quantity::Velocity, unit)
}

/// An array of numbers.
fn list<'t>(
    reader: &mut Reader,
    table: &'t Table,
    (path, header): (&str, Origin),
    name: &str,
    unit: KeyUnit,
) -> Option<(&'t Node, Vec<f64>)> {
    let key = join(path, name);
    let Some(node) = table.get(name) else {
        let file = join(path, "file");
        let allowed =
            format!("an array of numbers; or give {file}, a CSV file with a column {name}");
        reader.missing(key, header, allowed);
        return None;
    };
    let Value::List(list) = &node.value else {
        reader.wrong(&key, node, format!("an array of numbers; got {}", node.kind()));
        return None;
    };
    let own = reader.units().file.unit(Quantity::Velocity);
    let numbers: Vec<Option<f64>> = list
        .iter()
        .enumerate()
        .map(|(index, node)| {
            let unit = match unit {
                KeyUnit::Suffix(unit) => unit,
                _ if name == SPEED => own.unwrap_or_default(),
                _ => "",
            };
            reader.within(&format!("{key}[{index}]"), node, Bounds::NOT_NEGATIVE, unit, false)
        })
        .collect();
    Some((node, numbers.into_iter().collect::<Option<_>>()?))
}
