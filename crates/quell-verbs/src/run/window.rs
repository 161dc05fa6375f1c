//! `response --window`: what a run does between two of its times. A study whose drive, load or dither varies has no steady
//! response; a steady study has one as well.

use quell_dynamics::motion::{ContactMeans, ContactMeter, Motion, RowMeter};
use quell_model::profile::Wave;
use quell_model::units::{Quantity, UnitSystem};
use quell_numerics::interval::RealInterval;
use quell_numerics::spectrum::{Peak, Spectrum, SpectrumError};
use serde_json::Value as Json;

use super::failed;
use super::system::of_runs::{beyond_laws, of_engine, put_means};
use super::system::start::start_of;
use super::system::{frequency_in_words, has_equations, in_units};
use crate::complaint::{Complaint, Failure};
use crate::fields::Fields;
use crate::reasons::reasons;
use crate::study::SystemStudy;

/// Samples of the window.
const MOST_SAMPLES: f64 = 1_000_000.0;

/// Samples per period of the fastest motion.
const SAMPLES_PER_PERIOD: f64 = 32.0;

reasons! {
    /// Why a record has no strongest line.
    pub enum NoStrongestLine {
        /// It has no spectrum.
        NoSpectrum(SpectrumError),
        ;
        /// Nothing moves.
        NothingMoves => "nothing moves in the window",
    }
}

/// What a run does between two of its times.
#[derive(Clone, Debug)]
pub struct WindowedResponse {
    /// Beginning and end of the window.
    pub window: RealInterval,
    /// The observed displacement.
    pub observed: RowMeter,
    /// Time between two samples of the displacement.
    pub step: f64,
    /// The largest line of the spectrum, or why it has no line.
    pub strongest: Result<Peak, NoStrongestLine>,
    /// Names of the contacts, and what they did on average.
    pub contacts: Vec<(String, ContactMeans)>,
    /// Warnings: those of the study, about slip beyond the range of a law, and of the engine.
    pub warnings: Vec<String>,
}

/// Measures a run of a study.
///
/// # Errors
/// A window that does not go forward; a start that does not exist; [`Failure::Failed`] if the engine stops.
pub fn run(study: &SystemStudy, window: RealInterval) -> Result<WindowedResponse, Failure> {
    has_equations(study, "response --window")?;
    let (system, start) = (study.system(), start_of(study)?);
    let RealInterval { lower: from, upper: to } = window;
    if !(from >= start.time && from < to && to.is_finite()) {
        let allowed = format!("two times A:B with {} ≤ A < B", start.time);
        return Err(Complaint::option("--window", format!("{from}:{to}"), allowed).into());
    }
    let motion = Motion::new(system).map_err(failed)?;
    let before = motion
        .run(&start, from, motion.run_tolerance(study.tolerance()), &mut ())
        .map_err(failed)?;
    let fastest = system.waves().map(Wave::highest).fold(1.0 / motion.time_scale(), f64::max);
    let wanted = SAMPLES_PER_PERIOD * (to - from) * fastest / std::f64::consts::TAU;
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a count")]
    let count = wanted.ceil().clamp(256.0, MOST_SAMPLES) as usize;
    let step = (to - from) / count as f64;
    let mut observed = RowMeter::new(&study.observe(), from, step, count);
    let mut meter = ContactMeter::new(system.contacts.len());
    let end = motion.run(
        &before.restart(),
        to,
        motion.run_tolerance(study.tolerance()),
        &mut (&mut observed, &mut meter),
    );
    let end = end.map_err(failed)?;
    observed.finish(&end.state);
    let mut warnings = study.warnings().to_vec();
    warnings.extend(beyond_laws(study, |contact| meter.largest_slip(contact)));
    warnings.extend(of_engine(system, &end));
    let spectrum = Spectrum::of(&observed.samples, step).map_err(NoStrongestLine::from);
    let strongest = spectrum.and_then(|spectrum| {
        let line = spectrum.largest_line(0.0, f64::INFINITY);
        line.filter(|line| line.amplitude > 0.0).ok_or(NoStrongestLine::NothingMoves)
    });
    let names = system.contacts.iter().map(|contact| contact.name.clone());
    let means = meter.means().unwrap_or_default();
    let contacts = names.zip(means).collect();
    Ok(WindowedResponse { window, observed, step, strongest, contacts, warnings })
}

impl WindowedResponse {
    /// The window in one sentence.
    pub fn sentence(&self, study: &SystemStudy) -> String {
        let RealInterval { lower: from, upper: to } = self.window;
        let in_words = |quantity, value| in_units(study.units(), quantity, value);
        let time = |time| in_words(Quantity::Time, time);
        let length = |value| in_words(Quantity::Displacement, value);
        let line = match &self.strongest {
            Ok(line) => format!(
                "; its strongest line is {} at {}",
                length(line.amplitude),
                frequency_in_words(study.units(), line.frequency)
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
    fn put(&self, fields: &mut Fields, units: UnitSystem) {
        let line = |pick: fn(&Peak) -> f64| self.strongest.as_ref().map(pick);
        fields
            .number("from", Quantity::Time, self.window.lower)
            .number("to", Quantity::Time, self.window.upper)
            .number("mean", Quantity::Displacement, self.observed.mean())
            .number("rms", Quantity::Displacement, self.observed.deviation())
            .number("amplitude", Quantity::Displacement, 0.5 * self.observed.range())
            .known("strongest_amplitude", Quantity::Displacement, line(|line| line.amplitude))
            .known("strongest_frequency", Quantity::FrequencyRatio, line(|line| line.frequency));
        let contacts = self.contacts.iter().map(|(name, means)| {
            let mut inner = Fields::in_units(units);
            inner.plain("name", name.clone());
            put_means(&mut inner, Ok(*means));
            inner
        });
        fields.list("contacts", contacts.collect::<Vec<_>>());
    }

    /// Times and values of the displacement.
    pub fn samples(&self) -> (Vec<f64>, &[f64]) {
        let times = (0..self.observed.samples.len())
            .map(|place| self.step.mul_add(place as f64, self.window.lower));
        (times.collect(), &self.observed.samples)
    }

    /// The whole answer as JSON.
    pub fn json(&self, study: &SystemStudy) -> Json {
        let mut fields = Fields::in_units(study.units());
        fields.plain("ok", true).plain("sentence", self.sentence(study));
        self.put(&mut fields, study.units());
        fields.plain("warnings", self.warnings.clone());
        fields.finish()
    }
}
