//! The periodic motion on which a run ends.

use quell_model::System;

use super::super::{MOTION_TOLERANCE, Motion, MotionStart};
use super::family::{NoImage, shot, time_of};
use super::periodic::{MotionOrbit, NoMotionOrbit, motion_near, scale_of};
use super::recurrence::{COARSE, NEAR, SAME, distance, nearest_return};
use crate::orbit::OrbitVerdict;

/// Common periods within which a run must settle, where its caller has no reason for another number: `orbit` and `response` thus give
/// one verdict on one run.
pub const MOST_PERIODS: u32 = 4000;

/// Common periods in a motion's own period that are tried.
const MOST_MULTIPLES: usize = 12;

/// Share of its earlier distance to which a run must come nearer to the orbit on which it ends. Slower runs are given more periods.
const NEARER: f64 = 0.9;

/// States kept of a run that does not settle.
const KEPT: usize = 100;

/// Periods before the first attempt, and between attempts at first.
const FIRST_ATTEMPT: u32 = 8;

/// Attempts are repeated after this part of the periods so far: their number grows with the logarithm of the run's length.
const ATTEMPTS_APART: u32 = 3;

/// Where a run ends.
#[derive(Clone, Debug)]
pub struct SettledMotion {
    /// The periodic motion.
    pub orbit: MotionOrbit,
    /// Common dither periods in its period.
    pub multiple: u32,
    /// Common dither periods that the run took to reach its neighbourhood.
    pub periods: u32,
}

/// The periodic motion on which a run from a state at t = 0 ends, within `most` common periods.
///
/// The run goes on until its states repeat nearly, after one or several periods; then Newton's method closes the orbit. An orbit
/// that is unstable, or far from the run, is not where it ends, and the run goes on.
///
/// # Errors
/// [`NoMotionOrbit::Unsettled`] where no such orbit is found.
pub fn settled(system: &System, start: &[f64], most: u32) -> Result<SettledMotion, NoMotionOrbit> {
    let motion = Motion::new(system).map_err(NoMotionOrbit::Immobile)?;
    let period = time_of(&motion, 1).map_err(NoMotionOrbit::NoImage)?;
    let mut states = vec![start.to_vec()];
    let mut from = MotionStart { time: 0.0, state: start.to_vec() };
    let mut next_try = FIRST_ATTEMPT;
    for count in 1..=most {
        let until = f64::from(count) * period;
        let end = motion
            .run(&from, until, MOTION_TOLERANCE, &mut ())
            .map_err(|why| NoMotionOrbit::NoImage(NoImage::Stopped(why)))?;
        from = end.restart();
        states.push(end.state);
        if count < next_try {
            continue;
        }
        if let Some((orbit, multiple)) = closed(system, &motion, &states) {
            return Ok(SettledMotion { orbit, multiple, periods: count });
        }
        next_try = count + (count / ATTEMPTS_APART).max(FIRST_ATTEMPT);
    }
    let last = states.split_off(states.len().saturating_sub(KEPT));
    Err(NoMotionOrbit::Unsettled { periods: most, last })
}

/// A stable orbit near the last states.
fn closed(system: &System, motion: &Motion<'_>, states: &[Vec<f64>]) -> Option<(MotionOrbit, u32)> {
    let last = states.last()?;
    let scale = scale_of(motion, last);
    let earlier = states.iter().rev().skip(1).take(MOST_MULTIPLES);
    let (multiple, mismatch) = nearest_return(last, earlier.map(Vec::as_slice))?;
    if mismatch > SAME * scale {
        return None;
    }
    let count = u32::try_from(multiple).ok()?;
    let orbit = motion_near(system, last, count).ok()?;
    let (orbit, count) = of_least_period(system, motion, orbit, count, scale);
    let is_near = distance(&orbit.state, last) <= SAME * scale
        && (mismatch <= NEAR * scale || approaches(states, &orbit.state, multiple));
    (is_near && orbit.verdict() == OrbitVerdict::Stable).then_some((orbit, count))
}

/// An orbit with the least number of periods after which it closes.
fn of_least_period(
    system: &System,
    motion: &Motion<'_>,
    orbit: MotionOrbit,
    count: u32,
    scale: f64,
) -> (MotionOrbit, u32) {
    for part in (1..count).filter(|part| count.is_multiple_of(*part)) {
        let time = f64::from(part) * orbit.period / f64::from(count);
        let closes = shot(motion, &orbit.state, time, None)
            .is_ok_and(|(image, _)| distance(&image.state, &orbit.state) <= COARSE * scale);
        if closes && let Ok(shorter) = motion_near(system, &orbit.state, part) {
            return (shorter, part);
        }
    }
    (orbit, count)
}

/// Whether a run comes nearer to an orbit of `multiple` periods: its largest distance over the last third of the states is less than
/// over the third before. A run that circles about an orbit at a constant distance ends on another motion.
fn approaches(states: &[Vec<f64>], orbit: &[f64], multiple: usize) -> bool {
    let distances = states.iter().rev().step_by(multiple).map(|state| distance(state, orbit));
    let distances: Vec<f64> = distances.collect();
    let third = distances.len() / 3;
    let largest = |part: &[f64]| part.iter().fold(0.0, |most: f64, value| most.max(*value));
    third > 0 && largest(&distances[..third]) < NEARER * largest(&distances[third..2 * third])
}
