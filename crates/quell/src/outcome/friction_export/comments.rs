//! What the files of friction for other programs have in common: units, and comments with their provenance.

use std::fmt::Write as _;

use quell_model::units::Quantity;

use crate::run::friction::export::FrictionExport;
use crate::run::law;
use crate::run::system::velocity_in_words;
use crate::study::{SystemStudy, UnitSystem};
use crate::words::more_digits;

/// The units of the numbers of a file, which are those of the study.
pub(super) struct ExportUnits {
    pub(super) speed: &'static str,
    pub(super) force: &'static str,
    /// What a slip rate is to be multiplied by for one in mm/s, where it has a unit and is not one already.
    pub(super) millimetres: Option<f64>,
}

impl ExportUnits {
    pub(super) fn of(study: &SystemStudy) -> Self {
        let unit = |quantity| study.units().unit(quantity).unwrap_or("in the unit of the study");
        let is_si = study.units() == UnitSystem::Si;
        let millimetres = is_si.then_some(1000.0);
        Self { speed: unit(Quantity::Velocity), force: unit(Quantity::Force), millimetres }
    }
}

/// The lines that say what the numbers are and where they hold, without marks of comments.
pub(super) fn provenance(
    study: &SystemStudy,
    export: &FrictionExport,
    units: &ExportUnits,
) -> Vec<String> {
    let mut lines = vec![format!("quell {} friction", env!("CARGO_PKG_VERSION"))];
    lines.extend(study.title().map(|title| format!("title: {}", title.replace(['\n', '\r'], " "))));
    let what = if export.fast_velocity.is_some() {
        "friction of the slow motion, averaged over one period of the dither"
    } else {
        "friction of the law; the study has no dither"
    };
    lines.push(what.to_owned());
    if let Some(fast) = export.fast_velocity {
        lines.push(format!("largest fast slip velocity: {} {}", more_digits(fast), units.speed));
        lines.push("It holds while the slow motion is slow against the dither.".to_owned());
    }
    let table = &export.table;
    let last = table.points.last().map_or(0.0, |point| point.0);
    lines.push(format!("slip speeds from 0 to {} {}", more_digits(last), units.speed));
    lines.push(format!(
        "largest error of the coefficient between the {} points of the table: {}",
        table.points.len(),
        more_digits(table.largest_error)
    ));
    for contact in &study.system().contacts {
        let words = law::words(&contact.friction, &|speed| velocity_in_words(study, speed));
        lines.extend(words.into_iter().map(|(label, words)| format!("{}: {words}", label.trim())));
    }
    lines.extend(export.warnings.iter().map(|warning| format!("warning: {warning}")));
    lines.extend(study.changes().iter().map(|change| format!("changed: {change}")));
    lines.push("study:".to_owned());
    lines.extend(study.text().lines().map(|line| format!("  {line}")));
    lines
}

/// Adds lines of comments.
pub(super) fn comment(text: &mut String, mark: &str, lines: &[String]) {
    for line in lines {
        // A line feed in a title or a warning would end the comment.
        let line = line.replace(['\n', '\r'], " ");
        let _ = writeln!(text, "{}", format!("{mark} {line}").trim_end());
    }
}
