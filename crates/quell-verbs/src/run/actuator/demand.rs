//! What a dither demands of an actuator, as fields and as warnings: for `actuator` and `design`.

use quell_design::actuator::{Actuator, ActuatorDemand, SignalSize, UnknownDemand};
use quell_model::units::Quantity;

use crate::fields::Fields;
use crate::run::design::StudyWithDesign;
use crate::words::digits;

/// Samples in a period below which the steps of a controller change the dither.
pub(super) const FEW_SAMPLES: f64 = 10.0;

/// Ratio of the actuator's spring or mass to that of the structure from which it is warned of.
const CHANGES: f64 = 0.1;

/// Ratio above which the number itself says nothing.
const VERY_LARGE: f64 = 1000.0;

/// Warnings about an actuator that changes the structure, and about a stack without a spring.
pub(crate) fn warnings_about_actuator(actuator: &Actuator, demand: &ActuatorDemand) -> Vec<String> {
    let change = demand.change_of_structure;
    let times = match change {
        _ if change < CHANGES => None,
        _ if change > VERY_LARGE => Some(format!("more than {} times", digits(VERY_LARGE))),
        _ => Some(format!("{} times", digits(change))),
    };
    let changed = times.map(|times| {
        if demand.in_series {
            return format!(
                "the spring of the actuator, in series with the contact, takes {} % of its normal stiffness, and the verdicts are about the \
                 structure with all of it: where no controller holds the load, give the stiffness of both in series",
                digits(100.0 * change)
            );
        }
        format!(
            "the spring or the mass of the actuator is {times} that of the structure there, and the verdicts are about the structure \
             without it: where no controller holds the force, add both to the structure and omit them in [actuator]"
        )
    });
    let is_free = matches!(actuator, Actuator::Piezo(stack) if stack.stiffness == 0.0);
    let free = is_free && !demand.in_series;
    let free = free.then(|| {
        "[actuator] has neither free_stroke nor stiffness: the spring of the stack must be part of the structure".to_owned()
    });
    changed.into_iter().chain(free).collect()
}

/// The warning about a controller with few samples in a period.
pub(crate) fn warning_about_samples(samples_per_period: Option<f64>) -> Option<String> {
    let samples = samples_per_period.filter(|samples| *samples < FEW_SAMPLES)?;
    Some(format!(
        "the controller has {} samples in a period of the dither, so that the force is a staircase: waveform \"samples\" with \
         hold = \"zero\" describes it",
        digits(samples)
    ))
}

/// Force, displacement, voltage and current of a demand, and the share of every limit.
pub(crate) fn demand_fields(study: &dyn StudyWithDesign, demand: &ActuatorDemand) -> Fields {
    let sizes = |quantity: Quantity, size: Result<SignalSize, UnknownDemand>| {
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
    inner
}
