//! `friction`: the law and the effective friction of every contact under the dither.

use std::fmt::Write as _;

use quell_linear::averaging::SlopeSide;
use quell_model::units::Quantity;
use serde_json::Value as Json;

use super::table::{NumberColumns, figure, heading};
use super::{Presented, friction_export};
use crate::complaint::{Complaint, Failure, Fault, Origin};
use crate::dataset::Dataset;
use crate::picture;
use crate::plot::Figure;
use crate::run::friction::{
    ContactCurves, ContactFriction, FrictionCurve, FrictionPoint, MeasuredFriction, NoCoefficient,
    export,
};
use crate::run::law;
use crate::run::system::velocity_in_words;
use crate::study::{SystemSetup, SystemStudy};

/// Rows of a table up to which every slip velocity is shown.
const FEW: usize = 100;

impl Presented<SystemSetup> for ContactCurves {
    const NAME: &'static str = "friction";

    fn json(&self, study: &SystemStudy) -> Json {
        self.json(study)
    }

    fn sentence(&self, study: &SystemStudy) -> Option<String> {
        Some(self.sentence(study))
    }

    fn notes(&self, study: &SystemStudy) -> Vec<String> {
        self.notes(study)
    }

    fn table(&self, study: &SystemStudy) -> String {
        self.contacts.iter().map(|contact| table(study, contact)).collect()
    }

    fn datasets(&self, study: &SystemStudy) -> Vec<(&'static str, Dataset)> {
        vec![("friction", self.dataset(study))]
    }

    fn exported(&self, study: &SystemStudy, extension: &str) -> Option<Result<Vec<u8>, Failure>> {
        if !friction_export::EXTENSIONS.contains(&extension) {
            return None;
        }
        if self.contacts.iter().any(|contact| contact.curve.measured.is_some()) {
            let allowed = "left out: the files of other programs have the averaged friction";
            let (fault, origin) = (Fault::Conflict, Origin::Argument("measured"));
            return Some(Err(Complaint::new(fault, "measured", origin, true, allowed).into()));
        }
        let text =
            export::run(study, self).map(|export| friction_export::text(study, &export, extension));
        text.map(|text| text.map(String::into_bytes)).transpose()
    }

    fn figure(&self, study: &SystemStudy) -> Option<Result<Figure, Failure>> {
        Some(Ok(picture::friction::figure(study, self)))
    }
}

fn table(study: &SystemStudy, contact: &ContactFriction) -> String {
    let unit = |quantity| study.units().unit(quantity);
    let curve = &contact.curve;
    let mut text = format!("Contact {}\n", contact.name);
    for (label, words) in law::words(&contact.law, &|speed| velocity_in_words(study, speed)) {
        let _ = writeln!(text, "{}: {words}", label.trim());
    }
    let mut headings = vec![
        heading("slip velocity v_r", unit(Quantity::Velocity)),
        "coefficient μ".to_owned(),
        "effective μ̄".to_owned(),
        heading("slope μ̄′", unit(Quantity::PerVelocity)),
    ];
    let (words, last) = if curve.measured.is_some() {
        headings.extend(["measured ⟨f/N⟩", "time in stick"].map(str::to_owned));
        (
            "; the friction ⟨f/N⟩ of steady responses, the fraction of the period in stick, and the stability of the response",
            "  response",
        )
    } else {
        ("", "")
    };
    let (columns, line) = NumberColumns::under(&headings);
    let _ = writeln!(
        text,
        "Friction versus slip velocity: the law μ, the effective friction μ̄ under the dither, and its slope{words}\n{line}{last}"
    );
    // The full grid goes to files and programs; the table shows every tenth point.
    let stride = if curve.points.len() > FEW { 10 } else { 1 };
    for (index, point) in curve.points.iter().enumerate().step_by(stride) {
        let law = match &point.coefficient {
            Ok(value) => figure(*value),
            Err(NoCoefficient::AtRest { .. }) => "any".to_owned(),
            Err(NoCoefficient::NotFinite(_)) => "unknown".to_owned(),
        };
        let (mean, slope) = match &point.effective {
            Ok(found) => (figure(found.coefficient), figure(found.slope)),
            // Without slip any friction may hold; elsewhere a reason follows.
            Err(_) if point.slip_velocity == 0.0 => ("any".to_owned(), "none".to_owned()),
            Err(_) => ("unknown".to_owned(), "unknown".to_owned()),
        };
        let mut cells = vec![figure(point.slip_velocity), law, mean, slope];
        let found = curve.measured.as_ref().and_then(|measured| measured.get(index));
        let last = found.map_or_else(String::new, |found| {
            let (numbers, words) = measured_words(found);
            cells.extend(numbers);
            format!("  {words}")
        });
        let _ = writeln!(text, "{}{last}", columns.line(&cells));
    }
    text.push_str(&one_sided(curve.points.iter().step_by(stride)));
    text.push_str(&reasons(curve));
    text
}

/// At which of the slip velocities the slope has two values, and which of them is given.
fn one_sided<'a>(points: impl Iterator<Item = &'a FrictionPoint>) -> String {
    let outer = points
        .filter(|point| point.effective.as_ref().is_ok_and(|found| found.side == SlopeSide::Outer));
    let places: Vec<String> = outer.map(|point| figure(point.slip_velocity)).collect();
    if places.is_empty() {
        return String::new();
    }
    format!(
        "  at v_r = {} the largest fast velocity equals the slip velocity and the slope jumps: it is that for larger |v_r|\n",
        places.join(" and ")
    )
}

/// The columns of the measured friction, and the words after them.
fn measured_words(found: &MeasuredFriction) -> ([String; 2], String) {
    match found {
        Ok(found) => {
            let which = if found.base { "" } else { ", not the continuation of sliding" };
            let numbers = [found.coefficient, found.stick_fraction].map(figure);
            (numbers, format!("{}{which}", found.verdict.name()))
        }
        Err(_) => (["none", "none"].map(str::to_owned), "none".to_owned()),
    }
}

/// Why friction is unknown or could not be measured, each reason once, with the slip velocities.
fn reasons(curve: &FrictionCurve) -> String {
    const MOST: usize = 4;
    let unknown = curve.points.iter().filter(|point| point.slip_velocity != 0.0);
    let unknown = unknown.filter_map(|point| {
        Some(("unknown", point.slip_velocity, point.effective.as_ref().err()?.to_string()))
    });
    let unmeasured = curve.points.iter().zip(curve.measured.iter().flatten());
    let unmeasured = unmeasured.filter_map(|(point, found)| {
        Some(("not measured", point.slip_velocity, found.as_ref().err()?.to_string()))
    });
    let mut reasons: Vec<((&str, String), Vec<String>)> = Vec::new();
    for (what, slip, why) in unknown.chain(unmeasured) {
        let at = figure(slip);
        match reasons.iter_mut().find(|((kind, known), _)| (*kind, known) == (what, &why)) {
            Some((_, places)) => places.push(at),
            None => reasons.push(((what, why), vec![at])),
        }
    }
    let lines = reasons.into_iter().map(|((what, why), places)| {
        let more = places.len().saturating_sub(MOST);
        let listed = places[..places.len() - more].join(", ");
        let more = if more > 0 { format!(" and {more} more") } else { String::new() };
        format!("  {what} at v_r = {listed}{more}: {why}\n")
    });
    lines.collect()
}
