//! A run whose dither grows from zero.

use quell_model::System;

use super::family::NoImage;
use super::periodic::{NoOrbit, period_of};
use crate::motion::{MOTION_TOLERANCE, Motion, MotionStart};

/// The state of a run after its dither has grown from zero over a time `over`, in equal steps, one per common period (at least
/// one); the phase of the dither is continuous across steps. `over` = 0 means no ramp.
///
/// # Errors
/// [`NoOrbit`]: no common period, or the run stopped.
pub fn ramped_motion(system: &System, start: &[f64], over: f64) -> Result<Vec<f64>, NoOrbit> {
    if over <= 0.0 {
        return Ok(start.to_vec());
    }
    let whole = Motion::new(system).map_err(NoOrbit::Immobile)?;
    let period = period_of(&whole, 1)?;
    let count = (over / period).ceil().max(1.0);
    let mut from = MotionStart { time: 0.0, state: start.to_vec() };
    let mut number = 0.0;
    while number < count {
        let step = system.with_amplitudes_scaled((number + 0.5) / count);
        let motion = Motion::new(&step).map_err(NoOrbit::Immobile)?;
        number += 1.0;
        let end = motion
            .run(&from, number * period, MOTION_TOLERANCE, &mut ())
            .map_err(|why| NoOrbit::NoImage(NoImage::Stopped(why)))?;
        from = end.restart();
    }
    Ok(from.state)
}
