//! `simulate` of a disc: its motion as a system, from a small motion, and what becomes of the growth.

use std::f64::consts::TAU;
use std::fmt::Display;

use quell_model::units::Quantity;
use quell_model::{Contact, System};
use serde_json::{Map, Value as Json};

use super::kick::{self, KICK, Kick};
use super::overflowed;
pub use super::watch::NoObservedGrowth;
use super::watch::RowWatch;
use crate::complaint::Failure;
use crate::disc_units::{DiscUnits, FORCE, POWER};
use crate::run::actuator::beyond_actuators_at_loads;
use crate::run::simulate::{MotionRequest, Simulation, run_observed};
use crate::run::system::in_units_of;
use crate::run::system::periods::slowest_period;
use crate::study::{DiscStudy, SystemStart, SystemStudy};
use crate::words::digits;

/// Least number of periods of the leading small motion that a run lasts if no duration is given.
pub const LEAST_PERIODS: f64 = 100.0;

/// Largest number of them, unless the motion does not oscillate.
pub const MOST_PERIODS: f64 = 2000.0;

/// Part of the run over which the amplitude is measured.
const TAIL: f64 = 0.1;

/// Deflection, over that of the small motion at the start, beyond which no physical motion is.
pub const RUNAWAY: f64 = 1e6;

/// What a motion beyond [`RUNAWAY`] shows.
const GROWS: &str = "the motion grows without bound: in this model friction follows the load, and the loads of the springs follow \
                     the deflection";

/// One motion of a disc.
#[derive(Clone, Debug)]
pub struct DiscSimulation {
    /// The disc as a system, with its start.
    pub system: SystemStudy,
    /// The motion of that system.
    pub motion: Simulation,
    /// The leading small motion without dither.
    pub kick: Kick,
    /// Half the peak-to-peak deflection under the first load over the last tenth of the run; `None` for a run without duration.
    pub amplitude: Option<f64>,
    /// Growth rate of the extremes of that deflection while the motion was small; or why it is unknown.
    pub growth: Result<f64, NoObservedGrowth>,
    /// Whether the duration was chosen here.
    pub chosen: bool,
    /// Whether the deflection grew to [`RUNAWAY`] times that of the leading small motion at the start.
    pub ran_away: bool,
}

/// The disc as a system that begins on its leading small motion, as `simulate` does.
///
/// # Errors
/// [`Failure::Failed`] without steady sliding.
pub fn disturbed(study: &DiscStudy) -> Result<SystemStudy, Failure> {
    let system = study.disc().system_of(study.parts());
    let initial = of_leading_motion(&leading_motion(study, &system, 0.0)?);
    Ok(study.starting_from(initial))
}

/// The leading small motion; of a speed, load or dither that varies, that of the moment at which a run begins.
fn leading_motion(study: &DiscStudy, system: &System, begin: f64) -> Result<Kick, Failure> {
    let moment =
        (!study.disc().is_steady()).then(|| study.disc().steady_at(begin).system_of(study.parts()));
    kick::of(moment.as_ref().unwrap_or(system), &study.observed_row())
}

fn of_leading_motion(kick: &Kick) -> SystemStart {
    let words = "the leading small motion".to_owned();
    SystemStart::Described { state: kick.state.clone(), words }
}

/// Integrates the disc from its leading small motion, or from rest with the given numbers.
///
/// # Errors
/// As [`crate::run::simulate::run`]; [`Failure::Failed`] without steady sliding.
pub fn run(study: &DiscStudy, request: &MotionRequest) -> Result<DiscSimulation, Failure> {
    let system = study.disc().system_of(study.parts());
    let begin = request.from.as_ref().map_or(0.0, |from| from.time);
    let is_steady = study.disc().is_steady();
    let kick = leading_motion(study, &system, begin)?;
    let initial =
        if request.begins_as_the_study() { of_leading_motion(&kick) } else { SystemStart::Rest };
    let system = study.starting_from(initial);
    let until = match request.until {
        Some(until) => until,
        None => begin + usual_duration(&system, &kick)?,
    };
    let asked = MotionRequest { until: Some(until), undithered: false, ..request.clone() };
    let from = until - TAIL * (until - begin);
    let mut watch = RowWatch::new(study.observed_row(), kick.middle, kick.levels.clone(), from);
    let done = run_observed(&system, &asked, &mut watch);
    let ran_away = watch.largest() > RUNAWAY * kick.amplitude.max(f64::MIN_POSITIVE);
    let motion = done.map_err(|failure| match failure {
        failure if ran_away => unbounded(&failure),
        Failure::Wrong(wrong) if request.until.is_none() => {
            let why = format!("the usual duration is refused: {wrong}; --until sets another");
            overflowed("simulate", why)
        }
        failure => failure,
    })?;
    Ok(DiscSimulation {
        system,
        motion,
        kick,
        amplitude: (until > begin).then(|| watch.amplitude()),
        growth: if is_steady { watch.growth() } else { Err(NoObservedGrowth::Varies) },
        chosen: request.until.is_none(),
        ran_away,
    })
}

/// The failure of a run whose deflection has grown beyond any physical size.
fn unbounded(failure: &Failure) -> Failure {
    overflowed("simulate", format!("{GROWS}; {failure}"))
}

/// Twice the time in which the leading motion grows from [`KICK`] to 1, between [`LEAST_PERIODS`] and [`MOST_PERIODS`].
fn usual_duration(system: &SystemStudy, kick: &Kick) -> Result<f64, Failure> {
    let (growth, frequency) = (kick.eigenvalue.re, kick.eigenvalue.im.abs());
    let period = if frequency > 0.0 { TAU / frequency } else { slowest_period(system, "--until")? };
    let growing = -2.0 * libm::log(KICK) / growth;
    let wanted = if growth > 0.0 { growing } else { 0.0 };
    Ok(wanted.clamp(LEAST_PERIODS * period, MOST_PERIODS * period))
}

