//! Limit cycles without dither: found from a run, closed by shooting with a free period.
//!
//! A run is watched at a section: the moments at which the lowest contact that releases does so, or, without events, at which the
//! first coordinate is least. When its states repeat nearly, after one or several passages, Newton's method on
//!
//! ```text
//! φ(x, T) = x,    fᵀ(x − x₀) = 0
//! ```
//!
//! closes the cycle from a state between two events, where x₀ → φ(x₀, T) is smooth. The cycle is then reported from the section.

use std::fmt;

use quell_model::System;
use quell_numerics::matrix::Matrix;

use super::approach::ApproachToSliding;
use super::cycle::cycles;
use super::family::{MotionSignature, shot};
use super::passages::Passages;
use super::periodic::{Orbit, orbit_at, scale_of};
use super::recurrence::{COARSE, NEAR, ON_IT, SAME, STAGNANT, distance, nearest_return};
use super::verdict::OrbitVerdict;
use super::watch::{MOST_STEPS, PASSAGES, WatchLengths};
use crate::motion::{
    ContactPhase, Immobile, MOTION_TOLERANCE, Motion, MotionEnd, MotionObserver, MotionSegment,
    MotionStart, MotionStopped,
};

/// Passages in a period that are tried.
const MOST_PASSAGES: usize = 8;

/// Mismatch, relative to the state, of a closed cycle: the tolerance of a step with a margin for the steps of a period.
const CLOSED: f64 = 10.0 * MOTION_TOLERANCE;

/// A step of Newton's method that leaves more than this share of the residual no longer converges.
const SHRINKS: f64 = 0.3;

/// Relative difference of the rates of a state a period apart, on a cycle: closing to [`STAGNANT`] leaves less even in stiff systems. A
/// decay of less than this per period would be taken for a cycle.
const EQUALLY_FAST: f64 = 1e-6;

/// Steps of Newton's method. It converges in five to eight from [`NEAR`](super::recurrence::NEAR) where it does.
const NEWTON_STEPS: u32 = 30;

/// Largest change of the state in a step of Newton's method, relative to the state: beyond it the events of the cycle change.
const LONGEST_STEP: f64 = 0.3;

/// Times of the first run of which a velocity is taken, over the time scale: no motion changes in it.
const MOMENT: f64 = 1e-6;

/// Growth per span of the mismatch at which Newton's method is tried again after a failure, which halves it.
const RELAXED: f64 = 1.5;

/// Spans without a passage after which the section is first chosen anew; then twice as many, and so on.
const IDLE: u32 = 8;

/// Velocity, relative to the fastest so far, below which a motion has come to rest.
const AT_REST: f64 = 1e-9;

/// Rate times time scale, relative to the state and the velocities of the surfaces, of a run that has not moved at all.
const STILL: f64 = 1e-14;

/// Why no limit cycle was found.
#[derive(Clone, Debug, PartialEq)]
pub enum NoCycle {
    /// The system has dither.
    Dithered,
    /// The motion cannot be computed.
    Immobile(Immobile),
    /// The run ended early.
    Stopped(MotionStopped),
    /// The motion comes to rest or to steady sliding, or approaches steady sliding at the rates of the small motions about it.
    Rest {
        /// Time at which that was certain.
        time: f64,
        /// State at rest; that of steady sliding where the run approaches it.
        state: Vec<f64>,
    },
    /// The run did not repeat itself.
    NotFound {
        /// Time over which it was watched.
        time: f64,
        /// Passages through the section.
        passages: usize,
        /// Least mismatch of two passages, relative to the state.
        mismatch: Option<f64>,
        /// Steps of the run.
        steps: u64,
        /// Period of an unstable cycle that the run came near and left, if it did.
        unstable: Option<f64>,
    },
}

