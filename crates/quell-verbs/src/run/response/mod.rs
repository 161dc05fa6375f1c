//! `response`: the steady response of the observed row, the effect of the dither, and the cost of every dither.

mod answer;
mod band;

use std::f64::consts::TAU;
use std::fmt;

use quell_dynamics::attractor::MotionKind;
use quell_dynamics::motion::FedCost;
use quell_dynamics::response::{
    Effect, ResponsePlan, ResponseRefused, SettledRecord, SteadyResponse, SystemEnding, Uncertain,
    Undefined, respond, vibration_frequency,
};
use quell_model::System;
use quell_model::parameter::indexed;
use quell_model::parameter::system::SYSTEM_DITHER_FREQUENCY;
use quell_model::profile::Wave;
use quell_model::system::Input;
use quell_model::units::Quantity;
use quell_numerics::interval::RealInterval;

use super::actuator::beyond_actuator;
use super::effect_words::{EffectWords, percent, residual_in_words};
use super::system::of_runs::{beyond_laws, failed_run, of_engine};
use super::system::periods::slowest_period;
use super::system::start::{duration, start_in_words, start_of};
use super::system::{failed, frequency_in_words, has_equations, in_units};
use crate::complaint::{Complaint, Complaints, Failure, Fault, Origin};
use crate::reasons::reasons;
use crate::study::{Solver, SystemStudy};
use crate::words::{capital, digits, more_digits, unit_after};

pub use band::InBand;

/// Periods of the slowest oscillation that are discarded before the record.
pub const SETTLE_PERIODS: f64 = 200.0;

/// Periods of the slowest oscillation in the record.
pub const RECORD_PERIODS: f64 = 60.0;

/// What is asked of `response`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ResponseRequest {
    /// Time discarded before the record; `None` for that of the study, or [`SETTLE_PERIODS`].
    pub settle: Option<f64>,
    /// Length of the record; `None` for that of the study, or [`RECORD_PERIODS`].
    pub record: Option<f64>,
    /// Number of runs under noise, each with another seed.
    pub seeds: Option<usize>,
    /// Two times of a run between which it is measured, instead of a steady response.
    pub window: Option<RealInterval>,
}

/// The options of `response` as they are given.
#[derive(Clone, Copy, Debug, Default)]
pub struct ResponseTexts<'t> {
    /// Time before the record.
    pub settle: Option<&'t str>,
    /// Length of the record.
    pub record: Option<&'t str>,
    /// The two times of a window.
    pub window: Option<(&'t str, &'t str)>,
}

impl ResponseTexts<'_> {
    /// The request, in the units of the system whose response it is.
    ///
    /// # Errors
    /// A complaint about every option that is wrong.
    pub fn read(&self, study: &SystemStudy) -> Result<ResponseRequest, Complaints> {
        let mut wrong: Vec<Complaint> = Vec::new();
        let mut time = |option, text: Option<&str>| {
            let read = duration(study, text?, option);
            read.map_err(|complaint| wrong.push(*complaint)).ok()
        };
        let settle = time("--settle", self.settle);
        let record = time("--record", self.record);
        let ends = self
            .window
            .map(|(from, to)| [time("--window", Some(from)), time("--window", Some(to))]);
        let window = ends.and_then(|[from, to]| Some(RealInterval::new(from?, to?)));
        if wrong.is_empty() {
            Ok(ResponseRequest { settle, record, window, seeds: None })
        } else {
            Err(wrong.into())
        }
    }
}

/// A steady response.
#[derive(Clone, Debug)]
pub struct MeasuredResponse {
    /// How it was measured.
    pub plan: ResponsePlan,
    /// The response.
    pub response: SteadyResponse,
}

