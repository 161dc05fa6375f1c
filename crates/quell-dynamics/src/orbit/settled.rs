//! The periodic motion on which a run ends.
//!
//! A run is watched at whole common periods of its dithers. Where its states come back, Newton's method closes a periodic motion
//! there. That alone does not show where the run ends: near a slowly attracting motion the states come back after any number of
//! periods, and next to the motion of the run there may be another stable one. So
//!
//! 1. the motion is reduced to its least period, and
//! 2. the run goes on, and must reach the motion, or approach it at the rate of the motion's multipliers in two windows
//!    one after the other. If it does neither, it goes on.
//!
//! A run that settles on no such motion within [`LEAST_PERIODS`] and no longer changes is on a motion that does not repeat itself. One that
//! still changes goes on up to [`MOST_PERIODS`]; where it ends is unknown then.

use num_complex::Complex64;
use quell_model::System;
use quell_numerics::eigen::Decomposition;
use quell_numerics::polar::modulus;

use super::family::{NoImage, shot, time_of};
use super::periodic::{NoOrbit, Orbit, near, orbit_at, scale_of};
use super::recurrence::{NEAR, ON_IT, SAME, distance, returns};
use super::transient;
use super::verdict::OrbitVerdict;
use crate::band::is_quiet;
use crate::decay::decays_at;
use crate::motion::{
    MOTION_TOLERANCE, Motion, MotionStart, MotionStopped, PlannedMotion, run_many,
};

/// Common periods after which a run that no longer changes counts as one that does not repeat itself. Next to a border between basins
/// of attraction a run dwells at an unstable motion first, the longer the nearer the border: 5000 periods at a relative distance of
/// 2·10⁻⁵ from the border of the dissertation's figure 2.10. A larger number costs time on every motion that does not repeat.
pub const LEAST_PERIODS: u32 = 7000;

/// Common periods after which a run that still changes is given up: a transient that decays by a thousandth per period has long ended.
pub const MOST_PERIODS: u32 = 20_000;

/// Common periods in a motion's own period that are tried, as for the belt: a longer one is not distinguished from a motion that
/// does not repeat.
const MOST_MULTIPLES: usize = 200;

/// States kept of a run that does not settle.
const KEPT: usize = 100;

/// Periods before the first attempt, and between attempts at first. A transient needs a few; more only take longer, and an attempt too
/// early costs one Newton iteration.
const FIRST_ATTEMPT: u32 = 8;

/// Attempts are repeated after this part of the periods so far: their number grows with the logarithm of the run's length.
const ATTEMPTS_APART: u32 = 3;

/// Numbers of periods for which Newton's method is tried in one attempt, the nearest return first, then the shortest. More of
/// them only cost time on motions that do not repeat.
const MOST_SHOTS: usize = 3;

/// Distance, relative to the state, within which a state repeats itself to rounding: on a motion with a multiplier of 1, such as rest
/// in friction, a run that repeats itself to rounding is on it.
const REPEATS: f64 = 1e-10;

/// Own periods of the motion in a window over which the approach is measured. In a shorter one a motion that passes by could shrink
/// at the rate by chance; a longer one only takes longer.
const WINDOW: u32 = 16;

/// Mismatch after a part of the period, relative to the state, of a motion that repeats after that part: far above the error of a
/// closed motion, which is 10⁻¹² times its multipliers. Where a longer motion passes its own state nearer than this after a part, as
/// next to a period doubling, the shorter one is tried, and taken only if it closes and the run approaches it.
const PART: f64 = 1e-8;

/// Where a run ends.
#[derive(Clone, Debug)]
pub struct SettledMotion {
    /// The periodic motion.
    pub orbit: Orbit,
    /// Common dither periods in its period.
    pub multiple: u32,
    /// Common dither periods that the run took to reach its neighbourhood: it then is near the state of the orbit.
    pub periods: u32,
}

impl SettledMotion {
    /// Whether it is quiet, without slow motion of its own.
    pub fn is_quiet(&self, system: &System) -> bool {
        is_quiet(system, self.multiple, self.orbit.period)
    }
}

/// The periodic motion on which a run from a state at t = 0 ends. Verbs ask [`orbit_of_run`](crate::attractor::orbit_of_run), which
/// judges one mass by more than its returns.
///
/// # Errors
/// [`NoOrbit::Unsettled`] where no such motion is found.
pub fn settled(system: &System, start: &[f64]) -> Result<SettledMotion, NoOrbit> {
    let motion = Motion::new(system).map_err(NoOrbit::Immobile)?;
    let mut search = EndSearch::new(&motion, start)?;
    loop {
        search.run.go_to(search.next)?;
        if let Some(end) = search.judged()? {
            return end;
        }
    }
}

