//! What the verified dither of a design demands of the actuator.

use quell_design::actuator::ActuatorDemand;

use super::found::LeastDitherFound;
use super::study_with_design::StudyWithDesign;
use crate::fields::Fields;
use crate::run::actuator::{demand_fields, warning_about_samples, warnings_about_actuator};
use crate::words::digits;

/// A demand with its operating point, or why it is unknown.
type Drive<'a> = Result<&'a (ActuatorDemand, Vec<f64>), &'a String>;

impl LeastDitherFound {
    /// The most used limit in words; empty without an actuator.
    pub(super) fn drive_in_words(&self, study: &dyn StudyWithDesign, drive: Drive<'_>) -> String {
        let (Some(_), Ok((demand, point))) = (study.actuator(), drive) else {
            return String::new();
        };
        let Ok((limit, used)) = demand.tightest() else { return String::new() };
        format!(
            " It uses {} % of {}{}.",
            digits(100.0 * used),
            limit.path(),
            self.point_in_words(point)
        )
    }

    /// Warnings about a controller with few samples in a period, and about an actuator that changes the structure.
    pub(super) fn warnings_about_drive(&self, study: &dyn StudyWithDesign) -> Vec<String> {
        let Some(actuator) = study.actuator() else { return Vec::new() };
        let Ok(found) = &self.answer().answer else { return Vec::new() };
        let Ok((demand, _)) = &found.drive else { return Vec::new() };
        let few = warning_about_samples(demand.samples_per_period);
        few.into_iter().chain(warnings_about_actuator(actuator, demand)).collect()
    }

    /// Adds `drive`.
    pub(super) fn put_drive(
        &self,
        fields: &mut Fields,
        study: &dyn StudyWithDesign,
        drive: Drive<'_>,
    ) {
        match drive {
            Ok((demand, point)) => {
                let mut inner = demand_fields(study, demand);
                inner.plain("point", self.point_by_path(point));
                fields.nested("drive", inner);
            }
            Err(why) => {
                fields.unknown("drive", why.as_str());
            }
        }
    }
}