impl fmt::Display for NoCycle {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Dithered => f.write_str("a limit cycle is a motion without dither"),
            Self::Immobile(why) => why.fmt(f),
            Self::Stopped(why) => why.fmt(f),
            Self::Rest { time, .. } => {
                write!(
                    f,
                    "no limit cycle was found: by t = {time:.6} the motion has come to rest or to steady sliding"
                )
            }
            Self::NotFound { time, passages, mismatch, steps, unstable } => {
                write!(
                    f,
                    "no limit cycle was found: tried a run to t = {time:.6} of {steps} steps with {passages} passages through \
                     its section"
                )?;
                if let Some(mismatch) = mismatch {
                    write!(f, ", whose states repeat within {mismatch:.1e} of their size at best")?;
                }
                match unstable {
                    Some(period) => {
                        write!(
                            f,
                            "; it came near an unstable cycle of period {period:.6} and left it"
                        )
                    }
                    None => Ok(()),
                }
            }
        }
    }
}

impl std::error::Error for NoCycle {}

/// The limit cycle on which a run of an undithered system from a state ends.
///
/// The run is watched until the slowest motion of the structure has settled and the section has been passed a hundred times, within
/// four million steps. A cycle that is unstable is returned only if the run is on it to 10⁻⁶ of its state.
///
/// # Errors
/// [`NoCycle`], with what was tried.
pub fn free_cycle(system: &System, start: &[f64]) -> Result<Orbit, NoCycle> {
    if system.is_dithered() {
        return Err(NoCycle::Dithered);
    }
    let motion = Motion::new(system).map_err(NoCycle::Immobile)?;
    let lengths = WatchLengths::of(&motion);
    let mut passages = Passages::new(motion.size());
    let mut returns = Returns { allowed: NEAR, least: None, unstable: None };
    let mut approach = ApproachToSliding::of(system);
    let mut from = MotionStart { time: 0.0, state: start.to_vec() };
    let (mut seen, mut passed, mut steps) = (0, 0, 0);
    let (mut idle, mut patience) = (0, IDLE);
    let mut spans = 0_u32;
    loop {
        spans += 1;
        let until = f64::from(spans) * lengths.span;
        let end: MotionEnd =
            motion.run(&from, until, MOTION_TOLERANCE, &mut passages).map_err(NoCycle::Stopped)?;
        steps += end.steps;
        let still = STILL * scale_of(&motion, &end.state);
        let is_at_rest = passages.rates.1 <= AT_REST * passages.rates.0
            || passages.rates.1 * motion.time_scale() <= still;
        if is_at_rest {
            return Err(NoCycle::Rest { time: end.time, state: end.state });
        }
        let has_released = passages.has_released();
        let approached = approach
            .as_mut()
            .and_then(|approach| approach.certain(end.time, &end.state, has_released));
        if let Some(sliding) = approached {
            return Err(NoCycle::Rest { time: end.time, state: sliding });
        }
        from = end.restart();
        let count = passages.events.len();
        if count == seen {
            idle += 1;
            if idle == patience {
                // The releases so far belonged to a transient, or the motion is slower.
                passages.forget();
                (seen, idle, patience) = (0, 0, 2 * patience);
            }
        } else {
            passed += count.saturating_sub(seen);
            (seen, idle) = (count, 0);
            if let Some(cycle) = returns.cycle(&motion, &passages) {
                return Ok(cycle);
            }
        }
        let is_enough = until >= lengths.enough && passed >= PASSAGES;
        if is_enough || until >= lengths.most || steps >= MOST_STEPS {
            let Returns { least: mismatch, unstable, .. } = returns;
            let time = from.time;
            return Err(NoCycle::NotFound { time, passages: passed, mismatch, steps, unstable });
        }
    }
}

/// Every limit cycle of a system of one mass without its dither, stable or not, the largest first, by the map of its sizes
/// ([`cycles`]); `None` of other systems, and where the map cannot be computed.
pub fn limit_cycles(system: &System) -> Option<Vec<Orbit>> {
    let free = system.undithered();
    let mass = free.one_mass()?;
    let motion = Motion::new(&free).ok()?;
    let found = cycles(mass.belt()).ok()?;
    let reported = found.iter().map(|cycle| {
        let period = cycle.period / mass.rate();
        let lowest = mass.state(cycle.state[0], cycle.state[1]).to_vec();
        let start = MotionStart { time: 0.0, state: lowest };
        // Away from the section, which the lowest point may be on.
        let away = motion.run(&start, 0.25 * period, MOTION_TOLERANCE, &mut ()).ok()?;
        reported(&motion, &away.state, period)
    });
    reported.collect()
}

