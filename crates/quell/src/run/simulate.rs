//! `simulate`: one trajectory with its events.

use std::f64::consts::TAU;

use quell_dynamics::belt_motion::{ContactStart, run_belt};
use quell_dynamics::motion::ContactEnd;
pub use quell_dynamics::simulation::Start;
use quell_dynamics::simulation::{
    Event, EventKind, EventRecorder, FinalState, LargestSlip, Sample, Sampler,
};
use quell_model::Dither;
use quell_model::units::Quantity;
use serde_json::Value as Json;

use super::belt_start::begin;
use super::failed;
use super::manoeuvre::{Manoeuvre, SampledMotion};
use super::sample_times;
use super::sound_tap::{SoundTap, fastest_dither, plan};
use crate::complaint::Failure;
use crate::contact_state::passivity;
use crate::dataset::{Array, Dataset};
use crate::fields::Fields;
use crate::range::SlipMet;
use crate::sound::{Sound, SoundOptions};
use crate::study::BeltStudy;
use crate::words::{in_words, plural, start_in_words};

/// Samples per period of the fastest dither, and at least this many in a slow period.
const SAMPLES_PER_DITHER_PERIOD: f64 = 32.0;
const SAMPLES_PER_SLOW_PERIOD: f64 = 256.0;

/// Largest number of samples kept; a longer run is sampled more coarsely.
pub const MOST_SAMPLES: usize = 2_000_000;

/// Natural period of a belt, 2π/ω₀.
pub(crate) const NATURAL_PERIOD: f64 = TAU;

/// Where a run begins, if not at the start of the study, and what it keeps.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Options {
    /// State and time at which it begins.
    pub start: Option<Start>,
    /// Times of the samples in ascending order, instead of equal steps.
    pub times: Option<Vec<f64>>,
    /// Whether every event is kept.
    pub events: bool,
    /// Whether the trajectory is sampled densely.
    pub samples: bool,
    /// Whether the run without dither is computed as well.
    pub undithered: bool,
    /// The sound of the velocity, if wanted.
    pub sound: Option<SoundOptions>,
}

/// A trajectory.
#[derive(Clone, Debug)]
pub struct Simulation {
    /// Initial state.
    pub start: Start,
    /// Whether it was given, and is not that of the study.
    pub given: bool,
    /// Final state.
    pub end: FinalState,
    /// The contact at the end of a run whose drive, load or dither varies in time.
    pub contact: Option<ContactEnd>,
    /// The events, if requested.
    pub events: Option<Vec<Event>>,
    /// Samples at equal steps, both ends included, if requested.
    pub samples: Option<Vec<Sample>>,
    /// Samples of the run without dither, if requested and the study has dither.
    pub undithered_samples: Option<Vec<Sample>>,
    /// The sound of the velocity, if requested.
    pub sound: Option<Sound>,
    /// Whether the samples are too coarse to resolve the fastest dither.
    pub coarse: bool,
    /// The slip reached.
    pub slip: SlipMet,
    /// When the run vibrates, where drive, load or dither varies in time.
    pub manoeuvre: Option<Manoeuvre>,
}

