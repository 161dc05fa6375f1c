//! Which part rotates, at which speed over time, and how centrifugal stress stiffens the disc.

use quell_input::complaint::{Complaint, Fault};
use quell_input::document::Table;
use quell_model::parameter::disc::CENTRIFUGAL;

use super::loads::{DRIVE, Pad};
use super::modes::{Listed, ModeSource};
use crate::study::course::{Course, CoursePlace, replaces_constant};
use crate::study::reader::Reader;
use crate::study::vocabulary::{Choice, DISC_DRIVE};

/// The speed over time, `Ok(None)` at a constant speed; `Err` if it is wrong, which has been reported.
///
/// Knots take the place of the speed of the loads, an oscillation is added to it.
pub(super) fn drive(
    reader: &mut Reader,
    table: &Table,
    pads: &[Pad],
) -> Result<Option<Course>, ()> {
    let Some(node) = table.get(DRIVE) else { return Ok(None) };
    if pads.is_empty() {
        let allowed = "left out: a disc without loads has no speed";
        let (origin, given) = (node.origin, node.given());
        reader.complain(Complaint::new(Fault::Conflict, "disc.drive", origin, given, allowed));
        return Err(());
    }
    if replaces_constant(Some(node)) {
        let said = pads.iter().filter_map(|pad| Some((pad.speed?, &pad.path)));
        for ((speed, origin), path) in said {
            let allowed = "left out: disc.drive gives it over time";
            let key = format!("{path}.speed");
            reader.complain(Complaint::new(Fault::Conflict, key, origin, speed, allowed));
        }
    }
    CoursePlace(DISC_DRIVE).optional(reader, table, "disc", DRIVE)
}

/// Centrifugal stiffening κ of the disc, 0 if its loads rotate instead, as the dissertation has it.
pub(super) fn read(reader: &mut Reader, table: &Table, source: Option<&ModeSource>) -> Option<f64> {
    let stiffening = reader.optional(table, "disc", CENTRIFUGAL).or(0.0);
    let rotates = match table.get("rotating") {
        None => Some(false),
        Some(node) => {
            reader.choice("disc.rotating", node, Choice::Rotating).map(|part| part == "disc")
        }
    };
    let (stiffening, rotates) = (stiffening?, rotates?);
    let listed = match source {
        Some(ModeSource::List(listed) | ModeSource::File { listed, .. }) => of_modes(listed),
        _ => None,
    };
    let given = table.get(CENTRIFUGAL.key()).filter(|_| stiffening != 0.0);
    let given = given.map(|node| (CENTRIFUGAL.path.to_owned(), node.origin, stiffening));
    let listed = listed.and_then(|(index, value)| {
        let node = table.get("mode").or(table.get("modes_file"))?;
        Some((format!("disc.mode[{index}].centrifugal"), node.origin, value))
    });
    match given.or(listed) {
        Some((key, origin, value)) if !rotates => {
            let allowed = "0 unless rotating = \"disc\": a disc at rest has no centrifugal stress";
            reader.complain(Complaint::new(Fault::Conflict, key, origin, value, allowed));
            None
        }
        _ => Some(stiffening),
    }
}

/// The first listed mode with a stiffening of its own.
fn of_modes(listed: &Listed) -> Option<(usize, f64)> {
    let own = listed.modes.iter().map(|mode| mode.centrifugal.unwrap_or(0.0));
    own.enumerate().find(|(_, value)| *value != 0.0)
}

/// κ of every mode: its own, or that of the disc.
pub(super) fn stiffening(source: &ModeSource, of_plate: f64, count: usize) -> Vec<f64> {
    match source {
        ModeSource::Plate(_) => vec![of_plate; count],
        ModeSource::List(listed) | ModeSource::File { listed, .. } => {
            listed.modes.iter().map(|mode| mode.centrifugal.unwrap_or(of_plate)).collect()
        }
    }
}
