//! What the verified dither of a design demands of the actuator.

use quell_design::actuator::{Actuator, ActuatorDemand, SignalSize};
use quell_model::units::Quantity;

use super::{LeastDitherFound, StudyWithDesign};
use crate::fields::Fields;
use crate::words::digits;

/// Samples in a period below which the steps of a controller change the dither.
const FEW_SAMPLES: f64 = 10.0;

/// Ratio of the actuator's spring or mass to that of the structure from which it is warned of.
const CHANGES: f64 = 0.1;

/// Ratio above which the number itself says nothing.
const VERY_LARGE: f64 = 1000.0;

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
        let few = demand.samples_per_period.filter(|samples| *samples < FEW_SAMPLES);
        let few = few.map(|samples| {
            format!(
                "the controller has {} samples in a period of the dither, so that the force is a staircase: waveform \"samples\" with \
                 hold = \"zero\" describes it",
                digits(samples)
            )
        });
        let change = demand.change_of_structure;
        let times = match change {
            _ if change < CHANGES => None,
            _ if change > VERY_LARGE => Some(format!("more than {} times", digits(VERY_LARGE))),
            _ => Some(format!("{} times", digits(change))),
        };
        let changed = times.map(|times| {
            format!(
                "the spring or the mass of the actuator is {times} that of the structure there, and the verdicts are about the structure \
                 without it: where no controller holds the force, add both to the structure and omit them in [actuator]"
            )
        });
        let free = matches!(actuator, Actuator::Piezo(stack) if stack.stiffness == 0.0);
        let free = free.then(|| {
            "[actuator] has neither free_stroke nor stiffness: the spring of the stack must be part of the structure".to_owned()
        });
        [few, changed, free].into_iter().flatten().collect()
    }

    /// Adds `drive`.
    pub(super) fn put_drive(
        &self,
        fields: &mut Fields,
        study: &dyn StudyWithDesign,
        drive: Drive<'_>,
    ) {
        let (demand, point) = match drive {
            Ok(drive) => drive,
            Err(why) => {
                fields.unknown("drive", why.as_str());
                return;
            }
        };
        let sizes = |quantity: Quantity, size: Result<SignalSize, String>| {
            let mut inner = study.fields();
            let of = |pick: fn(SignalSize) -> f64| size.clone().map(pick);
            inner
                .known("peak", quantity, of(|size| size.peak))
                .known("rms", quantity, of(|size| size.root_mean_square))
                .known("peak_to_peak", quantity, of(|size| size.peak_to_peak));
            inner
        };
        let mut inner = study.fields();
        if let Some(actuator) = study.actuator() {
            inner.plain("kind", actuator.kind().name());
        }
        inner
            .nested("force", sizes(Quantity::Force, Ok(demand.force)))
            .nested("displacement", sizes(Quantity::Displacement, Ok(demand.displacement)))
            .nested("voltage", sizes(Quantity::Voltage, demand.voltage.clone()))
            .nested("current", sizes(Quantity::Current, demand.current.clone()))
            .known(
                "samples_per_period",
                Quantity::Ratio,
                demand.samples_per_period.ok_or_else(|| "sample_rate is not given".to_owned()),
            );
        let rated = demand.limits.iter().map(|known| {
            let mut inner = study.fields();
            inner.plain("limit", known.limit.path());
            inner.known("used", Quantity::Ratio, known.used.clone());
            inner
        });
        inner.list("rated", rated.collect::<Vec<_>>());
        inner.plain("point", self.point_by_path(point));
        fields.nested("drive", inner);
    }
}
