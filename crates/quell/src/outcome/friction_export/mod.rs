//! Averaged friction as files of other programs: Abaqus (`.inp`), MATLAB with Simscape (`.m`) and Modelica (`.mo`).

mod abaqus;
mod comments;
mod modelica;
mod simscape;

use self::comments::ExportUnits;
use crate::run::friction::export::FrictionExport;
use crate::study::SystemStudy;

/// Extensions of these files.
pub const EXTENSIONS: &[&str] = &["inp", "m", "mo"];

/// The text of a file with this extension, one of [`EXTENSIONS`].
pub(super) fn text(
    study: &SystemStudy,
    export: &FrictionExport,
    extension: &str,
) -> Option<String> {
    let units = ExportUnits::of(study);
    match extension {
        "inp" => Some(abaqus::text(study, export, &units)),
        "mo" => Some(modelica::text(study, export, &units)),
        "m" => Some(simscape::text(study, export, &units)),
        _ => None,
    }
}