/// The attempts to close a cycle where a run comes back near its own states.
struct Returns {
    /// Mismatch at which Newton's method is tried.
    allowed: f64,
    /// Least mismatch so far.
    least: Option<f64>,
    /// Period of an unstable cycle nearby.
    unstable: Option<f64>,
}

impl Returns {
    /// The cycle near passages that nearly repeat, if the run ends on it.
    fn cycle(&mut self, motion: &Motion<'_>, passages: &Passages) -> Option<Orbit> {
        self.allowed = NEAR.min(RELAXED * self.allowed);
        let (last, before) = passages.events.split_last()?;
        let scale = scale_of(motion, &last.state);
        let earlier = before.iter().rev().take(MOST_PASSAGES);
        let earlier = earlier.map(|passage| passage.state.as_slice());
        let (back, distance) = nearest_return(&last.state, earlier)?;
        let mismatch = distance / scale;
        self.least = Some(self.least.map_or(mismatch, |known| known.min(mismatch)));
        if mismatch > self.allowed {
            return None;
        }
        let found = closed(motion, passages, back, scale);
        self.allowed = 0.5 * mismatch;
        let cycle = found?;
        // On an unstable cycle only a symmetric run remains; others pass it, and end elsewhere.
        if cycle.verdict() != OrbitVerdict::Unstable || mismatch <= ON_IT {
            return Some(cycle);
        }
        self.unstable = Some(cycle.period);
        None
    }
}

/// The cycle near the last passages, which come back after `back` of them.
fn closed(motion: &Motion<'_>, passages: &Passages, back: usize, scale: f64) -> Option<Orbit> {
    let all = &passages.events;
    let first = all.len().checked_sub(back + 1)?;
    // The longest quiet interval of the period.
    let quiet = passages.quiet[first + 1..all.len()].iter();
    let longest = quiet.max_by(|a, b| a.2.total_cmp(&b.2))?;
    let period = all.last()?.time - all[first].time;
    let cycle = close(motion, &longest.1, period, scale)?;
    if !moves(motion, &cycle, scale) {
        return None;
    }
    let (state, period) = least_period(motion, cycle, scale);
    reported(motion, &state, period)
}

/// Whether a closed motion is a cycle: its state moves, and moves equally fast after a period. An equilibrium closes after any
/// time, and a small oscillation that dies out slowly closes within the accuracy that the size of the state allows.
fn moves(motion: &Motion<'_>, (state, period): &(Vec<f64>, f64), scale: f64) -> bool {
    let largest = |values: &[f64]| values.iter().fold(0.0, |m: f64, value| m.max(value.abs()));
    let later = || Some(shot(motion, state, *period, None).ok()?.0.state);
    let Some((before, after)) =
        rates(motion, state).zip(later().and_then(|later| rates(motion, &later)))
    else {
        return false;
    };
    let size = largest(&before);
    size * period > COARSE * scale && distance(&before, &after) <= EQUALLY_FAST * size
}

/// The least period of a closed cycle. It passes its section equally often in each part, however often the run passed it on its way
/// there.
fn least_period(
    motion: &Motion<'_>,
    (state, period): (Vec<f64>, f64),
    scale: f64,
) -> (Vec<f64>, f64) {
    let mut section = Passages::new(motion.size());
    let start = MotionStart { time: 0.0, state: state.clone() };
    if motion.run(&start, period, MOTION_TOLERANCE, &mut section).is_err() {
        return (state, period);
    }
    let passages = section.events.len();
    for parts in (2..=passages).rev().filter(|parts| passages.is_multiple_of(*parts)) {
        let part = period / parts as f64;
        let is_near = shot(motion, &state, part, None).is_ok_and(|(image, _)| {
            image.state.iter().zip(&state).all(|(a, b)| (a - b).abs() <= COARSE * scale)
        });
        if is_near && let Some(found) = close(motion, &state, part, scale) {
            return found;
        }
    }
    (state, period)
}