/// [`settled`] of several starts of one system, whose runs go on side by side, with the same bits as alone.
///
/// # Errors
/// Those of [`settled`], of each start.
pub fn settled_many(system: &System, starts: &[Vec<f64>]) -> Vec<Result<SettledMotion, NoOrbit>> {
    let motion = match Motion::new(system) {
        Ok(motion) => motion,
        Err(why) => {
            return starts.iter().map(|_| Err(NoOrbit::Immobile(why.clone()))).collect();
        }
    };
    let mut ends: Vec<Option<Result<SettledMotion, NoOrbit>>> = Vec::new();
    ends.resize_with(starts.len(), || None);
    let mut searches: Vec<(usize, EndSearch<'_, '_>)> = Vec::new();
    for (place, start) in starts.iter().enumerate() {
        match EndSearch::new(&motion, start) {
            Ok(search) => searches.push((place, search)),
            Err(why) => ends[place] = Some(Err(why)),
        }
    }
    while !searches.is_empty() {
        let mut stopped = go_on_side_by_side(&mut searches);
        searches.retain_mut(|(place, search)| {
            let end = match stopped.iter_mut().find(|(other, _)| other == place) {
                Some((_, why)) => Some(Err(NoOrbit::NoImage(NoImage::Stopped(why.clone())))),
                None => search.judged().unwrap_or_else(|why| Some(Err(why))),
            };
            let goes_on = end.is_none();
            ends[*place] = end;
            goes_on
        });
    }
    // Every search has ended.
    ends.into_iter().flatten().collect()
}

/// Continues every run to the period at which it is judged next, period by period; the runs that stopped on the way.
fn go_on_side_by_side(searches: &mut [(usize, EndSearch<'_, '_>)]) -> Vec<(usize, MotionStopped)> {
    let mut stopped: Vec<(usize, MotionStopped)> = Vec::new();
    loop {
        let mut going: Vec<&mut (usize, EndSearch<'_, '_>)> = searches
            .iter_mut()
            .filter(|(place, search)| {
                search.run.periods() < search.next
                    && stopped.iter().all(|(other, _)| other != place)
            })
            .collect();
        if going.is_empty() {
            return stopped;
        }
        let mut unobserved = vec![(); going.len()];
        let planned = going.iter().zip(&mut unobserved).map(|((_, search), observer)| {
            let run = &search.run;
            let start = MotionStart { time: run.time(), state: run.last().to_vec() };
            let until = f64::from(run.periods() + 1) * run.period;
            PlannedMotion { motion: run.motion, start, until, observer }
        });
        let found = run_many(planned.collect(), MOTION_TOLERANCE);
        for ((place, search), end) in going.iter_mut().zip(found) {
            match end {
                Ok(end) => search.run.states.push(end.state),
                Err(why) => stopped.push((*place, why)),
            }
        }
    }
}

/// A run that is judged again and again until it is known where it ends.
struct EndSearch<'a, 's> {
    run: Strobed<'a, 's>,
    /// Period at which it is judged next.
    next: u32,
}

impl<'a, 's> EndSearch<'a, 's> {
    fn new(motion: &'a Motion<'s>, start: &[f64]) -> Result<Self, NoOrbit> {
        let period = time_of(motion, 1).map_err(NoOrbit::NoImage)?;
        Ok(Self {
            run: Strobed { motion, period, states: vec![start.to_vec()] },
            next: FIRST_ATTEMPT,
        })
    }

    /// Where the run ends, if that is certain at the period it has reached, or that it is given up.
    fn judged(&mut self) -> Result<Option<Result<SettledMotion, NoOrbit>>, NoOrbit> {
        if let Some(found) = self.run.ends_on()? {
            return Ok(Some(Ok(found)));
        }
        let periods = self.run.periods();
        let is_steady = periods >= LEAST_PERIODS && transient::is_steady(&self.run.states);
        if is_steady || periods >= MOST_PERIODS {
            let states = &mut self.run.states;
            let last = states.split_off(states.len().saturating_sub(KEPT));
            return Ok(Some(Err(NoOrbit::Unsettled { periods, last, is_steady })));
        }
        // A look is taken at the least number of periods exactly.
        let milestone = if periods < LEAST_PERIODS { LEAST_PERIODS } else { MOST_PERIODS };
        self.next = (periods + (periods / ATTEMPTS_APART).max(FIRST_ATTEMPT)).min(milestone);
        Ok(None)
    }
}

/// A run and its states at whole periods, from t = 0 on.
struct Strobed<'a, 's> {
    motion: &'a Motion<'s>,
    period: f64,
    states: Vec<Vec<f64>>,
}

impl Strobed<'_, '_> {
    /// Periods so far.
    fn periods(&self) -> u32 {
        u32::try_from(self.states.len() - 1).unwrap_or(u32::MAX)
    }

    fn last(&self) -> &[f64] {
        self.states.last().map_or(&[], Vec::as_slice)
    }

    /// Time of the last state.
    fn time(&self) -> f64 {
        f64::from(self.periods()) * self.period
    }

    /// Continues to a number of periods.
    fn go_to(&mut self, periods: u32) -> Result<(), NoOrbit> {
        let mut from = MotionStart { time: self.time(), state: self.last().to_vec() };
        for count in self.periods() + 1..=periods {
            let until = f64::from(count) * self.period;
            let end = self.motion.run(&from, until, MOTION_TOLERANCE, &mut ());
            let end = end.map_err(|why| NoOrbit::NoImage(NoImage::Stopped(why)))?;
            from = end.restart();
            self.states.push(end.state);
        }
        Ok(())
    }