/// Integrates a study to τ = `until`.
///
/// # Errors
/// [`Failure::Wrong`] if a squealing start is requested but does not exist, if the run would end before it begins, if a time of
/// a sample is not within it, or if the sound would be too long;
/// [`Failure::Failed`] if the engine stops.
pub fn run(study: &BeltStudy, until: f64, options: Options) -> Result<Simulation, Failure> {
    let Options { start: given, times, events, samples: sampled, undithered, sound } = options;
    let belt = study.belt();
    let from = match given {
        Some(state) => (state, ContactStart::Relaxed),
        None => begin(study)?,
    };
    let start = from.0;
    sample_times::are_within(start.time, until, times.as_deref())?;
    let sound = sound.map(|sound| plan(study, until - start.time, sound)).transpose()?;
    let (intervals, coarse) =
        if sampled && times.is_none() { grid(study, until - start.time) } else { (0, false) };
    let sample_step = (until - start.time) / (intervals.max(1) as f64);
    let sampling = || match &times {
        Some(times) => Sampler::at(times.clone()),
        None => Sampler::new(start.time, sample_step, intervals),
    };
    // The last point of a grid may round to just beyond the end.
    let finished = |sampler: Sampler, end: &FinalState| match times {
        Some(_) => sampler.finished(end),
        None => with_end(sampler.samples, end),
    };
    let mut sampler = sampling();
    let tolerance = study.solver().tolerance;
    let mut recorder = EventRecorder::default();
    let mut largest = LargestSlip::of(belt);
    let mut tap = SoundTap::new(start, sound.as_ref());
    let mut trace = trace(study, start.time, until);
    let mut watch = (&mut largest, (&mut sampler, (&mut tap, &mut trace)));
    let end = if events {
        run_belt(belt, from, until, tolerance, &mut (&mut recorder, &mut watch))
    } else {
        run_belt(belt, from, until, tolerance, &mut watch)
    }
    .map_err(failed)?;
    let (end, contact) = (end.state, end.contact);
    let mut slip = SlipMet::default();
    slip.add(belt, largest.speed);
    let samples = finished(sampler, &end);
    let undithered_samples = if undithered && !belt.dithers().is_empty() {
        let mut sampler = sampling();
        let end =
            run_belt(&belt.undithered(), from, until, tolerance, &mut sampler).map_err(failed)?;
        Some(finished(sampler, &end.state))
    } else {
        None
    };
    Ok(Simulation {
        start,
        given: given.is_some(),
        end,
        contact,
        events: events.then_some(recorder.events),
        samples: sampled.then_some(samples),
        undithered_samples,
        sound: tap.finish(&end),
        coarse,
        slip,
        manoeuvre: (!belt.is_steady()).then(|| manoeuvre(study, &trace)),
    })
}

/// Samples in which the vibration of a run is found; none of a steady belt.
fn trace(study: &BeltStudy, from: f64, until: f64) -> Sampler {
    let (intervals, _) =
        if study.belt().is_steady() { (0, false) } else { grid(study, until - from) };
    Sampler::new(from, (until - from) / intervals.max(1) as f64, intervals)
}

fn manoeuvre(study: &BeltStudy, trace: &Sampler) -> Manoeuvre {
    let start = trace.samples.first().map_or(0.0, |sample| sample.time);
    let step = trace.step();
    let displacement: Vec<f64> = trace.samples.iter().map(|sample| sample.displacement).collect();
    let motion = SampledMotion { start, step, displacement: &displacement };
    Manoeuvre::in_system(motion, NATURAL_PERIOD, slowest_repetition(study), &study.belt().system())
}

/// The longest period of a dither that acts.
pub(crate) fn slowest_repetition(study: &BeltStudy) -> Option<f64> {
    let acting = study.belt().dithers().iter().filter(|dither| dither.amplitude > 0.0);
    acting.map(Dither::repetition_ratio).reduce(f64::min).map(|ratio| TAU / ratio)
}

/// Highest angular frequency of a spectrogram: it shows the dither, unless that is so fast that the slow vibration would not
/// be seen.
pub(crate) fn highest_shown(study: &BeltStudy) -> f64 {
    match fastest_dither(study) {
        Some(fastest) if fastest <= 40.0 => (1.25 * fastest).max(6.0),
        _ => 8.0,
    }
}

/// Samples plus the final state.
fn with_end(mut samples: Vec<Sample>, end: &FinalState) -> Vec<Sample> {
    samples.push(Sample {
        time: end.time,
        displacement: end.displacement,
        velocity: end.velocity,
        sticking: end.sticking,
    });
    samples
}

/// Number of intervals between samples, and whether it had to be limited.
fn grid(study: &BeltStudy, length: f64) -> (usize, bool) {
    let fastest = fastest_dither(study).unwrap_or(0.0);
    let per_slow = SAMPLES_PER_SLOW_PERIOD.max(SAMPLES_PER_DITHER_PERIOD * fastest);
    let wanted = (length / TAU * per_slow).ceil().max(1.0);
    if wanted > MOST_SAMPLES as f64 {
        return (MOST_SAMPLES, true);
    }
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a whole number from 1 to MOST_SAMPLES"
    )]
    let count = wanted as usize;
    (count, false)
}

