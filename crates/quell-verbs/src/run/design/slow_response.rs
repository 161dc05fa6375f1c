//! The response to a dither that repeats in the band of the vibration, on the base response.

use quell_dynamics::motion::MotionStart;
use quell_dynamics::orbit::base_response;
use quell_dynamics::response::{PEAK_FLOOR, Peak, Spectrum, respond};
use quell_model::System;

use super::unknown::NoSlowResponse;
use crate::run::response::{NoResidualVibration, ResponseRequest, plan_of};
use crate::study::SystemStudy;

/// Steps by which the dither grows from zero to the base response.
const GROWTH_STEPS: u32 = 8;

/// The response to a dither in the band of the vibration, in numbers of the equations.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SlowResponse {
    /// The residual vibration E.
    pub residual_vibration: f64,
    /// Upper end of the band in which it is measured.
    pub band_end: f64,
    /// The strongest line with the dither, and without it.
    pub tones: [Peak; 2],
}

/// The operating point at which it is largest.
#[derive(Clone, Debug, PartialEq)]
pub struct LargestSlowResponse {
    /// The response.
    pub response: SlowResponse,
    /// The operating point.
    pub point: Vec<f64>,
}

/// The strongest line of a spectrum.
fn strongest(spectrum: &Spectrum) -> Option<Peak> {
    let peaks = spectrum.peaks(PEAK_FLOOR);
    peaks.into_iter().max_by(|a, b| a.amplitude.total_cmp(&b.amplitude))
}

/// The response of a system on its base response.
pub(super) fn found(study: &SystemStudy, system: &System) -> Result<SlowResponse, NoSlowResponse> {
    let plan = plan_of(study, ResponseRequest::default())?;
    let orbit = base_response(system, GROWTH_STEPS)?;
    let start = MotionStart { time: 0.0, state: orbit.state };
    let found = respond(system, &start, &plan)?;
    let residual_vibration = found.residual_vibration.map_err(NoResidualVibration)?;
    let tones = [&found.dithered, &found.undithered].map(|record| strongest(&record.spectrum));
    let [Some(with), Some(without)] = tones else {
        return Err(NoSlowResponse::NoLine);
    };
    Ok(SlowResponse { residual_vibration, band_end: found.band_end, tones: [with, without] })
}
