//! The schedule of a design: a dither whose amplitude follows the operating point.

use quell_design::least_dither::DesignObjective;
use quell_model::units::Quantity;

use super::answer::quantity_of;
use super::found::LeastDitherFound;
use super::study_with_design::StudyWithDesign;
use super::unknown::NoSaving;
use crate::fields::Fields;
use crate::words::{digits, quantity_at};

impl LeastDitherFound {
    /// The share of the objective that a schedule saves on average over the box; more than 1 where the mean is negative, as a loss of
    /// friction can be.
    fn saved(&self) -> Result<f64, NoSaving> {
        let schedule = self.schedule.as_ref().map_err(Clone::clone)?;
        let found = self.answer().answer.as_ref().map_err(|_| NoSaving::NothingAllowed)?;
        let single = found.critical.objective.clone()?;
        let objectives = schedule.iter().map(|row| row.objective.clone());
        let objectives: Vec<f64> = objectives.collect::<Result<_, _>>()?;
        if objectives.is_empty() || single <= 0.0 {
            return Err(NoSaving::NotPositive);
        }
        Ok(1.0 - objectives.iter().sum::<f64>() / objectives.len() as f64 / single)
    }

    /// What a schedule saves, in a sentence; `None` where that is unknown or nothing.
    pub(super) fn schedule_in_words(&self, study: &dyn StudyWithDesign) -> Option<String> {
        let (saved, over) = self.saved().ok().zip(self.over.first())?;
        let minimise = study.asked().map_or(DesignObjective::Amplitude, |asked| asked.minimise);
        if saved < 5e-4 {
            return None;
        }
        let (percent, path) = (digits(libm::round(1000.0 * saved) / 10.0), quantity_at(&over.path));
        let name = minimise.name().replace('-', " ");
        Some(match minimise {
            DesignObjective::Amplitude => {
                format!(
                    "An amplitude that follows the {path} would be {percent} % smaller on average."
                )
            }
            _ if saved > 1.0 => {
                format!(
                    "With an amplitude that follows the {path} the {name} is negative on average."
                )
            }
            _ => format!(
                "An amplitude that follows the {path} would need {percent} % less {name} on average."
            ),
        })
    }

    /// Adds `schedule` and `saved_by_schedule`.
    pub(super) fn put_schedule(
        &self,
        fields: &mut Fields,
        study: &dyn StudyWithDesign,
        minimise: DesignObjective,
    ) {
        match &self.schedule {
            Ok(schedule) => {
                let rows = schedule.iter().map(|row| {
                    let mut inner = study.fields();
                    for (number, value) in self.over.iter().zip(&row.point) {
                        inner.plain(&number.path, value * number.per_unit);
                    }
                    inner
                        .known("amplitude", study.quantity_of_amplitude(), row.amplitude.clone())
                        .known("objective", quantity_of(study, minimise), row.objective.clone());
                    inner
                });
                fields.list("schedule", rows.collect::<Vec<_>>());
            }
            Err(why) => {
                fields.unknown("schedule", why);
            }
        }
        fields.known("saved_by_schedule", Quantity::Ratio, self.saved());
    }
}
