//! The steady response of one run, with its record and spectrum, compared with the undithered run.

use quell_model::Belt;
use quell_numerics::spectrum::Peak;

use super::effect::{Effect, RunEnding, effect, still_decays};
use super::measure::{
    Compared, Observables, ResponseCase, Undefined, keeps_vibrating_without, record_many,
    record_with_state,
};
use super::record::SettledRecord;
use super::solver::Solver;
use super::spectral_meter::Sampling;
use crate::attractor::Reached;
use crate::belt_motion::{BeltStopped, ContactStart};
use crate::simulation::{Sampler, Stalled, Start};

/// Peaks below this fraction of the largest are not listed.
pub const PEAK_FLOOR: f64 = 1e-3;

/// A steady response. Lengths in the study's length, frequencies in ω₀.
#[derive(Clone, Debug)]
pub struct SteadyResponse {
    /// M, the largest spectral amplitude of x at 0 < ω ≤ 1.9.
    pub amplitude: f64,
    /// Peaks of the spectrum of x, in order of frequency.
    pub peaks: Vec<Peak>,
    /// Fraction of the record spent in stick.
    pub stick_fraction: f64,
    /// The effect of the dither.
    pub effect: Effect,
    /// Where the dithered run settles.
    pub ending: RunEnding,
    /// E = M₁/M₀ (2.27), the residual vibration.
    pub residual_vibration: Result<f64, Undefined>,
    /// M of the undithered run from the same state.
    pub undithered_amplitude: f64,
    /// Whether M of the two halves of the record agree, and no decaying vibration remains in it.
    pub settled: bool,
    /// The same for the undithered run.
    pub undithered_settled: bool,
    /// Mean friction force ⟨f⟩ (over k) in the record.
    pub mean_friction: f64,
    /// The same of the undithered run from the same state.
    pub mean_friction_undithered: f64,
    /// Friction force of undithered steady sliding, μ(v₀)F.
    pub steady_sliding_friction: f64,
    /// Mean power ⟨D_T g_T x′⟩ (over kω₀) that tangential dither feeds in; `None` if all dither
    /// is normal, because the model has no normal motion on which it could do work.
    pub dither_power: Option<f64>,
    /// Peak-to-peak displacement in the lines of the tangential dithers, which their actuators must follow: of sines, triangles and
    /// squares the line at their frequency, of other waveforms all lines together; `None` under the same condition as the power, and
    /// where these lines are unknown ([`super::stroke_is_measured`]).
    pub dither_stroke: Option<f64>,
    /// Smallest normal load N in the record.
    pub minimum_normal_load: f64,
    /// The record with dither.
    pub record: SettledRecord,
    /// The record without dither.
    pub undithered_record: SettledRecord,
}

/// Integrates `belt` from `start` with and without its dither and measures the steady response.
///
/// # Errors
/// [`Stalled`] if a run stops.
pub fn respond(belt: &Belt, start: Start, solver: &Solver) -> Result<SteadyResponse, Stalled> {
    let one = |belt: &Belt, wanted, like: Option<&SettledRecord>| {
        let case = ResponseCase { belt: belt.clone(), start };
        // The undithered run is sampled like the dithered one, so that both can be shown together.
        let sampler = |_: &ResponseCase, sampling: &Sampling| match like {
            Some(like) => Sampler::new(sampling.from, like.step, like.samples.len()),
            None => Sampler::new(sampling.from, sampling.step, sampling.count),
        };
        let outcome = record_many(&[case], solver, wanted, sampler).pop();
        let (measured, sampler) = outcome.unwrap_or(Err(Stalled::NEVER_STARTED))?;
        let step = sampler.step();
        Ok((measured, SettledRecord::of(sampler.samples, step)))
    };
    let (dithered, record) = one(belt, Observables { dither_cost: true }, None)?;
    let (undithered, undithered_record) =
        one(&belt.undithered(), Observables::default(), Some(&record))?;
    let case = ResponseCase { belt: belt.undithered(), start };
    let vibrates = keeps_vibrating_without(&case)?;
    let compared = Compared { dithered, undithered, vibrates };
    Ok(SteadyResponse::of(belt, &compared, RunEnding::of(belt, start), [record, undithered_record]))
}

/// [`respond`] of a belt whose friction has a state of its own, which begins as given: by the engine for systems and its judge of where
/// runs end.
///
/// # Errors
/// [`BeltStopped`] if a run stops.
pub fn respond_with_state(
    belt: &Belt,
    (start, contact): (Start, ContactStart),
    solver: &Solver,
) -> Result<SteadyResponse, BeltStopped> {
    let one = |belt: &Belt, wanted, like: Option<&SettledRecord>| {
        let case = ResponseCase { belt: belt.clone(), start };
        let sampler = |_: &ResponseCase, sampling: &Sampling| match like {
            Some(like) => Sampler::new(sampling.from, like.step, like.samples.len()),
            None => Sampler::new(sampling.from, sampling.step, sampling.count),
        };
        let (measured, sampler) = record_with_state(&case, contact, solver, wanted, sampler)?;
        let step = sampler.step();
        Ok((measured, SettledRecord::of(sampler.samples, step)))
    };
    let still = belt.undithered();
    let (dithered, record) = one(belt, Observables { dither_cost: true }, None)?;
    let (undithered, undithered_record) = one(&still, Observables::default(), Some(&record))?;
    let without = RunEnding::with_state(&still, (start, contact));
    let vibrates = match without {
        _ if belt.belt_velocity() == 0.0 => Err(Undefined::UnditheredAtRest),
        RunEnding::Reached(Reached::Elsewhere) => Ok(()),
        RunEnding::Reached(Reached::Base) => Err(Undefined::UnditheredSettles),
        _ => Err(Undefined::UnditheredUnknown),
    };
    let is_still = belt.dithers().iter().all(|dither| dither.amplitude == 0.0);
    let ending = if is_still { without } else { RunEnding::with_state(belt, (start, contact)) };
    let compared = Compared { dithered, undithered, vibrates };
    Ok(SteadyResponse::of(belt, &compared, ending, [record, undithered_record]))
}

impl SteadyResponse {
    /// From the measurements of both runs.
    fn of(
        belt: &Belt,
        compared: &Compared,
        ending: RunEnding,
        [record, undithered_record]: [SettledRecord; 2],
    ) -> Self {
        let effect = effect(belt, compared, ending);
        let Compared { dithered, undithered, .. } = *compared;
        Self {
            effect,
            ending,
            amplitude: dithered.lines.whole,
            peaks: record.spectrum.peaks(PEAK_FLOOR),
            stick_fraction: dithered.stick_fraction,
            residual_vibration: compared.residual_vibration(),
            undithered_amplitude: undithered.lines.whole,
            settled: compared.settled() && !still_decays(effect, compared),
            undithered_settled: compared.undithered_settled(),
            mean_friction: dithered.mean_friction,
            mean_friction_undithered: undithered.mean_friction,
            steady_sliding_friction: belt.steady_sliding(),
            dither_power: dithered.dither_power,
            dither_stroke: dithered.dither_stroke,
            minimum_normal_load: dithered.minimum_normal_load,
            record,
            undithered_record,
        }
    }
}