/// A deflection under the first load with its unit.
fn deflection_in_words(study: &DiscStudy, value: f64) -> String {
    let own = DiscSimulation::length_unit(study);
    let one = DiscUnits::of(study).and_then(|units| units.one("", own));
    let (one, unit) = one.unwrap_or((1.0, own));
    format!("{} {unit}", digits(one * value))
}

impl DiscSimulation {
    /// The unit of a deflection: the radius of the first load under a friction law, else a length that the load defines.
    pub fn length_unit(study: &DiscStudy) -> &'static str {
        if study.disc().law().is_some() { "r₀" } else { "(normal load)/(M_pω_ref²)" }
    }

    /// The outcome in one or two sentences.
    pub fn sentence(&self, study: &DiscStudy) -> String {
        let text = self.motion.sentence(&self.system);
        let last = self.amplitude.map_or(String::new(), |amplitude| {
            format!(
                " Over the last tenth of the run the amplitude of the deflection under load 0 is {}.",
                deflection_in_words(study, amplitude)
            )
        });
        text + &last
    }

    /// The motion at the start, and how long the run lasts where that was not requested.
    pub fn notes(&self, study: &DiscStudy) -> Vec<String> {
        let mut notes = Vec::new();
        if self.motion.request.begins_as_the_study() {
            let words = match (self.kick.changes_contacts, self.kick.amplitude) {
                (true, deflection) => format!(
                    "loads and slip velocities change by at most {KICK} of their values, and the deflection under load 0 by {}",
                    deflection_in_words(study, deflection)
                ),
                (false, deflection) => {
                    format!(
                        "its deflection under load 0 is {}",
                        deflection_in_words(study, deflection)
                    )
                }
            };
            notes.push(format!("In the small motion at the start {words}."));
        }
        if self.chosen {
            let until = in_units_of(&self.system, Quantity::Time, self.motion.end.time);
            notes.push(format!("The duration {until} was chosen; --until sets another."));
        }
        notes
    }

    /// Warnings about the result.
    pub fn warnings(&self) -> Vec<String> {
        let mut warnings = self.motion.warnings(&self.system);
        let contacts = &self.system.system().contacts;
        let is_prescribed = |contact: &Contact| {
            let is_rigid = contact.normal_stiffness == 0.0 && contact.normal_damping == 0.0;
            is_rigid && contact.tangent.is_none()
        };
        if self.ran_away && !contacts.iter().all(is_prescribed) {
            warnings.push(GROWS.to_owned());
        }
        if !contacts.is_empty() && contacts.iter().all(is_prescribed) {
            let bounded = "the load is prescribed: nothing bounds the growth of an unstable motion";
            warnings
                .push(format!("{bounded}; a spring or damper of the load lets its contact open"));
        }
        warnings
    }

    /// As JSON.
    pub fn json(&self, study: &DiscStudy) -> Json {
        let mut object = self.motion.json(&self.system);
        object["sentence"] = self.sentence(study).into();
        let mut warnings = self.warnings();
        warnings.extend(beyond_actuators_at_loads(study));
        object["warnings"] = warnings.into();
        object["leading_growth_rate"] = self.kick.eigenvalue.re.into();
        object["leading_frequency"] = self.kick.eigenvalue.im.abs().into();
        object["start"]["amplitude"] = self.kick.amplitude.into();
        let mut why = Map::new();
        put(
            &mut object,
            &mut why,
            "amplitude",
            &self.amplitude.ok_or("the run has no duration".to_owned()),
        );
        put(&mut object, &mut why, "growth_observed", &self.growth);
        if !self.motion.request.begins_as_the_study() {
            object["start"]["amplitude"] = Json::Null;
            why.insert("start.amplitude".to_owned(), "the start is given".into());
        }
        put_units(&mut object, study);
        // Indexing would insert a null where there is no such key.
        if let Some(known) = object.get_mut("why").and_then(Json::as_object_mut) {
            known.append(&mut why);
        } else if !why.is_empty() {
            object["why"] = Json::Object(why);
        }
        object
    }
}

/// Adds a number, or null with the reason.
fn put(
    object: &mut Json,
    why: &mut Map<String, Json>,
    name: &str,
    value: &Result<f64, impl Display>,
) {
    match value {
        Ok(value) => object[name] = (*value).into(),
        Err(reason) => {
            object[name] = Json::Null;
            why.insert(name.to_owned(), reason.to_string().into());
        }
    }
}

/// Names the units of a disc.
fn put_units(object: &mut Json, study: &DiscStudy) {
    let under_law = study.disc().law().is_some();
    // Without a law every contact slips at the constant velocity 1, and its load is that of the study.
    let (normal, velocity) = if under_law { (FORCE, "r₀ω_ref") } else { ("N", "1") };
    let units = [
        ("time", "1/ω_ref"),
        ("amplitude", DiscSimulation::length_unit(study)),
        ("slip_velocity", velocity),
        ("friction", FORCE),
        ("mean_friction", FORCE),
        ("friction_power", if under_law { POWER } else { FORCE }),
        ("normal", normal),
        ("mean_normal", normal),
        ("least_normal", normal),
        ("growth_observed", "ω_ref"),
        ("leading_growth_rate", "ω_ref"),
        ("leading_frequency", "ω_ref"),
    ];
    for (name, unit) in units {
        object["units"][name] = unit.into();
    }
}
