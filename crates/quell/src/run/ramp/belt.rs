//! The ramp of a belt.

use quell_dynamics::orbit::threshold::{BranchEnding, NoThresholds, local};
use quell_dynamics::simulation::{Sample, within};
use quell_model::parameter::{BELT_VELOCITY, NORMAL_LOAD};
use quell_model::profile::Profile;
use quell_model::units::Quantity;

use super::{Ramp, RampCourse, RampThreshold, RampedMotion, STEPS};
use crate::complaint::Failure;
use crate::contact_state::refused_of_belt;
use crate::effort::STEPS_OF_MANY_SEARCHES;
use crate::run::simulate::{self, NATURAL_PERIOD, Options, slowest_repetition};
use crate::run::thresholds::side;
use crate::study::BeltStudy;

/// Runs the ramp of a belt from τ = 0 to the last knot.
///
/// # Errors
/// A complaint about a study that is no ramp; as [`simulate::run`].
pub fn of_belt(study: &BeltStudy) -> Result<Ramp, Failure> {
    refused_of_belt(study, "bifurcation --ramp")?;
    let ramped = RampCourse::only(courses(study), oscillates(study))?;
    let options = Options { samples: true, ..Options::default() };
    let run = simulate::run(study, ramped.until(), options)?;
    let samples = run.samples.as_deref().unwrap_or_default();
    let column = |of: fn(&Sample) -> f64| samples.iter().map(of).collect::<Vec<f64>>();
    let motion = RampedMotion {
        times: column(|sample| sample.time),
        displacement: column(|sample| sample.displacement),
        velocity: Some(column(|sample| sample.velocity)),
        period: NATURAL_PERIOD,
        fast: slowest_repetition(study),
    };
    let thresholds = thresholds(study, &ramped);
    let (end, warnings) = (run.end.time, run.warnings(study));
    Ok(Ramp::new("the mass", ramped, (run.manoeuvre, end), motion, thresholds, warnings))
}

/// What varies by knots.
fn courses(study: &BeltStudy) -> Vec<RampCourse> {
    let belt = study.belt();
    let mut found = Vec::new();
    let given =
        [(belt.drive(), BELT_VELOCITY, "belt velocity"), (belt.load(), NORMAL_LOAD, "normal load")];
    for (profile, parameter, words) in given {
        found.extend(profile.and_then(Profile::knots).map(|knots| RampCourse {
            path: parameter.path.to_owned(),
            words: words.to_owned(),
            quantity: parameter.quantity,
            knots: knots.clone(),
            factor: 1.0,
        }));
    }
    for (index, dither) in belt.dithers().iter().enumerate() {
        found.extend(dither.envelope.as_ref().map(|envelope| RampCourse {
            path: belt.dither_path(index, "amplitude"),
            words: "dither amplitude".to_owned(),
            quantity: Quantity::Force,
            knots: envelope.clone(),
            factor: dither.amplitude,
        }));
    }
    found
}

fn oscillates(study: &BeltStudy) -> bool {
    let belt = study.belt();
    [belt.drive(), belt.load()].into_iter().flatten().any(|profile| !profile.waves().is_empty())
}

/// Thresholds of the steady belt over the values of the ramp.
fn thresholds(study: &BeltStudy, ramped: &RampCourse) -> Result<Vec<RampThreshold>, String> {
    let (from, largest) = ramped.searched()?;
    let belt = study.belt().steady_at(ramped.time_of_largest()).map_err(|why| why.to_string())?;
    let at = |values: &[f64]| {
        let value = values[0];
        let varied = match ramped.path.as_str() {
            path if path == BELT_VELOCITY.path => belt.with_belt_velocity(value),
            path if path == NORMAL_LOAD.path => belt.with_normal_load(value),
            path => {
                let is = |index: &usize| belt.dither_path(*index, "amplitude") == path;
                let dither = (0..belt.dithers().len()).find(is)?;
                belt.with_amplitude(dither, value)
            }
        };
        varied.ok()
    };
    let found = within(STEPS_OF_MANY_SEARCHES, || local(&at, from, largest, STEPS));
    let found = found.map_err(|why| match why {
        NoThresholds::Invalid { value } => format!("the value {value} is not allowed"),
        NoThresholds::Start(why) => format!("no base response at the least value: {why}"),
        NoThresholds::Lost { at } => format!("the continuation lost the base response at {at}"),
    })?;
    if found.ending != BranchEnding::Covered && found.thresholds.is_empty() {
        return Err(super::NOT_COVERED.to_owned());
    }
    let each = found.thresholds.iter().map(|threshold| RampThreshold {
        value: threshold.value,
        kind: threshold.kind.name(),
        becomes: side(threshold.becomes),
    });
    Ok(each.collect())
}
