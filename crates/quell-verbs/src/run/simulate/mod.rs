//! `simulate`: one motion with every event of every contact.

mod answer;
pub mod history;
mod sound;
mod trajectory;

use std::f64::consts::TAU;

use quell_numerics::interval::RealInterval;

pub use quell_dynamics::motion::MotionStart;
use quell_dynamics::motion::{
    ContactMeans, ContactMeter, Motion, MotionEnd, MotionObserver, MotionSampler, MotionSegment,
    RowMeter,
};
use quell_model::profile::Wave;
use quell_model::units::Quantity;

use self::history::EventHistory;
use self::sound::MotionSoundTap;
use super::manoeuvre::{Manoeuvre, SampledMotion};
use super::sample_times;
use super::system::of_runs::{beyond_laws, failed_run};
use super::system::periods::{natural_period, slowest_period};
use super::system::start::{StateNumbers, start_with};
use super::system::{failed, has_equations, in_units};
use crate::complaint::{Complaint, Failure};
use crate::quantity::MOST_TIME;
use crate::sound::{Sound, SoundOptions};
use crate::study::SystemStudy;

/// Periods of the slowest oscillation that a run lasts if no duration is given.
pub const DEFAULT_PERIODS: f64 = 100.0;

/// Samples per period of the fastest dither and of the fastest motion of the structure.
const SAMPLES_PER_PERIOD: f64 = 64.0;

/// Least number of intervals between samples.
const LEAST_SAMPLES: f64 = 256.0;

/// Largest number of numbers in all samples together, about 160 megabytes; a longer run is sampled more coarsely.
const MOST_NUMBERS: f64 = 20_000_000.0;

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
    /// Whether the motion from the same start without dither is sampled as well.
    pub undithered: bool,
    /// The sound of the velocity of the observed row, if wanted.
    pub sound: Option<SoundOptions>,
}

impl MotionRequest {
    /// From the start of the study to a time.
    pub fn to(until: f64) -> Self {
        Self { until: Some(until), ..Self::default() }
    }

    /// Whether the run begins at the start of the study.
    pub(crate) fn begins_as_the_study(&self) -> bool {
        self.start.is_empty() && self.from.is_none()
    }
}

/// One motion.
#[derive(Clone, Debug)]
pub struct Simulation {
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
    /// Samples of the motion without dither, if requested and the study has dither; or the reason for their absence.
    pub undithered: Option<Result<MotionSampler, Failure>>,
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
pub fn run(study: &SystemStudy, request: &MotionRequest) -> Result<Simulation, Failure> {
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
) -> Result<Simulation, Failure> {
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
    let plan = request
        .sound
        .map(|options| sound::plan(study, RealInterval::new(start.time, until), options));
    let plan = plan.transpose()?;
    sample_times::are_within(start.time, until, request.times.as_deref())?;
    // That of a belt, whose time scale is 1. The engine refuses what takes too many steps; with more, it would begin runs of days.
    let acting = system.waves().filter(|wave| wave.amplitude != 0.0);
    let shortest = acting.map(|wave| wave.highest().recip()).fold(motion.time_scale(), f64::min);
    let longest = MOST_TIME * shortest;
    if until - start.time > longest {
        let allowed = format!(
            "at most {} after the start, some 10⁸ periods of the fastest motion or dither",
            in_units(study.units(), Quantity::Time, longest)
        );
        return Err(Complaint::option("--until", until, allowed).into());
    }
    let (intervals, coarse) = if request.samples && request.times.is_none() {
        grid(&motion, until - start.time)
    } else {
        (0, false)
    };
    let step = (until - start.time) / intervals.max(1) as f64;
    let contacts = system.contacts.len();
    let mut meter = ContactMeter::new(contacts);
    let mut history = EventHistory::new(contacts, motion.size(), request.samples);
    let sampling = || match &request.times {
        Some(times) => MotionSampler::at(times.clone()),
        None => MotionSampler::new(start.time, step, intervals),
    };
    let mut sampler = sampling();
    let mut tap = MotionSoundTap::new(study, &start, plan.as_ref());
    let mut trace = trace(study, &motion, RealInterval::new(start.time, until));
    let watch = (&mut tap, (&mut trace, watch));
    let mut observer = (&mut meter, (&mut history, (&mut sampler, watch)));
    let end = motion
        .run(&start, until, motion.run_tolerance(study.tolerance()), &mut observer)
        .map_err(|stopped| failed_run("simulate", system, &stopped))?;
    let finished = |mut sampler: MotionSampler, end: &MotionEnd| {
        if request.times.is_some() {
            sampler.finish(end);
        } else {
            sampler.push_end(end);
        }
        sampler
    };
    let undithered = (request.undithered && system.is_dithered())
        .then(|| without_dither(study, &start, until, sampling(), finished));
    let beyond = beyond_laws(study, |contact| meter.largest_slip(contact));
    let manoeuvre = manoeuvre(study, trace, start.time);
    Ok(Simulation {
        request: request.clone(),
        start,
        sound: tap.finish(study, &end),
        samples: request.samples.then(|| finished(sampler, &end)),
        undithered,
        end,
        history,
        means: meter.means(),
        tolerance: motion.bound_of_runs(study.tolerance()),
        coarse,
        manoeuvre,
        beyond,
    })
}

/// The samples of the motion from a start without dither.
fn without_dither(
    study: &SystemStudy,
    start: &MotionStart,
    until: f64,
    mut sampler: MotionSampler,
    finished: impl Fn(MotionSampler, &MotionEnd) -> MotionSampler,
) -> Result<MotionSampler, Failure> {
    let still = study.system().undithered();
    let motion = Motion::new(&still).map_err(|why| failed("simulate", why))?;
    let end = motion
        .run(start, until, motion.run_tolerance(study.tolerance()), &mut sampler)
        .map_err(|stopped| failed_run("simulate", &still, &stopped))?;
    Ok(finished(sampler, &end))
}

/// The observed row in which the vibration of a run is found; none of a steady study.
fn trace(
    study: &SystemStudy,
    motion: &Motion<'_>,
    RealInterval { lower: from, upper: until }: RealInterval,
) -> TracedRow {
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
        natural_period(study, RealInterval::new(start, start + meter.samples.len() as f64 * step)),
        slowest.map(|rate| TAU / rate),
        study.system(),
    ))
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
