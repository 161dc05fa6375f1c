//! `simulate` of a system: one motion with every event of every contact.

use std::f64::consts::TAU;

pub use quell_dynamics::motion::MotionStart;
use quell_dynamics::motion::{
    ContactMeans, ContactMeter, ContactPhase, Motion, MotionEnd, MotionObserver, MotionSampler,
    MotionSegment, MotionStopped, RowMeter,
};
use quell_model::System;
use quell_model::profile::Wave;
use quell_model::system::Mechanical;
use quell_model::units::Quantity;
use serde_json::Value as Json;

use super::history::{EventHistory, KINDS};
use super::sound::{self, MotionSoundTap};
use super::start::{StateNumbers, start_in_words, start_with, state_in_words, state_names};
use super::{failed, has_equations, in_units_of, modes, velocity_in_words};
use crate::complaint::{Complaint, Failure, Fault, Origin};
use crate::fields::Fields;
use crate::range;
use crate::run::manoeuvre::{Manoeuvre, SampledMotion};
use crate::run::sample_times;
use crate::sound::{Sound, SoundOptions};
use crate::study::{SystemStudy, UnitSystem};
use crate::words::{capital, listed, plural};

/// Periods of the slowest oscillation that a run lasts if no duration is given.
pub const DEFAULT_PERIODS: f64 = 100.0;

/// Windows of a manoeuvre in which no motion of the structure oscillates. Only the run itself sets a scale of time there: moments are
/// found to within 1 % of it, half of a window.
const WINDOWS_WITHOUT_OSCILLATION: f64 = 50.0;

/// Samples per period of the fastest dither and of the fastest motion of the structure.
const SAMPLES_PER_PERIOD: f64 = 64.0;

/// Least number of intervals between samples.
const LEAST_SAMPLES: f64 = 256.0;

/// Largest number of numbers in all samples together, about 160 megabytes; a longer run is sampled more coarsely.
const MOST_NUMBERS: f64 = 20_000_000.0;

/// Contacts that a sentence describes one by one.
const MOST_DESCRIBED: usize = 4;

/// A run to be made.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MotionRequest {
    /// Time at its end; `None` for [`DEFAULT_PERIODS`].
    pub until: Option<f64>,
    /// Numbers that replace those of the study's start.
    pub start: StateNumbers,
    /// State and time at which it begins, in place of the start of the study.
    pub from: Option<MotionStart>,
    /// Times of the samples in ascending order, instead of equal steps.
    pub times: Option<Vec<f64>>,
    /// Whether the text lists every event.
    pub events: bool,
    /// Whether the motion is sampled.
    pub samples: bool,
    /// The sound of the velocity of the observed row, if wanted.
    pub sound: Option<SoundOptions>,
}

impl MotionRequest {
    /// Whether the run begins at the start of the study.
    pub(crate) fn begins_as_the_study(&self) -> bool {
        self.start.is_empty() && self.from.is_none()
    }
}

/// One motion of a system.
#[derive(Clone, Debug)]
pub struct SystemSimulation {
    /// What was asked.
    pub request: MotionRequest,
    /// Initial state.
    pub start: MotionStart,
    /// Final state.
    pub end: MotionEnd,
    /// Events and intervals of stick and separation.
    pub history: EventHistory,
    /// What every contact did on average; `None` for a run without duration.
    pub means: Option<Vec<ContactMeans>>,
    /// Samples at equal steps, both ends included, if requested.
    pub samples: Option<MotionSampler>,
    /// Bound on the last terms of a step, relative to the numbers of the state; of one mass relative to the load.
    pub tolerance: f64,
    /// Whether the samples are too coarse to resolve the fastest motion.
    pub coarse: bool,
    /// The sound of the velocity of the observed row, if requested.
    pub sound: Option<Sound>,
    /// When the observed row vibrates, where a drive, a load or a dither varies in time.
    pub manoeuvre: Option<Manoeuvre>,
    /// Warnings about slip beyond the range of a law.
    beyond: Vec<String>,
}

/// Integrates a study.
///
/// # Errors
/// A complaint about the start or the end; [`Failure::Failed`] where the motion cannot be computed or the engine stops.
pub fn run(study: &SystemStudy, request: &MotionRequest) -> Result<SystemSimulation, Failure> {
    run_observed(study, request, &mut ())
}