impl Simulation {
    /// The outcome in one sentence.
    pub fn sentence(&self, study: &BeltStudy) -> String {
        let end = &self.end;
        let state = match (end.sticking, end.slip_sign) {
            (true, _) => "the mass sticks to the belt",
            (false, sign) if sign < 0 => "the mass slides ahead of the belt",
            (false, _) => "the belt slides under the mass",
        };
        let time = if study.scales().is_some() { "t" } else { "τ" };
        let events = match end.events {
            0 => "without any contact event".to_owned(),
            1 => "after 1 contact event".to_owned(),
            count => format!("after {count} contact events"),
        };
        let ends = format!(
            "Started {}: at {} = {} {state}, {events}.",
            self.start_in_words(study),
            time,
            in_words(study, Quantity::Time, end.time)
        );
        let found = [self.manoeuvre_sentence(study), self.sound_sentence(study)];
        [Some(ends), found[0].clone(), found[1].clone()]
            .into_iter()
            .flatten()
            .collect::<Vec<_>>()
            .join(" ")
    }

    /// When the run vibrates, in one or two sentences, where drive, load or dither varies in time.
    pub fn manoeuvre_sentence(&self, study: &BeltStudy) -> Option<String> {
        let found = self.manoeuvre.as_ref()?;
        Some(found.sentence("The mass", |quantity, value| in_words(study, quantity, value)))
    }

    /// The start as text, such as "from rest".
    pub fn start_in_words(&self, study: &BeltStudy) -> String {
        if !self.given {
            return start_in_words(study);
        }
        let Start { time, displacement, velocity } = self.start;
        let symbol = if study.scales().is_some() { "t" } else { "τ" };
        format!(
            "from x = {}, x′ = {} at {symbol} = {}",
            in_words(study, Quantity::Displacement, displacement),
            in_words(study, Quantity::Velocity, velocity),
            in_words(study, Quantity::Time, time)
        )
    }

    /// The sound in one sentence, if it was requested.
    pub fn sound_sentence(&self, study: &BeltStudy) -> Option<String> {
        let sound = self.sound.as_ref()?;
        let in_real_time = study.scales().is_some() && sound.transposition == 1.0;
        Some(sound.sentence(in_real_time, |quantity, value| in_words(study, quantity, value)))
    }

    /// As JSON.
    pub fn json(&self, study: &BeltStudy) -> Json {
        let scales = study.scales();
        let mut fields = Fields::new(scales);
        fields.plain("ok", true).plain("sentence", self.sentence(study));
        let mut inner = Fields::new(scales);
        inner
            .number("time", Quantity::Time, self.start.time)
            .number("displacement", Quantity::Displacement, self.start.displacement)
            .number("velocity", Quantity::Velocity, self.start.velocity);
        fields.nested("start", inner);
        let end = &self.end;
        let mut inner = Fields::new(scales);
        inner
            .number("time", Quantity::Time, end.time)
            .number("displacement", Quantity::Displacement, end.displacement)
            .number("velocity", Quantity::Velocity, end.velocity)
            .plain("sticking", end.sticking)
            .plain("slip_sign", end.slip_sign);
        if let Some(contact) = &self.contact {
            inner.number("friction", Quantity::Force, contact.friction).number(
                "normal_load",
                Quantity::Force,
                contact.normal_load,
            );
            if let Some(bristle) = contact.bristle {
                inner.number("bristle", Quantity::Displacement, bristle);
            }
        }
        fields.nested("final", inner);
        if let Some(events) = &self.events {
            let items = events.iter().map(|event| {
                let mut inner = Fields::new(scales);
                inner
                    .number("time", Quantity::Time, event.time)
                    .plain("contact", event.contact)
                    .plain("kind", event.kind.name())
                    .plain("slip_sign", event.slip_sign)
                    .number("displacement", Quantity::Displacement, event.displacement)
                    .number("velocity", Quantity::Velocity, event.velocity);
                inner
            });
            fields.list("events", items);
        }
        if let Some(found) = &self.manoeuvre {
            fields.nested("manoeuvre", found.fields(|| Fields::new(scales)));
        }
        if let Some(sound) = &self.sound {
            let mut inner = Fields::new(scales);
            sound.state(&mut inner);
            fields.nested("sound", inner);
        }
        fields
            .plain("event_count", end.events)
            .plain("steps", end.steps)
            .plain("near_tangential_releases", end.near_tangential_releases)
            .number("tolerance", Quantity::Ratio, study.solver().tolerance)
            .plain("warnings", self.warnings(study));
        fields.finish()
    }

