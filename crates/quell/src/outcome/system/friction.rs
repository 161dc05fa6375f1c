//! `friction` of a system.

use std::fmt::Write as _;

use quell_model::units::Quantity;
use serde_json::Value as Json;

use crate::complaint::Failure;
use crate::dataset::Dataset;
use crate::outcome::Presented;
use crate::outcome::friction::one_sided;
use crate::outcome::table::figure;
use crate::picture;
use crate::plot::Figure;
use crate::run::system::friction::SystemFriction;
use crate::study::{SystemSetup, SystemStudy};

/// Rows of a table up to which every slip velocity is shown.
const FEW: usize = 100;

impl Presented<SystemSetup> for SystemFriction {
    fn json(&self, study: &SystemStudy) -> Json {
        self.json(study)
    }

    fn table(&self, study: &SystemStudy) -> String {
        let unit = study.units().unit(Quantity::Velocity);
        let unit = unit.map_or(String::new(), |unit| format!(" in {unit}"));
        let mut text = String::new();
        for contact in &self.contacts {
            let _ = write!(
                text,
                "Contact {}: friction versus slip velocity v_r{unit}: the law μ, the effective friction μ̄ under the dither, and its \
                 slope\n  {:>14}  {:>14}  {:>14}  {:>14}\n",
                contact.name, "v_r", "μ", "μ̄", "μ̄′"
            );
            let points = &contact.curve.points;
            // The full grid goes to files and programs; the table shows every tenth point.
            let stride = if points.len() > FEW { 10 } else { 1 };
            for point in points.iter().step_by(stride) {
                let law =
                    point.coefficient.as_ref().map_or_else(|_| "any".to_owned(), |v| figure(*v));
                let (mean, slope) = match &point.effective {
                    Ok(found) => (figure(found.coefficient), figure(found.slope)),
                    Err(_) => ("unknown".to_owned(), "unknown".to_owned()),
                };
                let v = figure(point.slip_velocity);
                let _ = writeln!(text, "  {v:>14}  {law:>14}  {mean:>14}  {slope:>14}");
            }
            text.push_str(&one_sided(points.iter().step_by(stride), figure));
            let mut reasons: Vec<&String> =
                points.iter().filter_map(|point| point.effective.as_ref().err()).collect();
            reasons.dedup();
            for why in reasons {
                let _ = writeln!(text, "  unknown: {why}");
            }
        }
        text
    }

    fn datasets(&self, study: &SystemStudy) -> Vec<(&'static str, Dataset)> {
        vec![("friction", self.dataset(study))]
    }

    fn figure(&self, study: &SystemStudy) -> Option<Result<Figure, Failure>> {
        Some(Ok(picture::friction::of_system(study, self)))
    }
}