/// [`run`] with one more observer.
///
/// # Errors
/// As [`run`].
pub(crate) fn run_observed(
    study: &SystemStudy,
    request: &MotionRequest,
    watch: &mut impl MotionObserver,
) -> Result<SystemSimulation, Failure> {
    has_equations(study, "simulate")?;
    let system = study.system();
    let motion = Motion::new(system).map_err(|why| failed("simulate", why))?;
    let start = match &request.from {
        Some(from) => given_state(study, from)?,
        None => start_with(study, &request.start)?,
    };
    let until = match request.until {
        Some(until) => until,
        None => start.time + DEFAULT_PERIODS * slowest_period(study, "--until")?,
    };
    let plan = request.sound.map(|options| sound::plan(study, until - start.time, options));
    let plan = plan.transpose()?;
    sample_times::are_within(start.time, until, request.times.as_deref())?;
    let (intervals, coarse) = if request.samples && request.times.is_none() {
        grid(&motion, until - start.time)
    } else {
        (0, false)
    };
    let step = (until - start.time) / intervals.max(1) as f64;
    let contacts = system.contacts.len();
    let mut meter = ContactMeter::new(contacts);
    let mut history = EventHistory::new(contacts, motion.size(), request.samples);
    let mut sampler = match &request.times {
        Some(times) => MotionSampler::at(times.clone()),
        None => MotionSampler::new(start.time, step, intervals),
    };
    let mut tap = MotionSoundTap::new(&start, &study.observe(), plan.as_ref());
    let mut trace = trace(study, &motion, (start.time, until));
    let watch = (&mut tap, (&mut trace, watch));
    let mut observer = (&mut meter, (&mut history, (&mut sampler, watch)));
    let start_time = start.time;
    let end = motion
        .run(&start, until, motion.run_tolerance(), &mut observer)
        .map_err(|stopped| failed_run("simulate", system, &stopped))?;
    if request.times.is_some() {
        sampler.finish(&end);
    } else {
        sampler.push_end(&end);
    }
    let beyond = beyond_laws(study, |contact| meter.largest_slip(contact));
    Ok(SystemSimulation {
        request: request.clone(),
        start,
        sound: tap.finish(&end),
        end,
        history,
        means: meter.means(),
        samples: request.samples.then_some(sampler),
        tolerance: motion.bound_of_runs(),
        coarse,
        manoeuvre: manoeuvre(study, trace, start_time),
        beyond,
    })
}

/// The observed row in which the vibration of a run is found; none of a steady study.
fn trace(study: &SystemStudy, motion: &Motion<'_>, (from, until): (f64, f64)) -> TracedRow {
    if study.system().is_steady() || until <= from {
        return TracedRow { meter: None, step: 0.0 };
    }
    let (count, _) = grid(motion, until - from);
    let step = (until - from) / count as f64;
    TracedRow { meter: Some(RowMeter::new(&study.observe(), from, step, count)), step }
}

/// Samples of the observed row.
struct TracedRow {
    meter: Option<RowMeter>,
    step: f64,
}

impl MotionObserver for TracedRow {
    fn segment(&mut self, segment: &MotionSegment<'_>) {
        if let Some(meter) = &mut self.meter {
            meter.segment(segment);
        }
    }

    fn watches(&self) -> bool {
        self.meter.is_some()
    }
}

fn manoeuvre(study: &SystemStudy, traced: TracedRow, start: f64) -> Option<Manoeuvre> {
    let TracedRow { meter, step } = traced;
    let meter = meter?;
    let motion = SampledMotion { start, step, displacement: &meter.samples };
    let waves = || study.system().waves().filter(|wave| wave.amplitude != 0.0);
    let slowest = waves().map(Wave::repetition).reduce(f64::min);
    Some(Manoeuvre::in_system(
        motion,
        natural_period(study, (start, start + meter.samples.len() as f64 * step)),
        slowest.map(|rate| TAU / rate),
        study.system(),
    ))
}

/// Period of the slowest oscillation of the structure that the run contains, at the beginning of the run where its speed varies; of a
/// structure without one a fiftieth of the run.
pub(crate) fn natural_period(study: &SystemStudy, (from, until): (f64, f64)) -> f64 {
    let length = until - from;
    let periods = natural_frequencies(study, from).ok().map(|found| {
        let periods = found.into_iter().map(|natural| TAU / natural);
        periods.filter(|period| *period < length).reduce(f64::max)
    });
    periods.flatten().unwrap_or(length / WINDOWS_WITHOUT_OSCILLATION)
}

