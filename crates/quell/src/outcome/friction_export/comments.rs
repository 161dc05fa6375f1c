//! What the files of friction for other programs have in common: units, and comments with their provenance.

use std::fmt::Write as _;

use quell_model::units::Quantity;

use crate::quantity;
use crate::range::fast_velocity;
use crate::run::friction_export::FrictionExport;
use crate::run::law;
use crate::study::{BeltStudy, UnitSystem};
use crate::words::digits;
use crate::words::in_words;

/// The units of the numbers of a file: those of a study with units, else those of the equations.
pub(super) struct ExportUnits {
    /// Unit of a slip speed, and that of the study in it.
    pub(super) speed: (String, f64),
    pub(super) force: (String, f64),
    pub(super) has_units: bool,
    pub(super) is_si: bool,
}

impl ExportUnits {
    pub(super) fn of(study: &BeltStudy) -> Self {
        let unit = |quantity: Quantity| match study.scales().and_then(|scales| scales.one(quantity))
        {
            Some((one, unit)) => (unit.to_owned(), one),
            None => (quantity::unit_of(quantity, None), 1.0),
        };
        let has_units = study.scales().is_some();
        let is_si = study.units() == UnitSystem::Si;
        let (speed, force) = (unit(Quantity::Velocity), unit(Quantity::Force));
        Self { speed, force, has_units, is_si }
    }

    /// A unit of a comment: that of a number without units is dimensionless.
    pub(super) fn named(&self, (unit, _): &(String, f64)) -> String {
        if self.has_units { unit.clone() } else { format!("{unit}, dimensionless") }
    }
}

/// The lines that say what the numbers are and where they hold, without marks of comments.
pub(super) fn provenance(
    study: &BeltStudy,
    export: &FrictionExport,
    units: &ExportUnits,
) -> Vec<String> {
    let mut lines = vec![format!("quell {} friction", env!("CARGO_PKG_VERSION"))];
    lines.extend(study.title().map(|title| format!("title: {}", title.replace(['\n', '\r'], " "))));
    let what = if export.is_dithered {
        "friction of the slow motion, averaged over one period of the dither"
    } else {
        "friction of the law; the study has no dither"
    };
    lines.push(what.to_owned());
    let belt = study.belt();
    if export.is_dithered {
        let fast = digits(fast_velocity(belt) * units.speed.1);
        lines.push(format!("largest fast slip velocity: {fast} {}", units.named(&units.speed)));
        lines.push("It holds while the slow motion is slow against the dither.".to_owned());
    }
    let table = &export.table;
    let last = table.points.last().map_or(0.0, |point| point.0);
    lines.push(format!(
        "slip speeds from 0 to {} {}",
        digits(last * units.speed.1),
        units.named(&units.speed)
    ));
    lines.push(format!(
        "largest error of the coefficient between the {} points of the table: {}",
        table.points.len(),
        digits(table.largest_error)
    ));
    for (label, words) in
        law::words(study.belt().friction(), &|speed| in_words(study, Quantity::Velocity, speed))
    {
        lines.push(format!("{}: {words}", label.trim()));
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
