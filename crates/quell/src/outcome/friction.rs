//! `friction`: the law and the effective friction under the dither.

use std::fmt::Write as _;

use quell_model::units::Quantity;
use serde_json::Value as Json;

use super::Presented;
use super::table::figure;
use crate::complaint::Failure;
use crate::dataset::Dataset;
use crate::picture;
use crate::plot::Figure;
use crate::quantity;
use crate::run::friction::FrictionCurve;
use crate::run::law;
use crate::study::{BeltSetup, BeltStudy};

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

    fn figure(&self, study: &BeltStudy) -> Option<Result<Figure, Failure>> {
        Some(Ok(picture::friction(study, self)))
    }
}

fn table(study: &BeltStudy, curve: &FrictionCurve) -> String {
    // In the units of the study; in SI velocities are in m/s and slopes per m/s.
    let (unit, per_unit) = match study.scales() {
        Some(scales) => ("m/s".to_owned(), scales.si_per_unit(Quantity::Velocity)),
        None => (quantity::unit_of(Quantity::Velocity, false), 1.0),
    };
    let mut text = String::new();
    for (label, words) in law::words(study) {
        let _ = writeln!(text, "{}: {words}", label.trim());
    }
    let measured = curve.measured_coefficients().zip(curve.measured_stick_fractions());
    let (words, names) = match measured {
        None => ("", String::new()),
        Some(_) => (
            "; the friction ⟨f/N⟩ of steady responses, and the fraction of the period in stick",
            format!("  {:>14}  {:>14}", "measured", "in stick"),
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
            Err(_) => ("any".to_owned(), "none".to_owned()),
        };
        let v = figure(point.slip_velocity * per_unit);
        let _ = write!(text, "  {v:>14}  {law:>14}  {mean:>14}  {slope:>14}");
        if let Some((coefficients, stuck)) = &measured {
            let shown = |value: f64| if value.is_nan() { "none".to_owned() } else { figure(value) };
            let [coefficient, stuck] = [coefficients[index], stuck[index]].map(shown);
            let _ = write!(text, "  {coefficient:>14}  {stuck:>14}");
        }
        text.push('\n');
    }
    text
}
