//! `response --window`: what a run does between two of its times. A study whose drive, load or dither varies has no steady
//! response; a steady study has one as well.

use quell_dynamics::belt_motion::motion_start;
use quell_dynamics::motion::{ContactMeans, ContactMeter, Motion, MotionStart, RowMeter};
use quell_model::System;
use quell_model::profile::Wave;
use quell_model::units::Quantity;
use quell_numerics::spectrum::{Peak, Spectrum};
use serde_json::Value as Json;

use super::belt_start::begin;
use super::failed;
use super::system::simulate::{beyond_laws_of, of_engine, put_means};
use super::system::start::start_of;
use super::system::{has_equations, velocity_in_words};
use crate::complaint::{Complaint, Failure};
use crate::contact_state::passivity;
use crate::fields::Fields;
use crate::study::{BeltStudy, SystemStudy};
use crate::words::in_words;

/// Samples of the window.
const MOST_SAMPLES: f64 = 1_000_000.0;

/// Samples per period of the fastest motion.
const SAMPLES_PER_PERIOD: f64 = 32.0;

/// What a run does between two of its times.
#[derive(Clone, Debug)]
pub struct WindowedResponse {
    /// Beginning and end of the window.
    pub window: (f64, f64),
    /// The displacement: of a belt x, of a system its observed row.
    pub observed: RowMeter,
    /// Time between two samples of the displacement.
    pub step: f64,
    /// The largest line of the spectrum, or why it has no line.
    pub strongest: Result<Peak, String>,
    /// Names of the contacts, and what they did on average.
    pub contacts: Vec<(String, ContactMeans)>,
    /// Warnings about slip beyond the range of a law, and of the engine.
    pub warnings: Vec<String>,
}

/// Measures a belt.
///
/// # Errors
/// A window that does not go forward; a start that does not exist; [`Failure::Failed`] if the engine stops.
pub fn of_belt(study: &BeltStudy, window: (f64, f64)) -> Result<WindowedResponse, Failure> {
    let system = study.belt().system();
    let start = motion_start(&system, begin(study)?);
    let words = |speed| in_words(study, Quantity::Velocity, speed);
    let mut found = measured(&system, &[1.0], &start, window, words)?;
    found.warnings.extend(passivity(study));
    Ok(found)
}

/// Measures a system.
///
/// # Errors
/// As [`of_belt`].
pub fn of_system(study: &SystemStudy, window: (f64, f64)) -> Result<WindowedResponse, Failure> {
    has_equations(study, "response")?;
    let words = |speed| velocity_in_words(study, speed);
    let mut found = measured(study.system(), &study.observe(), &start_of(study)?, window, words)?;
    found.warnings.extend(study.warnings().iter().cloned());
    Ok(found)
}

fn measured(
    system: &System,
    row: &[f64],
    start: &MotionStart,
    window: (f64, f64),
    in_words: impl Fn(f64) -> String,
) -> Result<WindowedResponse, Failure> {
    let (from, to) = window;
    if !(from >= start.time && from < to && to.is_finite()) {
        let allowed = format!("two times A:B with {} ≤ A < B", start.time);
        return Err(Complaint::option("--window", format!("{from}:{to}"), allowed).into());
    }
    let motion = Motion::new(system).map_err(failed)?;
    let before = motion.run(start, from, motion.run_tolerance(), &mut ()).map_err(failed)?;
    let fastest = system.waves().map(Wave::highest).fold(1.0 / motion.time_scale(), f64::max);
    let wanted = SAMPLES_PER_PERIOD * (to - from) * fastest / std::f64::consts::TAU;
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a count")]
    let count = wanted.ceil().clamp(256.0, MOST_SAMPLES) as usize;
    let step = (to - from) / count as f64;
    let mut observed = RowMeter::new(row, from, step, count);
    let mut meter = ContactMeter::new(system.contacts.len());
    let end =
        motion.run(&before.restart(), to, motion.run_tolerance(), &mut (&mut observed, &mut meter));
    let end = end.map_err(failed)?;
    observed.finish(&end.state);
    let mut warnings = beyond_laws_of(system, in_words, |contact| meter.largest_slip(contact));
    warnings.extend(of_engine(system, &end));
    let spectrum = Spectrum::of(&observed.samples, step).map_err(|why| why.to_string());
    let strongest = spectrum.and_then(|spectrum| {
        let line = spectrum.largest_line(0.0, f64::INFINITY);
        line.filter(|line| line.amplitude > 0.0)
            .ok_or_else(|| "nothing moves in the window".to_owned())
    });
    let names = system.contacts.iter().map(|contact| contact.name.clone());
    let means = meter.means().unwrap_or_default();
    let contacts = names.zip(means).collect();
    Ok(WindowedResponse { window, observed, step, strongest, contacts, warnings })
}

impl WindowedResponse {
    /// The window in one sentence; `in_words` writes a quantity with its unit.
    pub fn sentence(&self, in_words: impl Fn(Quantity, f64) -> String) -> String {
        let (from, to) = self.window;
        let time = |time| in_words(Quantity::Time, time);
        let length = |value| in_words(Quantity::Displacement, value);
        let line = match &self.strongest {
            Ok(line) => format!(
                "; its strongest line is {} at {}",
                length(line.amplitude),
                in_words(Quantity::FrequencyRatio, line.frequency)
            ),
            Err(_) => String::new(),
        };
        format!(
            "From {} to {} the displacement has the mean {}, the rms {} about it, and half of its peak-to-peak value is {}{line}.",
            time(from),
            time(to),
            length(self.observed.mean()),
            length(self.observed.deviation()),
            length(0.5 * self.observed.range())
        )
    }

    /// Adds the numbers of the window and of its contacts.
    pub fn put(&self, fields: &mut Fields, empty: &dyn Fn() -> Fields) {
        let line = |pick: fn(&Peak) -> f64| self.strongest.as_ref().map(pick).map_err(Clone::clone);
        fields
            .number("from", Quantity::Time, self.window.0)
            .number("to", Quantity::Time, self.window.1)
            .number("mean", Quantity::Displacement, self.observed.mean())
            .number("rms", Quantity::Displacement, self.observed.deviation())
            .number("amplitude", Quantity::Displacement, 0.5 * self.observed.range())
            .known("strongest_amplitude", Quantity::Displacement, line(|line| line.amplitude))
            .known("strongest_frequency", Quantity::FrequencyRatio, line(|line| line.frequency));
        let contacts = self.contacts.iter().map(|(name, means)| {
            let mut inner = empty();
            inner.plain("name", name.clone());
            put_means(&mut inner, Ok(*means));
            inner
        });
        fields.list("contacts", contacts.collect::<Vec<_>>());
    }

    /// Times and values of the displacement.
    pub fn samples(&self) -> (Vec<f64>, &[f64]) {
        let times = (0..self.observed.samples.len())
            .map(|place| self.step.mul_add(place as f64, self.window.0));
        (times.collect(), &self.observed.samples)
    }

    /// The whole answer as JSON.
    pub fn json(&self, sentence: String, empty: impl Fn() -> Fields) -> Json {
        let mut fields = empty();
        fields.plain("ok", true).plain("sentence", sentence);
        self.put(&mut fields, &empty);
        fields.plain("warnings", self.warnings.clone());
        fields.finish()
    }
}
