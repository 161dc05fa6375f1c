//! The steady response: settled record, spectrum, residual vibration E (the efficiency metric of the dissertation), and the cost of the dither.
//!
//! The record is defined here, because the dissertation specifies none and E depends on it: `settle`
//! is discarded, then an integral number of slow periods 2π is kept, the mean removed, a
//! periodic Hann window applied, and zeros appended to four times the length. M is the
//! largest spectral amplitude of x at 0 < ω ≤ 1.9, and E = M₁/M₀ (2.27) compares the runs with
//! and without dither from the same state and phase. Keeping the mean would make E > 1; keeping
//! the start-up under a rectangular window would limit E to about 0.3 from below.
//!
//! The effect of the dither, and where its run settles, is decided by the exact undithered cycle map and by
//! [`crate::attractor`], not by the record ([`effect()`]).
//!
//! Everything is measured while integrating ([`compare_many`]), alone or for many cases side by
//! side, with the same bits; only [`respond`] keeps the samples too, for spectra and pictures.

mod cost;
mod dither_lines;
mod effect;
mod effective;
mod isocline;
mod measure;
mod record;
mod record_lines;
mod record_tones;
mod solver;
mod spectral_meter;
mod steady_response;
mod system_ending;
mod system_response;

pub use quell_numerics::spectrum::{Peak, Spectrum};

pub use crate::band::{
    BAND_END, dither_reaches_the_band, is_above_the_band, vibration_frequency,
    wave_reaches_the_band,
};
pub use dither_lines::stroke_is_measured;
pub use effect::{Effect, QUENCHED, RunEnding, SUPPRESSED, Uncertain, Vibrations, effect};
pub use effective::{
    SteadyFriction, WindowMean, measured_effective_friction, steady_effective_friction,
};
pub use isocline::amplitude_at_residual_vibration;
pub use measure::{
    Compared, MeasuredRecord, Observables, ResponseCase, Undefined, compare_many, measure_many,
};
pub use record::SettledRecord;
pub use record_lines::{HALVES_AGREE, HALVES_NEGLIGIBLE, RecordLines};
pub use solver::Solver;
pub use spectral_meter::samples_per_slow_period;
pub use steady_response::{PEAK_FLOOR, SteadyResponse, respond, respond_with_state};
pub use system_ending::SystemEnding;
pub use system_response::{
    ResponsePlan, ResponseRefused, SystemRecord, SystemResponse, UnditheredResponse, respond_system,
};