/// How the response of a study is measured.
///
/// # Errors
/// A complaint where nothing oscillates and a time is not given.
pub fn plan_of(study: &SystemStudy, request: ResponseRequest) -> Result<ResponsePlan, Failure> {
    let own = study.record();
    let usual = usual_record(study.system());
    let time = |given: Option<f64>, usual: Option<f64>, periods: f64| match given.or(usual) {
        Some(time) => Ok(time),
        None => Ok::<f64, Failure>(periods * slowest_period(study, "--settle")?),
    };
    let (settle, length) = usual.unzip();
    Ok(ResponsePlan {
        row: study.observe(),
        settle: time(request.settle.or(own.settle), settle, SETTLE_PERIODS)?,
        length: time(request.record.or(own.length), length, RECORD_PERIODS)?,
        tolerance: study.tolerance(),
    })
}

/// The time that is discarded and the length of the record of one coordinate on a spring, those of a belt however it is written; `None` of
/// other structures, whose slowest motion decides.
fn usual_record(system: &System) -> Option<(f64, f64)> {
    let frequency = system.structure.natural_frequency()?;
    let Solver { settle, record_periods, .. } = Solver::default();
    Some((settle / frequency, TAU * f64::from(record_periods) / frequency))
}

/// Why a response could not be measured.
pub(crate) fn refused(study: &SystemStudy, plan: &ResponsePlan, why: ResponseRefused) -> Failure {
    let counts = study.document().pointer("/solver/record_periods").is_some();
    let record = |bound: &str, limit: f64, why: &str| match study.record().length {
        // The study counts slow periods.
        Some(length) if counts && length == plan.length => {
            let slow = study.system().one_averaged_mass().map_or(1.0, |mass| TAU / mass.rate());
            let allowed = format!("{bound} {}, {why}", digits(limit / slow));
            let periods = digits(length / slow);
            Complaint::new(Fault::Value, "solver.record_periods", Origin::Whole, periods, allowed)
                .into()
        }
        _ => {
            let [limit, length] =
                [limit, plan.length].map(|time| in_units(study.units(), Quantity::Time, time));
            let allowed = format!(
                "a record of {bound} {limit}, {why}; where none is given it follows from the slowest oscillation, which may be the dither"
            );
            Complaint::option("--record", length, allowed).into()
        }
    };
    if let ResponseRefused::TooLong { most } = why
        && let Some(complaint) = slow_dither(study, plan.length, most)
    {
        return complaint.into();
    }
    match why {
        ResponseRefused::Immobile(why) => failed("response", why),
        ResponseRefused::Stopped(stopped) => failed_run("response", study.system(), &stopped),
        ResponseRefused::TooLong { most } => record(
            "at most",
            most,
            &format!(
                "with all the samples that are kept (by default it is {RECORD_PERIODS} periods of the slowest motion)"
            ),
        ),
        ResponseRefused::TooShort { least } => {
            record("more than", least, "of which a line lies in the band of slow vibration")
        }
    }
}

/// The complaint about a dither so slow that a record of its periods, which nobody asked for, has too many samples.
fn slow_dither(study: &SystemStudy, length: f64, most: f64) -> Option<Complaint> {
    let system = study.system();
    let lowest = |input: &Input| {
        let waves = input.profile.waves().iter().filter(|wave| wave.amplitude != 0.0);
        waves.map(Wave::repetition).fold(f64::INFINITY, f64::min)
    };
    let inputs = system.inputs.iter().map(lowest).enumerate();
    let (slowest, frequency) = inputs.min_by(|a, b| a.1.total_cmp(&b.1))?;
    if length != RECORD_PERIODS * (TAU / frequency) || study.record().length.is_some() {
        return None;
    }
    let count = system.inputs.len();
    let (key, given) = SYSTEM_DITHER_FREQUENCY.keys().find_map(|name| {
        let key = indexed("dither", slowest, count, name);
        let document = study.document();
        let table = document.pointer("/dither")?;
        let table = table.get(slowest).unwrap_or(table);
        Some((key, table.get(name)?.as_f64()?))
    })?;
    let least = more_digits(given * (length / most));
    let allowed = format!(
        "at least {least}, for which a record of {RECORD_PERIODS} periods of this dither has all of its samples; or give a shorter \
         record (--record)"
    );
    Some(Complaint::new(Fault::Value, key, Origin::Whole, given, allowed))
}