    /// Warnings about the result.
    pub fn warnings(&self, study: &BeltStudy) -> Vec<String> {
        let mut warnings = self.slip.warnings(study);
        warnings.extend(passivity(study));
        if self.coarse {
            warnings.push(format!(
                "only {MOST_SAMPLES} samples are kept, too few to resolve the dither"
            ));
        }
        let releases = self.end.near_tangential_releases;
        if releases > 0 {
            warnings.push(format!(
                "{releases} release{} barely crossed the stiction threshold, where forward uniqueness is not guaranteed",
                plural(releases)
            ));
        }
        if let Some(sound) = &self.sound {
            warnings.extend(sound.warnings(|quantity, value| in_words(study, quantity, value)));
        }
        warnings
    }

    /// The events, one row each; empty if not requested.
    pub fn events_dataset(&self, study: &BeltStudy) -> Dataset {
        let events = self.events.as_deref().unwrap_or_default();
        let column = |value: fn(&Event) -> f64| events.iter().map(value).collect::<Vec<f64>>();
        let kinds = [EventKind::Stick, EventKind::Release, EventKind::Reversal];
        let code = |event: &Event| kinds.iter().zip(0..).find(|(kind, _)| **kind == event.kind);
        let codes: Vec<u8> = events.iter().filter_map(|event| Some(code(event)?.1)).collect();
        let words = kinds.iter().zip(0..).map(|(kind, code)| (code, kind.name())).collect();
        let rows = (1..=events.len()).map(|row| row as f64).collect();
        Dataset::new(study, "simulate: events")
            .fact(format!("start: {}", self.start_in_words(study)))
            .axis("event", Quantity::Count, rows)
            .array("time", Quantity::Time, column(|event| event.time))
            .with(Array::of_words("kind", words, &codes))
            .array("slip_sign", Quantity::Count, column(|event| f64::from(event.slip_sign)))
            .array("displacement", Quantity::Displacement, column(|event| event.displacement))
            .array("velocity", Quantity::Velocity, column(|event| event.velocity))
    }

    /// The sampled trajectory; empty if no samples were requested.
    pub fn dataset(&self, study: &BeltStudy) -> Dataset {
        let samples = self.samples.as_deref().unwrap_or_default();
        let column = |value: fn(&Sample) -> f64| samples.iter().map(value).collect::<Vec<f64>>();
        let slip = samples.iter().map(|sample| {
            let surface = study.belt().belt_velocity_at(sample.time);
            let is_held = sample.sticking && study.belt().tangential_stiffness().is_none();
            if is_held { 0.0 } else { surface - sample.velocity }
        });
        Dataset::new(study, "simulate")
            .fact(format!("start: {}", self.start_in_words(study)))
            .axis("time", Quantity::Time, column(|sample| sample.time))
            .array("displacement", Quantity::Displacement, column(|sample| sample.displacement))
            .array("velocity", Quantity::Velocity, column(|sample| sample.velocity))
            .array("slip_velocity", Quantity::Velocity, slip.collect())
            .array(
                "sticking",
                Quantity::Count,
                column(|sample| f64::from(u8::from(sample.sticking))),
            )
    }
}
