//! What a ramp changes: the velocity of a surface, the load of a contact, or the amplitude of a dither; its run, and the thresholds over
//! the values that it passes.

use std::f64::consts::TAU;

use quell_dynamics::orbit::BranchEnding;
use quell_model::parameter::{BELT_VELOCITY, NORMAL_LOAD, indexed};
use quell_model::profile::{Profile, Wave};
use quell_model::system::{Contact, Input, InputTarget};
use quell_model::units::Quantity;
use quell_numerics::interval::RealInterval;

use super::{NoRampThresholds, Ramp, RampCourse, RampThreshold, RampedMotion};
use crate::complaint::Failure;
use crate::run::simulate::{self, MotionRequest};
use crate::run::system::attractor::rate_of;
use crate::run::system::has_equations;
use crate::run::system::periods::natural_period;
use crate::run::system::tracked;
use crate::run::thresholds::{self, ThresholdsRequest, by_eigenvalues, side};
use crate::study::SystemStudy;

/// Runs the ramp of a study from t = 0 to the last knot.
///
/// # Errors
/// A complaint about a study that is no ramp; as [`simulate::run`].
pub fn run(study: &SystemStudy) -> Result<Ramp, Failure> {
    has_equations(study, "bifurcation --ramp")?;
    let ramped = RampCourse::only(courses(study), oscillates(study))?;
    let until = ramped.until();
    let request = MotionRequest { until: Some(until), samples: true, ..MotionRequest::default() };
    let run = simulate::run(study, &request)?;
    let system = study.system();
    let (times, states) = run
        .samples
        .as_ref()
        .map_or((&[][..], &[][..]), |found| (&found.times[..], &found.states[..]));
    let row = study.observe();
    let observed = |state: &[f64]| row.iter().zip(state).map(|(r, x)| r * x).sum::<f64>();
    let acting = system.waves().filter(|wave| wave.amplitude != 0.0);
    let states = states.chunks_exact(system.state_size());
    let is_mechanical = system.structure.mechanical().is_some();
    let motion = RampedMotion {
        times: times.to_vec(),
        displacement: states.clone().map(observed).collect(),
        velocity: is_mechanical.then(|| states.map(|state| rate_of(&row, state)).collect()),
        period: natural_period(study, RealInterval::new(run.start.time, until)),
        fast: acting.map(Wave::repetition).reduce(f64::min).map(|rate| TAU / rate),
    };
    let thresholds = thresholds(study, &ramped);
    let (end, warnings) = (run.end.time, run.warnings(study));
    Ok(Ramp::new(ramped, (run.manoeuvre, end), motion, thresholds, warnings))
}

/// What varies by knots.
fn courses(study: &SystemStudy) -> Vec<RampCourse> {
    let system = study.system();
    let mut found = Vec::new();
    for contact in &system.contacts {
        let name = &contact.name;
        let drive = Some(&contact.surface_velocity);
        let given = [
            (drive, BELT_VELOCITY, format!("surface velocity of contact {name}")),
            (contact.varying_load.as_ref(), NORMAL_LOAD, format!("normal load of contact {name}")),
        ];
        for (profile, parameter, words) in given {
            found.extend(profile.and_then(Profile::knots).map(|knots| RampCourse {
                path: study.path_of(name, parameter),
                words,
                quantity: parameter.quantity,
                knots: knots.clone(),
                factor: 1.0,
            }));
        }
    }
    let count = system.inputs.len();
    for (index, input) in system.inputs.iter().enumerate() {
        let Some(wave) = input.profile.waves().first() else { continue };
        let quantity = match input.target {
            InputTarget::Force(_) | InputTarget::NormalLoad { .. } => Quantity::Force,
            InputTarget::Friction { .. } => Quantity::Ratio,
        };
        found.extend(wave.envelope.as_ref().map(|envelope| RampCourse {
            path: indexed("dither", index, count, "amplitude"),
            words: match count {
                1 => "dither amplitude".to_owned(),
                _ => format!("amplitude of dither[{index}]"),
            },
            quantity,
            knots: envelope.clone(),
            factor: wave.amplitude,
        }));
    }
    found
}

fn oscillates(study: &SystemStudy) -> bool {
    let waves = |profile: &Profile| !profile.waves().is_empty();
    let contact = |contact: &Contact| {
        waves(&contact.surface_velocity) || contact.varying_load.as_ref().is_some_and(waves)
    };
    let input = |input: &Input| input.profile.knots().is_some();
    study.system().contacts.iter().any(contact) || study.system().inputs.iter().any(input)
}

/// The steady system of a time.
fn steady_at(study: &SystemStudy, time: f64) -> Result<SystemStudy, Failure> {
    Ok(study.declared().at_time(time)?.system())
}

/// Thresholds of the steady system over the values of the ramp: under dither of its base response, otherwise of steady sliding.
fn thresholds(
    study: &SystemStudy,
    ramped: &RampCourse,
) -> Result<Vec<RampThreshold>, NoRampThresholds> {
    let window = ramped.searched()?;
    let steady = steady_at(study, ramped.time_of_largest())?;
    let parameter = ramped.path.clone();
    let request = ThresholdsRequest { parameter, window, ..Default::default() };
    if !by_eigenvalues(&steady, &request)? {
        let found = thresholds::run(&steady, &request)?;
        let local = found.local?;
        if local.ending != BranchEnding::Covered && local.thresholds.is_empty() {
            return Err(NoRampThresholds::NotCovered);
        }
        let each = local.thresholds.iter().map(|threshold| RampThreshold {
            value: threshold.value,
            kind: threshold.kind.name(),
            becomes: side(threshold.becomes),
        });
        return Ok(each.collect());
    }
    let found = tracked::run(&steady, &request.tracked())?;
    let changes =
        found.tracked.thresholds.iter().filter(|found| found.verdicts[0] != found.verdicts[1]);
    let each = changes.map(|found| RampThreshold {
        value: found.value,
        kind: found.change.name(),
        becomes: found.verdicts[1].name(),
    });
    Ok(each.collect())
}
