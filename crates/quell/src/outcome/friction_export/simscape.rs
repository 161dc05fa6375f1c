//! A script of MATLAB with a structure `friction`: the parameters of Simscape's Translational Friction, and vectors for blocks
//! that take a table (Loaded-Contact Translational Friction: velocity and kinetic coefficient).
//!
//! Source: `MathWorks`, Translational Friction and Loaded-Contact Translational Friction.

use std::fmt::Write as _;

use super::comments::{ExportUnits, comment, provenance};
use crate::run::friction::export::FrictionExport;
use crate::study::SystemStudy;
use crate::words::more_digits;

/// Marks a comment.
const MARK: &str = "%";

/// The file.
pub(super) fn text(study: &SystemStudy, export: &FrictionExport, units: &ExportUnits) -> String {
    let mut text = String::new();
    comment(&mut text, MARK, &provenance(study, export, units));
    let &ExportUnits { speed, force, .. } = units;
    let load = export.normal_load;
    let fit = &export.translational;
    let least = more_digits(fit.slowest);
    let about = format!(
        "Translational Friction, fitted: largest error {} of the force in {force}, at slip speeds from {least} up",
        more_digits(fit.largest_error * load)
    );
    let viscous = format!("{force}/({speed})");
    text.push('\n');
    comment(&mut text, MARK, &[about]);
    for (name, value, unit) in [
        ("normal_force", load, force),
        ("breakaway_friction_force", fit.breakaway * load, force),
        ("breakaway_friction_velocity", fit.breakaway_velocity, speed),
        ("coulomb_friction_force", fit.coulomb * load, force),
        ("viscous_friction_coefficient", fit.viscous * load, &viscous),
        ("largest_error", fit.largest_error * load, force),
    ] {
        let _ = writeln!(text, "friction.{name} = {value:?}; % {unit}");
    }
    text.push('\n');
    let about =
        "Lookup table, linear between points: kinetic coefficient and force over the slip speed"
            .to_owned();
    comment(&mut text, MARK, &[about]);
    let points = &export.table.points;
    vector(&mut text, "slip_velocity", points.iter().map(|point| point.0), speed);
    vector(&mut text, "kinetic_coefficient", points.iter().map(|point| point.1), "1");
    vector(&mut text, "force", points.iter().map(|point| point.1 * load), force);
    let error = export.table.largest_error;
    let _ = writeln!(text, "friction.largest_table_error = {error:?}; % of the coefficient");
    text
}

fn vector(text: &mut String, name: &str, values: impl Iterator<Item = f64>, unit: &str) {
    let values: Vec<String> = values.map(|value| format!("{value:?}")).collect();
    let _ = writeln!(text, "friction.{name} = [ ... % {unit}");
    for line in values.chunks(4) {
        let _ = writeln!(text, "    {} ...", line.join(" "));
    }
    text.push_str("];\n");
}