/// Natural frequencies of the oscillating modes at a moment, contacts closed and without friction.
fn natural_frequencies(study: &SystemStudy, time: f64) -> Result<Vec<f64>, Failure> {
    let found = modes_at(study, time)?;
    let oscillating = found.modes.iter().filter(|mode| mode.eigenvalue.im > mode.error);
    Ok(oscillating.map(modes::natural).collect())
}

/// The modes of a study; where its speed varies, those of a moment.
fn modes_at(study: &SystemStudy, time: f64) -> Result<modes::SystemModes, Failure> {
    let structure = &study.system().structure;
    match structure.mechanical().and_then(Mechanical::by_speed) {
        Some(_) => modes::of(&study.system().steady_at(time)),
        None => modes::run(study),
    }
}

/// A given state, which must have one finite number for each of the system.
fn given_state(study: &SystemStudy, from: &MotionStart) -> Result<MotionStart, Failure> {
    let size = study.system().state_size();
    let structure = study.system().structure.state_size();
    let is_finite = from.time.is_finite() && from.state.iter().all(|number| number.is_finite());
    if from.state.len() == size && is_finite {
        return Ok(from.clone());
    }
    if from.state.len() == structure && is_finite {
        // The contacts' own numbers begin at zero.
        let mut state = from.state.clone();
        state.resize(size, 0.0);
        return Ok(MotionStart { time: from.time, state });
    }
    let allowed = format!("a state of {size} finite numbers at a finite time");
    Err(Complaint::option("--start", format!("{:?}", from.state), allowed).into())
}

/// The failure of a run that ended early: time, reason, and state.
pub(super) fn failed_run(verb: &str, system: &System, stopped: &MotionStopped) -> Failure {
    failed(
        verb,
        format!("{stopped}; the state there is {}", state_in_words(system, &stopped.state)),
    )
}

/// Warnings about slip beyond the ranges of the laws; `largest` is the largest slip speed of a contact.
pub(crate) fn beyond_laws(study: &SystemStudy, largest: impl Fn(usize) -> f64) -> Vec<String> {
    let in_words = |speed| velocity_in_words(study, speed);
    let contacts = study.system().contacts.iter().enumerate();
    let warning = |(index, contact)| range::at_contact(contact, largest(index), in_words);
    contacts.filter_map(warning).collect()
}

/// Period of the slowest oscillation of the structure, contacts closed and without friction, or of the dither.
///
/// # Errors
/// A complaint about `option`, the missing duration, if nothing oscillates.
pub(crate) fn slowest_period(study: &SystemStudy, option: &'static str) -> Result<f64, Failure> {
    let own = natural_frequencies(study, 0.0)?;
    let slowest = own.into_iter().chain(study.system().acting_frequencies());
    let slowest = slowest.fold(f64::INFINITY, f64::min);
    if slowest.is_finite() {
        return Ok(TAU / slowest);
    }
    let why = "no motion of this structure oscillates, so that there is no usual length: give one";
    Err(Complaint::new(Fault::Missing, option, Origin::Argument(option), Json::Null, why).into())
}

/// Number of intervals between samples, and whether it had to be limited.
fn grid(motion: &Motion<'_>, length: f64) -> (usize, bool) {
    let own = TAU * motion.time_scale();
    let fastest = motion.system().acting_frequencies().map(|rate| TAU / rate).fold(own, f64::min);
    let wanted = (SAMPLES_PER_PERIOD * length / fastest).ceil().max(LEAST_SAMPLES);
    let columns = motion.size() + 4 * motion.system().contacts.len() + 1;
    let most = (MOST_NUMBERS / columns as f64).floor();
    let coarse = wanted > most;
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a count")]
    let count = wanted.min(most) as usize;
    (count, coarse)
}

/// Word for what a contact does, as its verb.
fn does(phase: ContactPhase) -> &'static str {
    match phase {
        ContactPhase::Slip(_) => "slips",
        ContactPhase::Stick => "sticks",
        ContactPhase::Open => "is open",
    }
}

impl SystemSimulation {
    /// Total number of events of each kind.
    fn totals(&self) -> [u64; KINDS.len()] {
        let mut totals = [0; KINDS.len()];
        for counts in &self.history.counts {
            totals.iter_mut().zip(counts).for_each(|(total, count)| *total += count);
        }
        totals
    }

