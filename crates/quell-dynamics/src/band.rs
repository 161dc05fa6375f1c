//! The band of slow vibration, which contains the self-excited vibration and over which E is measured.

use std::f64::consts::TAU;

use quell_linear::linearised::Linearised;
use quell_linear::pure_slip::period;
use quell_linear::spectrum::{SmallMotion, spectrum};
use quell_model::System;
use quell_model::profile::Wave;

/// Upper end of the band, in ω₀ (2.27). Self-excited vibration is at about the natural frequency, 1, and the band ends below
/// its second harmonic. Lower, vibration would be missed; higher, a slow dither's own response would count as slow vibration.
pub const BAND_END: f64 = 1.9;

/// Least upper end of the band of one mass, in ω₀: self-excited vibration is at about the natural frequency, 1. If the band ended lower, a
/// vibration outside it would be reported as quenched.
pub(crate) const LEAST_BAND_END: f64 = 1.5;

/// Angular frequency of the vibration of a system about steady sliding without dither: of the small motions that oscillate, that which
/// grows fastest or decays slowest, of several that may by their errors the fastest; without steady sliding, of the structure without its contacts. `None` where nothing oscillates.
pub fn vibration_frequency(system: &System) -> Option<f64> {
    let free = system.undithered();
    let bare = || Linearised::new(&System { contacts: Vec::new(), ..free.clone() });
    let linear = Linearised::new(&free).or_else(|_| bare()).ok()?;
    let found = spectrum(&linear, &linear.friction()).ok()?;
    // The fastest growing one is the first.
    found.motions.iter().map(SmallMotion::frequency).find(|frequency| *frequency > 0.0)
}

/// Whether every spectral line of a motion of this period is above the band of the vibration of a system.
pub fn is_above_the_band(system: &System, period: f64) -> bool {
    let lowest = TAU / period;
    vibration_frequency(system).is_some_and(|vibration| lowest > BAND_END * vibration)
}

/// Whether a motion that repeats after a number of dither periods, this time, is quiet, without slow motion of its own: in step with the
/// dither, or with all its spectral lines above the band.
pub(crate) fn is_quiet(system: &System, multiple: u32, period: f64) -> bool {
    multiple == 1 || is_above_the_band(system, period)
}

/// Whether a motion with the period of the dither, common to all of its waves where there is one, may vibrate in the band itself: a run in
/// step with it is then not necessarily quiet.
pub fn dither_reaches_the_band(system: &System) -> bool {
    let lowest = period(system).map_or_else(|| slowest_repetition(system), |period| TAU / period);
    vibration_frequency(system).is_some_and(|vibration| lowest <= BAND_END * vibration)
}

/// Whether a wave by itself repeats in the band or below: it then is a slow vibration itself. Of several fast waves only combinations are
/// slow.
pub fn wave_reaches_the_band(system: &System) -> bool {
    let lowest = slowest_repetition(system);
    vibration_frequency(system).is_some_and(|vibration| lowest <= BAND_END * vibration)
}

fn slowest_repetition(system: &System) -> f64 {
    system.waves().map(Wave::repetition).fold(f64::INFINITY, f64::min)
}
