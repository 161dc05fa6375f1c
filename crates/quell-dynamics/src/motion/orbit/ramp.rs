//! A run whose dither grows from zero.

use quell_model::System;

use super::super::{MOTION_TOLERANCE, Motion, MotionStart};
use super::family::NoImage;
use super::periodic::{NoMotionOrbit, period_of};

/// The state of a run after its dither has grown from zero over a time `over`, in equal steps, one per common period (at least
/// one); the phase of the dither is continuous across steps. `over` = 0 means no ramp.
///
/// # Errors
/// [`NoMotionOrbit`]: no common period, or the run stopped.
pub fn ramped_motion(system: &System, start: &[f64], over: f64) -> Result<Vec<f64>, NoMotionOrbit> {
    if over <= 0.0 {
        return Ok(start.to_vec());
    }
    let whole = Motion::new(system).map_err(NoMotionOrbit::Immobile)?;
    let period = period_of(&whole, 1)?;
    let count = (over / period).ceil().max(1.0);
    let mut from = MotionStart { time: 0.0, state: start.to_vec() };
    let mut number = 0.0;
    while number < count {
        let step = system.with_amplitudes_scaled((number + 0.5) / count);
        let motion = Motion::new(&step).map_err(NoMotionOrbit::Immobile)?;
        number += 1.0;
        let end = motion
            .run(&from, number * period, MOTION_TOLERANCE, &mut ())
            .map_err(|why| NoMotionOrbit::NoImage(NoImage::Stopped(why)))?;
        from = end.restart();
    }
    Ok(from.state)
}
