//! What the verified dither of a design demands of the actuator.

use quell_design::NoAnswer;
use quell_design::actuator::{Actuator, ActuatorDemand, SignalSize, UnknownDemand};
use quell_model::units::Quantity;
use quell_numerics::order::descending_by;

use super::found::LeastDitherFound;
use super::study_with_design::StudyWithDesign;
use crate::fields::Fields;
use crate::run::actuator::{demand_fields, warning_about_samples, warnings_about_actuator};
use crate::words::{digits, listed, quantity_at};

/// A demand with its operating point, or why it is unknown.
type Drive<'a> = Result<&'a (ActuatorDemand, Vec<f64>), &'a NoAnswer>;

impl LeastDitherFound {
    /// The share of every limit in words, the most used first, and what an order needs; `None` without an actuator.
    pub(super) fn drive_in_words(
        &self,
        study: &dyn StudyWithDesign,
        drive: Drive<'_>,
    ) -> Option<String> {
        let (actuator, (demand, point)) = study.actuator().zip(drive.ok())?;
        let mut used: Vec<(f64, &str)> = demand
            .limits
            .iter()
            .filter_map(|known| Some((*known.used.as_ref().ok()?, known.limit.path())))
            .collect();
        if used.is_empty() {
            return None;
        }
        descending_by(&mut used, |a| a.0);
        let shares: Vec<String> = used
            .iter()
            .map(|(used, path)| format!("{} % of the {}", digits(100.0 * used), quantity_at(path)))
            .collect();
        // A stack is driven from zero up, so that its voltage is rated from peak to peak.
        let is_stack = matches!(actuator, Actuator::Piezo(_));
        let sizes = [
            (Quantity::Voltage, &demand.voltage, is_stack),
            (Quantity::Current, &demand.current, false),
        ];
        // In volts and amperes also without units of the study.
        let size =
            |(quantity, size, is_range): (Quantity, &Result<SignalSize, UnknownDemand>, bool)| {
                let size = size.as_ref().ok()?;
                let (value, of) = if is_range {
                    (size.peak_to_peak, "peak to peak")
                } else {
                    (size.peak, "at its peak")
                };
                Some(format!("{} {} {of}", digits(value), quantity.scaled_unit()))
            };
        let mut needs: Vec<String> = sizes.into_iter().filter_map(size).collect();
        let stroke = study.in_words(Quantity::Displacement, demand.displacement.peak_to_peak);
        needs.push(format!("{stroke} peak to peak"));
        // The least dither keeps every limit; the verified one exceeds it by the margin.
        let margin = match used.first() {
            Some((most, _)) if *most > 1.0 => " (the margin of the verified dither included)",
            _ => "",
        };
        // Of the operating point where a limit is used most; elsewhere another quantity may be larger.
        Some(format!(
            "It uses {}{margin}{}, where it takes {}.",
            listed(&shares),
            self.point_in_words(point),
            listed(&needs)
        ))
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
                fields.unknown("drive", why);
            }
        }
    }
}
