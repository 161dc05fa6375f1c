//! A model of Modelica: the brake of the Standard Library with the coefficient as a table over the slip speed.
//!
//! The brake interpolates linearly, goes on along its last two points, and holds up to `peak` times the first coefficient at rest; its
//! load is `fn_max` times the signal `f_normalized`. Speeds are in m/s. Source: Modelica Standard Library 4,
//! `Mechanics.Translational.Components.Brake`.

use std::fmt::Write as _;

use super::comments::{ExportUnits, comment, provenance};
use crate::run::friction::export::FrictionExport;
use crate::study::{SystemStudy, UnitSystem};

/// Marks a comment.
const MARK: &str = "//";

/// The name of the model.
const NAME: &str = "AveragedFriction";

/// The file.
pub(super) fn text(study: &SystemStudy, export: &FrictionExport, units: &ExportUnits) -> String {
    let mut text = String::new();
    comment(&mut text, MARK, &provenance(study, export, units));
    let metres = match study.units() {
        UnitSystem::MmTonneSecond => 1e-3,
        UnitSystem::None | UnitSystem::Si => 1.0,
    };
    let points = &export.table.points;
    let line = |(speed, coefficient): &(f64, f64)| format!("{:?}, {coefficient:?}", speed * metres);
    let mut lines: Vec<String> = points.iter().map(line).collect();
    // Beyond the table the coefficient stays.
    lines.extend(points.last().map(|(speed, coefficient)| line(&(2.0 * speed, *coefficient))));
    let _ = writeln!(text, "model {NAME} \"Friction of a contact; f_normalized = 1 is its load\"");
    let _ = writeln!(text, "  extends Modelica.Mechanics.Translational.Components.Brake(");
    let _ = writeln!(text, "    mu_pos=[{}],", lines.join(";\n      "));
    let _ = writeln!(text, "    peak={:?},", export.peak);
    let _ = writeln!(text, "    fn_max={:?});", export.normal_load);
    let _ = writeln!(text, "end {NAME};");
    text
}
