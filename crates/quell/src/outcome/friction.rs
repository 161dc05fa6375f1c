//! `friction`: the law and the effective friction under the dither.

use std::fmt::Write as _;

use quell_dynamics::response::SteadyFriction;
use quell_linear::averaging::SlopeSide;
use quell_model::units::Quantity;
use serde_json::Value as Json;

use super::table::figure;
use super::{Presented, friction_export};
use crate::complaint::{Complaint, Failure, Fault, Origin};
use crate::dataset::Dataset;
use crate::picture;
use crate::plot::Figure;
use crate::quantity;
use crate::run::friction::{FrictionCurve, FrictionPoint};
use crate::run::law;
use crate::study::{BeltSetup, BeltStudy};
use crate::words::in_words;

impl Presented<BeltSetup> for FrictionCurve {
    fn json(&self, study: &BeltStudy) -> Json {
        self.json(study)
    }

    fn table(&self, study: &BeltStudy) -> String {
        table(study, self)
    }

    fn datasets(&self, study: &BeltStudy) -> Vec<(&'static str, Dataset)> {
        vec![("friction", self.dataset(study))]
    }

    fn exported(&self, study: &BeltStudy, extension: &str) -> Option<Result<Vec<u8>, Failure>> {
        if !friction_export::EXTENSIONS.contains(&extension) {
            return None;
        }
        if self.measured.is_some() {
            let allowed = "left out: the files of other programs have the averaged friction";
            let (fault, origin) = (Fault::Conflict, Origin::Argument("measured"));
            return Some(Err(Complaint::new(fault, "measured", origin, true, allowed).into()));
        }
        let fastest = self.points.iter().map(|point| point.slip_velocity.abs()).fold(0.0, f64::max);
        let text = crate::run::friction_export::run(study, fastest)
            .map(|export| friction_export::text(study, &export, extension));
        text.map(|text| text.map(String::into_bytes)).transpose()
    }

    fn figure(&self, study: &BeltStudy) -> Option<Result<Figure, Failure>> {
        Some(Ok(picture::friction::of_belt(study, self)))
    }
}

fn table(study: &BeltStudy, curve: &FrictionCurve) -> String {
    // In the units of the study; in SI velocities are in m/s and slopes per m/s.
    let (unit, per_unit) = match study.scales().and_then(|scales| scales.one(Quantity::Velocity)) {
        Some((one, unit)) => (unit.to_owned(), one),
        None => (quantity::unit_of(Quantity::Velocity, None), 1.0),
    };
    let mut text = String::new();
    for (label, words) in
        law::words(study.belt().friction(), &|speed| in_words(study, Quantity::Velocity, speed))
    {
        let _ = writeln!(text, "{}: {words}", label.trim());
    }
    let (words, names) = match curve.measured {
        None => ("", String::new()),
        Some(_) => (
            "; the friction ⟨f/N⟩ of steady responses, the fraction of the period in stick, and the stability of the response",
            format!("  {:>14}  {:>14}  response", "measured", "in stick"),
        ),
    };
    let _ = write!(
        text,
        "Friction versus slip velocity v_r in {unit}: the law μ, the effective friction μ̄ under the dither, \
         and its slope{words}\n  {:>14}  {:>14}  {:>14}  {:>14}{names}\n",
        "v_r", "μ", "μ̄", "μ̄′"
    );
    // The full grid goes to files and programs; the table shows every tenth point.
    let stride = if curve.points.len() > 100 { 10 } else { 1 };
    for (index, point) in curve.points.iter().enumerate().step_by(stride) {
        let law =
            point.coefficient.as_ref().map_or_else(|_| "any".to_owned(), |value| figure(*value));
        let (mean, slope) = match &point.effective {
            Ok(found) => (figure(found.coefficient), figure(found.slope / per_unit)),
            // Without slip any friction may hold; elsewhere a reason follows.
            Err(_) if point.slip_velocity == 0.0 => ("any".to_owned(), "none".to_owned()),
            Err(_) => ("unknown".to_owned(), "unknown".to_owned()),
        };
        let v = figure(point.slip_velocity * per_unit);
        let _ = write!(text, "  {v:>14}  {law:>14}  {mean:>14}  {slope:>14}");
        if let Some(found) = curve.measured.as_ref().and_then(|measured| measured.get(index)) {
            let _ = write!(text, "  {}", measured_words(found));
        }
        text.push('\n');
    }
    text.push_str(&one_sided(curve.points.iter().step_by(stride), |v| figure(v * per_unit)));
    text.push_str(&reasons(curve, |v| figure(v * per_unit)));
    text
}

/// At which of the slip velocities the slope has two values, and which of them is given.
pub(super) fn one_sided<'a>(
    points: impl Iterator<Item = &'a FrictionPoint>,
    shown: impl Fn(f64) -> String,
) -> String {
    let outer = points
        .filter(|point| point.effective.as_ref().is_ok_and(|found| found.side == SlopeSide::Outer));
    let places: Vec<String> = outer.map(|point| shown(point.slip_velocity)).collect();
    if places.is_empty() {
        return String::new();
    }
    format!(
        "  at v_r = {} the largest fast velocity equals the slip velocity and the slope jumps: it is that for larger |v_r|\n",
        places.join(" and ")
    )
}

/// The columns of the measured friction.
fn measured_words(found: &Result<SteadyFriction, String>) -> String {
    match found {
        Ok(found) => {
            let which = if found.base { "" } else { ", not the continuation of sliding" };
            let (coefficient, stuck) = (figure(found.coefficient), figure(found.stick_fraction));
            format!("{coefficient:>14}  {stuck:>14}  {}{which}", found.verdict.name())
        }
        Err(_) => format!("{:>14}  {:>14}  none", "none", "none"),
    }
}

/// Why friction is unknown or could not be measured, each reason once, with the slip velocities.
fn reasons(curve: &FrictionCurve, shown: impl Fn(f64) -> String) -> String {
    const MOST: usize = 4;
    let unknown = curve.points.iter().filter(|point| point.slip_velocity != 0.0);
    let unknown = unknown.filter_map(|point| {
        Some(("unknown", point.slip_velocity, point.effective.as_ref().err()?.as_str()))
    });
    let unmeasured = curve.points.iter().zip(curve.measured.iter().flatten());
    let unmeasured = unmeasured.filter_map(|(point, found)| {
        Some(("not measured", point.slip_velocity, found.as_ref().err()?.as_str()))
    });
    let mut reasons: Vec<((&str, &str), Vec<String>)> = Vec::new();
    for (what, slip, why) in unknown.chain(unmeasured) {
        let at = shown(slip);
        match reasons.iter_mut().find(|(known, _)| *known == (what, why)) {
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
