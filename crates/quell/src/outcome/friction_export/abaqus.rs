//! A surface interaction of Abaqus: `*FRICTION` with the coefficient over the slip rate.
//!
//! A data line has the coefficient, the slip rate, and then pressure, temperature and fields, which are left out: the coefficient
//! does not depend on them. Abaqus interpolates linearly and keeps the last value beyond the table. Lines that begin with `**` are
//! comments. Source: Abaqus Keywords Reference, `*FRICTION`.

use std::fmt::Write as _;

use super::comments::{ExportUnits, comment, provenance};
use crate::run::friction::export::FrictionExport;
use crate::study::SystemStudy;
use crate::words::more_digits;

/// Marks a comment.
const MARK: &str = "**";

/// The name of the interaction.
const NAME: &str = "QUELL_AVERAGED";

/// The file.
pub(super) fn text(study: &SystemStudy, export: &FrictionExport, units: &ExportUnits) -> String {
    let mut text = String::new();
    comment(&mut text, MARK, &provenance(study, export, units));
    let unit = units.speed;
    let columns = format!("columns: friction coefficient, slip rate in {unit}");
    comment(&mut text, MARK, &[columns]);
    let _ = writeln!(text, "*SURFACE INTERACTION, NAME={NAME}\n1.,");
    table(&mut text, "", export, 1.0);
    decay(&mut text, export, unit);
    if let Some(millimetres) = units.millimetres {
        let about = "the same table for a model in mm, t, s: slip rate in mm/s".to_owned();
        comment(&mut text, MARK, &[about]);
        table(&mut text, "** ", export, millimetres);
    }
    text
}

/// The table, with the slip rate times a factor.
fn table(text: &mut String, mark: &str, export: &FrictionExport, factor: f64) {
    let _ = writeln!(text, "{mark}*FRICTION");
    for (speed, coefficient) in &export.table.points {
        // Ten digits: Abaqus reads fields of up to 20 characters.
        let _ = writeln!(text, "{mark}{coefficient:.9E}, {:.9E}", speed * factor);
    }
}

/// The model with a decay, as a comment with its error.
fn decay(text: &mut String, export: &FrictionExport, unit: &str) {
    let fit = &export.decay;
    let (least, table) = (more_digits(fit.largest_error), more_digits(export.table.largest_error));
    let lines = [
        format!(
            "an exponential decay instead has the largest error {least}; the table has {table}"
        ),
        format!("(static and kinetic coefficient; decay over the slip rate in {unit})"),
        "*FRICTION, EXPONENTIAL DECAY".to_owned(),
        format!(
            "{:.9E}, {:.9E}, {:.9E}",
            fit.static_coefficient, fit.kinetic_coefficient, fit.decay
        ),
    ];
    comment(text, MARK, &lines);
}