/// Measures the steady response of a study.
///
/// # Errors
/// A complaint about the start or the times; [`Failure::Failed`] where the motion cannot be computed or the engine stops.
pub fn run(study: &SystemStudy, request: ResponseRequest) -> Result<MeasuredResponse, Failure> {
    has_equations(study, "response")?;
    let (start, plan) = (start_of(study)?, plan_of(study, request)?);
    let response = respond(study.system(), &start, &plan);
    let response = response.map_err(|why| refused(study, &plan, why))?;
    Ok(MeasuredResponse { plan, response })
}

/// Periods of the vibration below which a record is short: the main lobe of its window, four lines wide, then reaches the mean.
const FEW_PERIODS: f64 = 4.0;

/// Relative change of the mean friction that is rounding.
const UNCHANGED: f64 = 1e-9;

reasons! {
    /// Why a response has no friction of steady sliding to compare with.
    pub enum NoFrictionLoss {
        ;
        /// There is no friction in steady sliding.
        NoFriction => "there is no friction in steady sliding to compare with",
        /// There is no steady sliding.
        NoSliding => "the system has no steady sliding to compare with",
    }
}

/// Why E is undefined.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NoResidualVibration(pub Undefined);

impl fmt::Display for NoResidualVibration {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0 {
            Undefined::UnditheredUnknown => f.write_str(
                "the vibration without dither still changes within the record, so there is no steady vibration to compare with: \
                 settle for longer",
            ),
            why @ (Undefined::UnditheredUnstable
            | Undefined::UnditheredDrifts
            | Undefined::UnditheredStill) => why.fmt(f),
            Undefined::UnditheredSettles | Undefined::UnditheredAtRest => f.write_str(
                "without dither the motion settles without vibration from this start, so there is no vibration to compare with",
            ),
        }
    }
}

impl std::error::Error for NoResidualVibration {}

reasons! {
    /// Why E has no level.
    pub enum NoLevel {
        /// It is undefined.
        Undefined(NoResidualVibration),
        ;
        /// It is zero.
        Zero => "E is zero, which has no level in decibels",
    }
}

/// Why an effect is unknown.
fn uncertain(why: Uncertain) -> String {
    match why {
        Uncertain::Undithered(why) => NoResidualVibration(why).to_string(),
        why => why.to_string(),
    }
}

impl MeasuredResponse {
    /// The effect of the dither and its cost.
    pub fn sentence(&self, study: &SystemStudy) -> String {
        let response = &self.response;
        let (units, from) = (study.units(), capital(&start_in_words(study, &Vec::new())));
        let amplitude = in_units(units, Quantity::Displacement, response.dithered.lines.whole);
        if !response.has_dither() {
            return match response.residual_vibration {
                Ok(_) => format!(
                    "{from}, without dither, the system keeps vibrating with an amplitude of {amplitude}."
                ),
                Err(Undefined::UnditheredSettles) => {
                    format!("{from}, the motion settles without vibration.")
                }
                Err(why) => format!("{from}, {}.", NoResidualVibration(why)),
            };
        }
        let band = frequency_in_words(units, response.band_end);
        let what = match response.effect {
            Effect::Unknown(why) => {
                format!("the effect of this dither is unknown: {}", uncertain(why))
            }
            effect => EffectWords {
                body: "the system",
                band: &band,
                amplitude: &amplitude,
                residual: &residual_in_words(response.residual_vibration.ok(), &band),
            }
            .sentence(effect),
        };
        let is_known = !matches!(response.effect, Effect::Unknown(_));
        let losses = self.friction_losses(study);
        // Those of several contacts are notes.
        let one = losses.first().filter(|_| is_known && study.system().contacts.len() == 1);
        let friction = one.map_or(String::new(), |loss| format!(" {loss}"));
        format!("{from}, {what}.{friction}")
    }