    /// What the contacts do at the end.
    fn contacts_in_words(&self, system: &System) -> String {
        let ends = &self.end.contacts;
        if ends.len() <= MOST_DESCRIBED {
            let each = system.contacts.iter().zip(ends);
            let each = each.map(|(contact, end)| format!("{} {}", contact.name, does(end.phase)));
            return format!("contact {}", each.collect::<Vec<_>>().join(", contact "));
        }
        let count =
            |holds: fn(ContactPhase) -> bool| ends.iter().filter(|end| holds(end.phase)).count();
        format!(
            "{} contacts slip, {} stick and {} are open",
            count(|phase| matches!(phase, ContactPhase::Slip(_))),
            count(|phase| phase == ContactPhase::Stick),
            count(|phase| phase == ContactPhase::Open)
        )
    }

    /// The start as text, such as "from rest".
    pub fn start_in_words(&self, study: &SystemStudy) -> String {
        match &self.request.from {
            Some(from) => {
                let time = in_units_of(study, Quantity::Time, from.time);
                format!("from the given state at t = {time}")
            }
            None => start_in_words(study, &self.request.start),
        }
    }

    /// The outcome in one or two sentences.
    pub fn sentence(&self, study: &SystemStudy) -> String {
        let time = in_units_of(study, Quantity::Time, self.end.time);
        let totals = self.totals();
        let each = KINDS.iter().zip(totals).filter(|(_, count)| *count > 0);
        let each: Vec<String> =
            each.map(|(kind, count)| format!("{count} {}{}", kind.name(), plural(count))).collect();
        let events = match totals.iter().sum::<u64>() {
            0 => "without any contact event".to_owned(),
            _ => format!("after {}", listed(&each)),
        };
        let chosen = match self.request.until {
            Some(_) => String::new(),
            None => format!(
                " The run lasts {DEFAULT_PERIODS} periods of the slowest oscillation; --until sets another time."
            ),
        };
        let start = capital(&self.start_in_words(study));
        let contacts = match self.end.contacts.len() {
            0 => format!("{start}: the run ends at t = {time}"),
            _ => format!(
                "{start}: at t = {time} {}, {events}",
                self.contacts_in_words(study.system())
            ),
        };
        let found = [self.manoeuvre_sentence(study), self.sound_sentence(study)];
        let whole = format!("{contacts}.{chosen}");
        [Some(whole)].into_iter().chain(found).flatten().collect::<Vec<_>>().join(" ")
    }

    /// When the observed row vibrates, in one or two sentences, where a drive, a load or a dither varies in time.
    pub fn manoeuvre_sentence(&self, study: &SystemStudy) -> Option<String> {
        let found = self.manoeuvre.as_ref()?;
        let words = |quantity, value| in_units_of(study, quantity, value);
        Some(found.sentence("The observed row", words))
    }

    /// The sound in one sentence, if it was requested.
    pub fn sound_sentence(&self, study: &SystemStudy) -> Option<String> {
        let sound = self.sound.as_ref()?;
        let in_real_time = study.time_per_second().is_some() && sound.transposition == 1.0;
        Some(sound.sentence(in_real_time, |quantity, value| in_units_of(study, quantity, value)))
    }

    /// Warnings about the result.
    pub fn warnings(&self, study: &SystemStudy) -> Vec<String> {
        let mut warnings = study.warnings().to_vec();
        warnings.extend(self.beyond.iter().cloned());
        warnings.extend(of_engine(study.system(), &self.end));
        if self.coarse {
            let count = self.samples.as_ref().map_or(0, |samples| samples.times.len());
            warnings.push(format!(
                "only {count} samples are kept, too few to resolve the fastest motion"
            ));
        }
        if let Some(sound) = &self.sound {
            let words = |quantity, value| in_units_of(study, quantity, value);
            warnings.extend(sound.warnings(words));
        }
        if self.history.lost > 0 {
            let kept = self.history.events.len();
            warnings.push(format!("only the first {kept} events are kept; all are counted"));
        }
        warnings
    }

