//! The steady response: settled record, spectrum, residual vibration E (the efficiency metric of the dissertation), and the cost of the dither.
//!
//! [`respond`] measures any system; [`compare_many`] many belts at once for maps, while they are integrated, with records of the run itself.
//! Both measure M in the same band and decide the effect of a dither by [`Vibrations`].

mod effect;
mod effective;
mod isocline;
mod measure;
mod record_grid;
mod record_lines;
mod record_tones;
mod refused;
mod response_plan;
mod settled_record;
mod side_by_side;
mod solver;
mod spectral_meter;
mod steady_response;
mod system_ending;

pub use quell_numerics::spectrum::{Peak, Spectrum};

pub use crate::band::{
    BAND_END, dither_reaches_the_band, is_above_the_band, vibration_frequency,
    wave_reaches_the_band,
};
pub use effect::{Effect, QUENCHED, SUPPRESSED, Uncertain, Vibrations};
pub use effective::{
    NoSteadyFriction, SteadyFriction, WindowMean, measured_effective_friction,
    steady_effective_friction,
};
pub use isocline::amplitude_at_residual_vibration;
pub use measure::{Compared, MeasuredRecord, ResponseCase, Undefined, compare_many};
pub use record_lines::{HALVES_AGREE, HALVES_NEGLIGIBLE, RecordLines};
pub use refused::ResponseRefused;
pub use response_plan::ResponsePlan;
pub use settled_record::SettledRecord;
pub use side_by_side::{PlannedResponse, ResponseSummary, respond_many};
pub use solver::Solver;
pub use steady_response::{PEAK_FLOOR, SteadyResponse, UnditheredResponse, respond};
pub use system_ending::SystemEnding;