    /// The levels in the requested band, what the dithers cost, and the mean friction against the run without dither.
    pub fn notes(&self, study: &SystemStudy) -> Vec<String> {
        let contacts = study.system().contacts.iter().zip(0..);
        let against = contacts.filter_map(|(contact, index)| {
            let friction = |record: &SettledRecord| record.contacts[index].friction;
            let before = friction(&self.response.undithered);
            let change = friction(&self.response.dithered) / before - 1.0;
            let says =
                self.response.has_dither() && change.is_finite() && change.abs() >= UNCHANGED;
            says.then(|| {
                format!(
                    "Against the run without dither the mean friction of contact {} is {} {}.",
                    contact.name,
                    percent(change.abs()),
                    if change > 0.0 { "higher" } else { "lower" }
                )
            })
        });
        let is_known = !matches!(self.response.effect, Effect::Unknown(_));
        let mut notes: Vec<String> = self.band_in_words(study).into_iter().collect();
        if is_known {
            let losses = self.friction_losses(study);
            notes.extend(losses.into_iter().filter(|_| study.system().contacts.len() > 1));
            notes.extend(self.costs(study));
        }
        notes.extend(against);
        notes
    }

    /// The mean friction of every contact against steady sliding, one sentence each.
    fn friction_losses(&self, study: &SystemStudy) -> Vec<String> {
        let one_contact = study.system().contacts.len() == 1;
        let of =
            |name: &str| if one_contact { String::new() } else { format!(" of contact {name}") };
        let losses = study.system().contacts.iter().zip(0..).filter_map(|(contact, index)| {
            let loss = self.friction_loss(index).ok()?;
            let of = of(&contact.name);
            if loss.abs() < UNCHANGED {
                return Some(format!("The mean friction{of} is that of steady sliding."));
            }
            let side = if loss < 0.0 { "above" } else { "below" };
            let share = percent(loss.abs());
            Some(format!("The mean friction{of} is {share} {side} that of steady sliding."))
        });
        losses.collect()
    }

    /// The cost of every dither, one sentence each.
    fn costs(&self, study: &SystemStudy) -> Vec<String> {
        let units = study.units();
        let several = self.response.dithered.inputs.len() > 1;
        let inputs = self.response.dithered.inputs.iter().enumerate();
        let costs = inputs.filter_map(|(index, cost)| {
            let of = if several { format!(" at dither[{index}]") } else { String::new() };
            let series = cost.in_series.and_then(Result::ok).map(|cost| {
                let power = self.power_in_words(study, cost.power);
                let stroke = in_units(units, Quantity::Displacement, cost.stroke);
                format!("{power} with a stroke of {stroke}")
            });
            let Ok(FedCost { power, stroke }) = cost.fed else {
                let series = series?;
                return Some(format!(
                    "An actuator in series with the spring of the contact delivers{of} the mean power {series}."
                ));
            };
            let does = if power < 0.0 { "returns" } else { "takes" };
            let power = self.power_in_words(study, power.abs());
            let stroke = in_units(units, Quantity::Displacement, stroke);
            let series = series.map_or(String::new(), |cost| {
                format!(", or in series with the spring of the contact {cost}")
            });
            Some(format!("The dither {does} the mean power {power} with a stroke of {stroke}{of}{series}."))
        });
        costs.collect()
    }

    /// A mean power; of a motion that does not repeat itself with two digits, of which another record leaves one: 69 mW of a pad of two masses
    /// was 80 to 87 mW over records up to fifteen times as long. The warning about that record says how to determine it better.
    fn power_in_words(&self, study: &SystemStudy, power: f64) -> String {
        if self.means_of_record(study).is_none() {
            return in_units(study.units(), Quantity::Power, power);
        }
        quell_model::digits::digits(power, 2) + &unit_after(study.units().unit(Quantity::Power))
    }

