//! The steady response: settled record, spectrum, efficiency E, and what the dither costs.
//!
//! The record is declared, because the dissertation gives none and E depends on it: `settle`
//! is discarded, then an integral number of slow periods 2π is kept, the mean removed, a
//! periodic Hann window applied, and zeros appended to four times the length. M is the
//! largest spectral amplitude of x at 0 < ω ≤ 1.9, and E = M₁/M₀ (2.27) compares the runs with
//! and without dither from the same state and phase. Keeping the mean makes E > 1; keeping
//! the start-up under a rectangular window puts a floor of about 0.3 under E.
//!
//! What the dither does in one word, and where its run ends, is decided by the exact undithered cycle map and by the judge of
//! [`crate::attractor`], not by the record ([`effect()`]).
//!
//! Everything is measured while integrating ([`compare_many`]), alone or for many cases side by
//! side, with the same bits; only [`respond`] keeps the samples too, for spectra and pictures.

mod cost;
mod effect;
mod effective;
mod isocline;
mod listener;
mod measure;
mod record;

use std::fmt;

use quell_model::Belt;
pub use quell_numerics::spectrum::{Peak, Spectrum};

pub use crate::band::BAND_END;
use crate::simulation::{DEFAULT_TOLERANCE, Sampler, Stalled, Start};
pub use effect::{Effect, Ending, QUENCHED, Uncertain, effect};
pub use effective::{WindowMean, measured_effective_friction};
pub use isocline::amplitude_at_efficiency;
use listener::Sampling;
pub use listener::samples_per_slow_period;
pub use measure::{Case, Compared, Measured, Wanted, compare_many, measure_many};
pub use record::Record;

/// Two halves of a record agree when their M differ by less than this share.
pub const HALVES_AGREE: f64 = 0.01;

/// … or by less than this share of the undithered M: E is then known to a thousandth. A
/// quenched response is a remnant whose halves never agree relatively.
pub const HALVES_NEGLIGIBLE: f64 = 1e-3;

/// Peaks below this share of the largest are not listed.
pub const PEAK_FLOOR: f64 = 1e-3;

/// How a response is computed; `[solver]` of a study.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Solver {
    /// Bound on the last retained Taylor terms of a step, relative to F.
    pub tolerance: f64,
    /// Time τ discarded before the record.
    pub settle: f64,
    /// Slow periods 2π in the record.
    pub record_periods: u32,
}

impl Default for Solver {
    fn default() -> Self {
        Self { tolerance: DEFAULT_TOLERANCE, settle: 1200.0, record_periods: 60 }
    }
}

/// Why E is undefined.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Undefined {
    /// The undithered run from this state settles to steady sliding; a limit cycle may still
    /// exist elsewhere.
    UnditheredSettles,
    /// The belt does not move (v₀ = 0), so that the undithered run comes to rest.
    UnditheredAtRest,
    /// Where the undithered run ends is unknown.
    UnditheredUnknown,
}

impl fmt::Display for Undefined {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::UnditheredSettles => {
                "without dither the belt settles to steady sliding from this start, so there is \
                 no vibration to compare with (a limit cycle may exist from another start)"
            }
            Self::UnditheredAtRest => {
                "the belt does not move (v₀ = 0), so without dither the mass comes to rest, and \
                 there is no vibration to compare with"
            }
            Self::UnditheredUnknown => {
                "where the undithered run from this start ends is unknown: it converges neither to \
                 a known limit cycle nor to stable steady sliding"
            }
        })
    }
}

impl std::error::Error for Undefined {}

/// A steady response. Lengths in the study's length, frequencies in ω₀.
#[derive(Clone, Debug)]
pub struct Response {
    /// M, the largest spectral amplitude of x at 0 < ω ≤ 1.9.
    pub amplitude: f64,
    /// Peaks of the spectrum of x, in order of frequency.
    pub peaks: Vec<Peak>,
    /// Share of the record spent in stick.
    pub stick_fraction: f64,
    /// What the dither does.
    pub effect: Effect,
    /// Where the dithered run ends.
    pub ending: Ending,
    /// E = M₁/M₀ (2.27), the residual vibration.
    pub efficiency: Result<f64, Undefined>,
    /// M of the undithered run from the same state.
    pub undithered_amplitude: f64,
    /// Whether M of the two halves of the record agree, and nothing is left in it of a vibration that dies out.
    pub settled: bool,
    /// The same for the undithered run.
    pub undithered_settled: bool,
    /// Mean friction force ⟨f⟩ (over k) in the record.
    pub mean_friction: f64,
    /// Friction force of undithered steady sliding, μ(v₀)F.
    pub mean_friction_undithered: f64,
    /// Mean power ⟨D_T g_T x′⟩ (over kω₀) that tangential dither feeds in; `None` when all dither
    /// is normal, for the model has no normal motion on which it could work.
    pub dither_power: Option<f64>,
    /// Peak-to-peak displacement at the frequencies of the tangential dithers, which their
    /// actuators must follow; `None` as for the power.
    pub dither_stroke: Option<f64>,
    /// Smallest normal load N in the record.
    pub minimum_normal_load: f64,
    /// The record with dither.
    pub record: Record,
    /// The record without.
    pub undithered_record: Record,
}

/// Integrates `belt` from `start` with and without its dither and measures the steady response.
///
/// # Errors
/// [`Stalled`] if a run stops.
pub fn respond(belt: &Belt, start: Start, solver: &Solver) -> Result<Response, Stalled> {
    let one = |belt: &Belt, wanted, like: Option<&Record>| {
        let case = Case { belt: belt.clone(), start };
        // The undithered run is sampled as the dithered one, to be shown beside it.
        let sampler = |_: &Case, sampling: &Sampling| match like {
            Some(like) => Sampler::new(sampling.from, like.step, like.samples.len()),
            None => Sampler::new(sampling.from, sampling.step, sampling.count),
        };
        let outcome = measure::record_many(&[case], solver, wanted, sampler).pop();
        let (measured, sampler) = outcome.unwrap_or(Err(Stalled::NEVER_STARTED))?;
        let step = sampler.step();
        Ok((measured, Record::of(sampler.samples, step)))
    };
    let (dithered, record) = one(belt, Wanted { dither_cost: true }, None)?;
    let (undithered, undithered_record) =
        one(&belt.undithered(), Wanted::default(), Some(&record))?;
    let case = Case { belt: belt.undithered(), start };
    let vibrates = measure::keeps_vibrating_without(&case)?;
    let compared = Compared { dithered, undithered, vibrates };
    let ending = Ending::of(belt, start);
    let effect = effect(belt, &compared, ending);
    Ok(Response {
        effect,
        ending,
        amplitude: dithered.lines.whole,
        peaks: record.spectrum.peaks(PEAK_FLOOR),
        stick_fraction: dithered.stick_fraction,
        efficiency: compared.efficiency(),
        undithered_amplitude: undithered.lines.whole,
        settled: compared.settled() && !effect::still_decays(effect, &compared),
        undithered_settled: compared.undithered_settled(),
        mean_friction: dithered.mean_friction,
        mean_friction_undithered: belt.steady_sliding(),
        dither_power: dithered.dither_power,
        dither_stroke: dithered.dither_stroke,
        minimum_normal_load: dithered.minimum_normal_load,
        record,
        undithered_record,
    })
}