    /// The motion near the last states on which the run ends. Looking for it continues the run.
    fn ends_on(&mut self) -> Result<Option<SettledMotion>, NoOrbit> {
        let scale = scale_of(self.motion, self.last());
        let earlier = self.states.iter().rev().skip(1).take(MOST_MULTIPLES);
        let found = returns(self.last(), earlier.map(Vec::as_slice));
        let near = found.into_iter().filter(|(_, mismatch)| *mismatch <= NEAR * scale);
        let mut near: Vec<(usize, f64)> = near.collect();
        let nearest = near.pop();
        near.truncate(MOST_SHOTS - 1);
        let near = nearest.into_iter().chain(near);
        for (multiple, mismatch) in near {
            let Ok(multiple) = u32::try_from(multiple) else { continue };
            let (guess, periods) = (self.last().to_vec(), self.periods());
            let Some((orbit, multiple)) = self.closed(&guess, multiple, mismatch, scale) else {
                continue;
            };
            if self.approaches(&orbit, multiple, scale)? {
                return Ok(Some(SettledMotion { orbit, multiple, periods }));
            }
        }
        Ok(None)
    }

    /// The motion near a state that comes back after a number of periods, with its least number of periods.
    fn closed(
        &self,
        guess: &[f64],
        multiple: u32,
        mismatch: f64,
        scale: f64,
    ) -> Option<(Orbit, u32)> {
        let system = self.motion.system();
        let near = |guess: &[f64], multiple| {
            let orbit = near(system, guess, multiple).ok()?;
            (distance(&orbit.state, guess) <= SAME * scale).then_some(orbit)
        };
        let found = near(guess, multiple).or_else(|| {
            // Newton's method fails where states next to the motion repeat themselves too.
            let time = f64::from(multiple) * self.period;
            let repeats = mismatch <= REPEATS * scale;
            repeats.then(|| orbit_at(self.motion, guess, time, false).ok()).flatten()
        })?;
        let parts = (1..multiple).filter(|part| multiple.is_multiple_of(*part));
        for part in parts {
            let until = f64::from(part) * self.period;
            let start = MotionStart { time: 0.0, state: found.state.clone() };
            let end = self.motion.run(&start, until, MOTION_TOLERANCE, &mut ()).ok()?;
            if distance(&end.state, &found.state) <= PART * scale
                && let Some(shorter) = near(&found.state, part)
            {
                return Some((shorter, part));
            }
        }
        Some((found, multiple))
    }

    /// Whether the run, which goes on, reaches a motion near its last state, or approaches it at the rate of its multipliers.
    fn approaches(&mut self, orbit: &Orbit, multiple: u32, scale: f64) -> Result<bool, NoOrbit> {
        let is_stable = match orbit.verdict() {
            OrbitVerdict::Stable => true,
            OrbitVerdict::Unstable => return Ok(false),
            OrbitVerdict::Undecided => false,
        };
        let slowest = slowest_direction(self.motion, orbit);
        let expected = libm::log(orbit.radius());
        // Size of the slowest part at the start of the window.
        let mut before = None;
        let mut agreed = 0;
        for place in 0..=2 * WINDOW {
            let off: Vec<f64> = self.last().iter().zip(&orbit.state).map(|(a, b)| a - b).collect();
            let distance = off.iter().fold(0.0, |m: f64, d| m.max(d.abs()));
            if is_stable && distance <= ON_IT * scale {
                return Ok(true);
            }
            if !is_stable && distance > REPEATS * scale {
                return Ok(false);
            }
            if is_stable && place % WINDOW == 0 {
                let Some(slowest) = &slowest else { return Ok(false) };
                let now = modulus(slowest.iter().zip(&off).map(|(y, d)| y * d).sum());
                if let Some(before) = before {
                    let measured = libm::log(now / before) / f64::from(WINDOW);
                    if !decays_at(measured, expected) {
                        return Ok(false);
                    }
                    agreed += 1;
                }
                before = Some(now);
            }
            if place < 2 * WINDOW {
                self.go_to(self.periods() + multiple)?;
            }
        }
        Ok(!is_stable || agreed == 2)
    }
}

/// The left vector of the largest multiplier: the product with it of the distance from the motion shrinks by that multiplier in each
/// period, without the fluctuation that the other multipliers and a rotation cause in the distance itself.
fn slowest_direction(motion: &Motion<'_>, orbit: &Orbit) -> Option<Vec<Complex64>> {
    let (image, _) = shot(motion, &orbit.state, orbit.period, None).ok()?;
    let decomposition = Decomposition::new(&image.derivative).ok()?;
    let values = decomposition.values();
    let largest =
        (0..values.len()).max_by(|a, b| modulus(values[*a]).total_cmp(&modulus(values[*b])))?;
    let pair = decomposition.pair(largest);
    pair.condition.is_finite().then_some(pair.left)
}