    /// As JSON.
    pub fn json(&self, study: &SystemStudy) -> Json {
        let (system, units) = (study.system(), study.units());
        let mut fields = Fields::of_system(units);
        fields
            .plain("ok", true)
            .plain("sentence", self.sentence(study))
            .plain("state_names", state_names(system));
        let mut inner = Fields::of_system(units);
        inner
            .number("time", Quantity::Time, self.start.time)
            .plain("state", self.start.state.clone());
        fields.nested("start", inner);
        fields.nested("final", self.put_end(system, units));
        let events = self.history.events.iter().map(|event| {
            let mut inner = Fields::of_system(units);
            inner
                .number("time", Quantity::Time, event.time)
                .plain("contact", event.contact)
                .plain("kind", event.kind.name())
                .plain("slip_sign", event.slip_sign)
                .plain("state", event.state.clone());
            inner
        });
        fields.list("events", events);
        fields.list("contacts", self.put_contacts(system, units));
        if let Some(found) = &self.manoeuvre {
            fields.nested("manoeuvre", found.fields(|| Fields::of_system(units)));
        }
        if let Some(sound) = &self.sound {
            let mut inner = Fields::of_system(units);
            sound.state(&mut inner);
            fields.nested("sound", inner);
        }
        fields
            .plain("event_count", self.end.events)
            .nested("event_counts", put_counts(units, &self.totals()))
            .plain("steps", self.end.steps)
            .plain("near_tangential_releases", self.end.near_tangential_releases)
            .plain("tolerance", self.tolerance)
            .plain("warnings", self.warnings(study));
        fields.finish()
    }

    fn put_end(&self, system: &System, units: UnitSystem) -> Fields {
        let mut fields = Fields::of_system(units);
        fields.number("time", Quantity::Time, self.end.time).plain("state", self.end.state.clone());
        let contacts = system.contacts.iter().zip(&self.end.contacts).map(|(contact, end)| {
            let mut inner = Fields::of_system(units);
            inner
                .plain("name", contact.name.clone())
                .number("slip_velocity", Quantity::Velocity, end.slip_velocity)
                .plain("sticking", end.phase == ContactPhase::Stick)
                .plain("open", end.phase == ContactPhase::Open)
                .plain("slip_sign", end.phase.slip_sign())
                .number("friction", Quantity::Force, end.friction)
                .number("normal", Quantity::Force, end.normal_load);
            if let Some(bristle) = end.bristle {
                inner.number("bristle", Quantity::Displacement, bristle);
            }
            inner
        });
        fields.list("contacts", contacts.collect::<Vec<_>>());
        if let Some(bristle) = self.end.contacts.iter().find_map(|end| end.bristle) {
            fields.number("bristle", Quantity::Displacement, bristle);
        }
        fields
    }

    /// Counts and means of every contact over the run.
    fn put_contacts(&self, system: &System, units: UnitSystem) -> Vec<Fields> {
        let contacts = system.contacts.iter().enumerate().map(|(index, contact)| {
            let mut inner = Fields::of_system(units);
            inner
                .plain("name", contact.name.clone())
                .nested("event_counts", put_counts(units, &self.history.counts[index]));
            let means = self.means.as_ref().map(|means| means[index]);
            put_means(&mut inner, means.ok_or("the run has no duration"));
            inner
        });
        contacts.collect()
    }
}

/// Adds the means of a contact.
pub(crate) fn put_means(fields: &mut Fields, means: Result<ContactMeans, &'static str>) {
    let of = |pick: fn(&ContactMeans) -> f64| means.as_ref().map(pick).map_err(|why| (*why).into());
    fields
        .known("stick_fraction", Quantity::Ratio, of(|means| means.stick_fraction))
        .known("open_fraction", Quantity::Ratio, of(|means| means.open_fraction))
        .known("mean_friction", Quantity::Force, of(|means| means.friction))
        .known("mean_normal", Quantity::Force, of(|means| means.normal_load))
        .known("least_normal", Quantity::Force, of(|means| means.least_load))
        .known("friction_power", Quantity::Power, of(|means| means.friction_power));
}

/// Counts kind by kind.
fn put_counts(units: UnitSystem, counts: &[u64; KINDS.len()]) -> Fields {
    let mut fields = Fields::of_system(units);
    for (kind, count) in KINDS.iter().zip(counts) {
        fields.plain(kind.name(), *count);
    }
    fields
}

/// Warnings of the engine about a run.
pub(crate) fn of_engine(system: &System, end: &MotionEnd) -> Vec<String> {
    let mut warnings = Vec::new();
    let releases = end.near_tangential_releases;
    if releases > 0 {
        warnings.push(format!(
            "{releases} release{} barely crossed the stiction threshold, where forward uniqueness is not guaranteed",
            plural(releases)
        ));
    }
    let dependent = end.dependent.iter().map(|contact| system.contacts[*contact].name.clone());
    let dependent: Vec<String> = dependent.collect();
    if !dependent.is_empty() {
        warnings.push(format!(
            "the friction forces in stick of contacts {} are not unique, because their tangents depend on each other: the \
             least-norm forces within the bounds are given; the motion is unique",
            listed(&dependent)
        ));
    }
    warnings
}