/// Newton's method for state and period.
fn close(motion: &Motion<'_>, guess: &[f64], period: f64, scale: f64) -> Option<(Vec<f64>, f64)> {
    let n = guess.len();
    let (mut state, mut time) = (guess.to_vec(), period);
    let mut best = f64::INFINITY;
    for _ in 0..NEWTON_STEPS {
        let (image, _) = shot(motion, &state, time, None).ok()?;
        let mismatch: Vec<f64> = image.state.iter().zip(&state).map(|(a, b)| a - b).collect();
        let residual = mismatch.iter().fold(0.0, |m: f64, r| m.max(r.abs()));
        let is_stagnant = residual <= STAGNANT * scale && residual > SHRINKS * best;
        if residual <= CLOSED * scale || is_stagnant {
            let is_same =
                (time - period).abs() < SAME * period && distance(&state, guess) <= SAME * scale;
            return is_same.then_some((state, time));
        }
        best = best.min(residual);
        let first = rates(motion, &state)?;
        let last = rates(motion, &image.state)?;
        let size = first.iter().map(|f| f * f).sum::<f64>().max(f64::MIN_POSITIVE);
        let system = Matrix::from_fn(n + 1, n + 1, |i, j| match (i == n, j == n) {
            (false, false) => image.derivative[(i, j)] - f64::from(u8::from(i == j)),
            (false, true) => last[i],
            (true, false) => first[j] / libm::sqrt(size),
            (true, true) => 0.0,
        });
        let right = Matrix::from_fn(n + 1, 1, |i, _| if i < n { -mismatch[i] } else { 0.0 });
        let step = system.solve(&right).filter(Matrix::is_finite)?;
        let share = (LONGEST_STEP * scale
            / step.as_slice()[..n].iter().fold(0.0, |m: f64, s| m.max(s.abs())))
        .min(1.0);
        for (value, step) in state.iter_mut().zip(step.as_slice()) {
            *value += share * step;
        }
        time += share * step.as_slice()[n];
        // The cycle would not be the one that the run repeats.
        if (time - period).abs() > 2.0 * SAME * period {
            return None;
        }
    }
    None
}

/// ẋ at a state.
fn rates(motion: &Motion<'_>, state: &[f64]) -> Option<Vec<f64>> {
    #[derive(Default)]
    struct First(Option<Vec<f64>>, usize);
    impl MotionObserver for First {
        fn segment(&mut self, segment: &MotionSegment<'_>) {
            let size = self.1;
            self.0.get_or_insert_with(|| segment.states()[size..2 * size].to_vec());
        }
    }
    let mut first = First(None, state.len());
    let start = MotionStart { time: 0.0, state: state.to_vec() };
    motion.run(&start, MOMENT * motion.time_scale(), MOTION_TOLERANCE, &mut first).ok()?;
    first.0
}

/// The cycle from its section: the first release of the lowest contact that releases, or the least first coordinate.
fn reported(motion: &Motion<'_>, state: &[f64], period: f64) -> Option<Orbit> {
    let mut cycle = orbit_at(motion, state, period, true).ok()?;
    let mut passages = Passages::new(state.len());
    let start = MotionStart { time: 0.0, state: state.to_vec() };
    motion.run(&start, period, MOTION_TOLERANCE, &mut passages).ok()?;
    let begin = passages.events.first()?.clone();
    let moved = |time: f64| if time < begin.time { time + period } else { time };
    for event in &mut cycle.events {
        event.time = moved(event.time) - begin.time;
    }
    cycle.events.sort_by(|a, b| a.time.total_cmp(&b.time).then(a.contact.cmp(&b.contact)));
    cycle.state = begin.state;
    let before = &cycle.signature;
    // A contact with events has no phase of its own throughout, and its place is not read.
    let phase = |contact: usize| before.throughout(contact).unwrap_or(ContactPhase::Stick);
    let phases = (0..motion.system().contacts.len()).map(phase).collect();
    let order: Vec<_> = cycle.events.iter().map(|e| (e.kind, e.contact, e.slip_sign)).collect();
    cycle.signature = MotionSignature::of(&order, phases);
    Some(cycle)
}