    /// Relative loss of the mean friction of a contact against steady sliding without dither; negative for a gain.
    fn friction_loss(&self, contact: usize) -> Result<f64, NoFrictionLoss> {
        let steady = self.steady_friction(contact)?;
        if steady == 0.0 {
            return Err(NoFrictionLoss::NoFriction);
        }
        Ok(1.0 - self.response.dithered.contacts[contact].friction / steady)
    }

    fn steady_friction(&self, contact: usize) -> Result<f64, NoFrictionLoss> {
        let steady = self.response.steady_friction.as_ref().map(|forces| forces[contact]);
        steady.ok_or(NoFrictionLoss::NoSliding)
    }

    /// Warnings about the result.
    pub fn warnings(&self, study: &SystemStudy) -> Vec<String> {
        let response = &self.response;
        let mut warnings = study.warnings().to_vec();
        warnings.extend(beyond_laws(study, |contact| response.largest_slip(contact)));
        warnings.extend(of_engine(study.system(), &response.dithered.end));
        warnings.extend(beyond_actuator(study));
        let settle = in_units(study.units(), Quantity::Time, self.plan.settle);
        let runs = [
            ("dithered ", response.dithered_is_settled(), &response.dithered),
            ("undithered ", response.undithered_is_settled(), &response.undithered),
        ];
        // Without dither both are one run.
        let runs = if response.has_dither() { &runs[..] } else { &runs[1..] };
        for (which, settled, record) in runs {
            let which = if response.has_dither() { which } else { "" };
            match record.ending {
                SystemEnding::Drift => warnings.push(format!(
                    "the {which}response drifts: over the record the observed motion moves on by more than it vibrates, so that \
                     amplitudes and strokes grow with the record"
                )),
                SystemEnding::UnstableSliding => warnings.push(format!(
                    "the {which}run stays in steady sliding, which is unstable, because its start does not disturb it"
                )),
                _ if !settled => warnings.push(format!(
                    "the {which}response has not settled after t = {settle}: the amplitudes of the two halves of the record \
                     differ; raise --settle or --record"
                )),
                _ => {}
            }
        }
        warnings.extend(self.longer_than_record(study));
        warnings.extend(self.means_of_record(study));
        warnings.extend(self.few_periods(study));
        warnings
    }

    /// A warning about means over a record of a motion that does not repeat itself: where the record is cut changes them.
    fn means_of_record(&self, study: &SystemStudy) -> Option<String> {
        let found = self.response.dithered.ending.motion()?;
        let repeats = self.response.dithered.ending.period().is_some();
        let length = in_units(study.units(), Quantity::Time, self.plan.length);
        (!repeats && found.kind != MotionKind::Rest).then(|| {
            format!(
                "the motion does not repeat itself: mean friction, powers and strokes are those of a record of {length}, and change with its \
                 ends; a longer --record determines them better"
            )
        })
    }

    /// A warning about a record that is short against the vibration, whose lines its window does not separate.
    fn few_periods(&self, study: &SystemStudy) -> Option<String> {
        let slow = TAU / vibration_frequency(study.system())?;
        let is_short = self.plan.length < FEW_PERIODS * slow;
        let [length, slow] =
            [self.plan.length, slow].map(|time| in_units(study.units(), Quantity::Time, time));
        is_short.then(|| {
            format!(
                "the record of {length} is short against a period of the slow vibration, {slow}: amplitudes and E depend on its length; raise \
                 --record"
            )
        })
    }

    /// A warning about a free vibration that takes longer than its record, such as one with long sticks on a slow surface.
    fn longer_than_record(&self, study: &SystemStudy) -> Option<String> {
        let ending = &self.response.undithered.ending;
        let period = ending.period().filter(|period| *period > self.plan.length)?;
        let [period, length] =
            [period, self.plan.length].map(|time| in_units(study.units(), Quantity::Time, time));
        Some(format!(
            "the vibration without dither repeats after {period}, but its record lasts {length}: M₀ and E are those of a part of it; \
             raise --record"
        ))
    }
}
