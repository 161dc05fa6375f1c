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

use super::super::{
    Immobile, MOTION_TOLERANCE, Motion, MotionEnd, MotionEvent, MotionObserver, MotionSegment,
    MotionStart, MotionStopped, RecordedEvent,
};
use super::family::{MotionSignature, shot};
use super::periodic::{MotionOrbit, orbit_at, scale_of};
use crate::simulation::EventKind;

/// Mismatch of two passages, relative to the state, below which Newton's method is tried.
const NEAR: f64 = 2e-2;

/// Passages in a period that are tried.
const MOST_PASSAGES: usize = 8;

/// Mismatch, relative to the state, of a closed cycle.
const CLOSED: f64 = 1e-12;

/// Mismatch, relative to the state, of a cycle after a part of its period that is itself a period.
const PART: f64 = 1e-7;

/// Rate times period, relative to the state, of an equilibrium.
const EQUILIBRIUM: f64 = 1e-7;

/// Number of spans over which a run is watched, each [`SPAN`] times the slowest time scale.
const SPANS: u32 = 60;

/// Spans without a passage after which the section is chosen anew.
const IDLE: u32 = 8;

/// Length of a span over the time scale of the system.
const SPAN: f64 = 200.0;

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
    /// The motion comes to rest, or to steady sliding.
    Rest {
        /// Time at which it was there.
        time: f64,
        /// State there.
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
            Self::NotFound { time, passages, mismatch } => {
                write!(
                    f,
                    "no limit cycle was found: tried a run to t = {time:.6} with {passages} passages through its section"
                )?;
                match mismatch {
                    Some(mismatch) => {
                        write!(
                            f,
                            ", whose states repeat within {mismatch:.1e} of their size at best"
                        )
                    }
                    None => Ok(()),
                }
            }
        }
    }
}

impl std::error::Error for NoCycle {}

/// Watches a run: passages through the section, and states between events.
struct Passages {
    events: Vec<RecordedEvent>,
    /// State in the middle of the longest segment since the last passage, with its time and the segment's length.
    quiet: Vec<(f64, Vec<f64>, f64)>,
    /// Largest and latest rate of the state.
    rates: (f64, f64),
    size: usize,
    contact: Option<usize>,
}

impl Passages {
    fn new(size: usize) -> Self {
        Self {
            events: Vec::new(),
            quiet: vec![(0.0, Vec::new(), 0.0)],
            rates: (0.0, 0.0),
            size,
            contact: None,
        }
    }

    fn pass(&mut self, passage: RecordedEvent) {
        self.events.push(passage);
        self.quiet.push((0.0, Vec::new(), 0.0));
    }
}

impl MotionObserver for Passages {
    fn segment(&mut self, segment: &MotionSegment<'_>) {
        let middle = 0.5 * segment.duration();
        if let Some(quiet) = self.quiet.last_mut()
            && segment.duration() > quiet.2
        {
            let mut state = vec![0.0; self.size];
            segment.state(middle, &mut state);
            *quiet = (segment.clock().time() + middle, state, segment.duration());
        }
        let rates = &segment.states()[self.size..2 * self.size];
        let latest = rates.iter().fold(0.0, |m: f64, rate| m.max(rate.abs()));
        self.rates = (self.rates.0.max(latest), latest);
        if self.contact.is_none() {
            self.least_displacement(segment);
        }
    }

    fn event(&mut self, event: &MotionEvent<'_>) {
        if event.kind != EventKind::Release || self.contact.is_some_and(|c| event.contact > c) {
            return;
        }
        if self.contact != Some(event.contact) {
            // A lower contact that releases: the section of the others no longer counts.
            self.contact = Some(event.contact);
            self.events.clear();
            self.quiet = vec![(0.0, Vec::new(), 0.0)];
        }
        self.pass(event.recorded());
    }
}

impl Passages {
    /// Without a release the section is where the first number of the state is least.
    fn least_displacement(&mut self, segment: &MotionSegment<'_>) {
        let series: Vec<f64> = segment.states().chunks(self.size).map(|order| order[0]).collect();
        let slope = |since: f64| {
            let terms = series.iter().enumerate().skip(1).rev();
            terms.fold(0.0, |sum, (k, c)| sum * since + k as f64 * c)
        };
        let (mut low, mut high) = (0.0, segment.duration());
        if !(slope(low) < 0.0 && slope(high) >= 0.0) {
            return;
        }
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if slope(middle) < 0.0 { low = middle } else { high = middle }
        }
        let mut state = vec![0.0; self.size];
        segment.state(high, &mut state);
        let time = segment.clock().after(high).time();
        self.pass(RecordedEvent {
            time,
            contact: 0,
            kind: EventKind::Release,
            slip_sign: 0,
            state,
        });
    }
}

/// The limit cycle on which a run of an undithered system from a state ends.
///
/// # Errors
/// [`NoCycle`], with what was tried.
pub fn free_cycle(system: &System, start: &[f64]) -> Result<MotionOrbit, NoCycle> {
    if system.inputs.iter().any(|input| !input.profile.waves().is_empty()) {
        return Err(NoCycle::Dithered);
    }
    let motion = Motion::new(system).map_err(NoCycle::Immobile)?;
    let mut passages = Passages::new(motion.size());
    let mut from = MotionStart { time: 0.0, state: start.to_vec() };
    let mut least = None;
    let mut seen = 0;
    let mut idle = 0;
    for span in 1..=SPANS {
        let until = f64::from(span) * SPAN * motion.time_scale();
        let end: MotionEnd =
            motion.run(&from, until, MOTION_TOLERANCE, &mut passages).map_err(NoCycle::Stopped)?;
        let still = STILL * scale_of(&motion, &end.state);
        let is_at_rest = passages.rates.1 <= AT_REST * passages.rates.0
            || passages.rates.1 * motion.time_scale() <= still;
        if is_at_rest {
            return Err(NoCycle::Rest { time: end.time, state: end.state });
        }
        from = end.restart();
        if passages.events.len() == seen {
            idle += 1;
            if idle == IDLE {
                // The releases so far belonged to a transient.
                passages = Passages { rates: passages.rates, ..Passages::new(motion.size()) };
                (seen, idle) = (0, 0);
            }
            continue;
        }
        (seen, idle) = (passages.events.len(), 0);
        if let Some(cycle) = repeated(&motion, &passages, &mut least) {
            return Ok(cycle);
        }
    }
    let passages = passages.events.len();
    Err(NoCycle::NotFound { time: from.time, passages, mismatch: least })
}

/// The cycle near passages that nearly repeat.
fn repeated(
    motion: &Motion<'_>,
    passages: &Passages,
    least: &mut Option<f64>,
) -> Option<MotionOrbit> {
    let all = &passages.events;
    let last = all.last()?;
    let scale = scale_of(motion, &last.state);
    for back in 1..=MOST_PASSAGES.min(all.len().saturating_sub(1)) {
        let before = &all[all.len() - 1 - back];
        let pairs = before.state.iter().zip(&last.state);
        let mismatch = pairs.fold(0.0, |m: f64, (a, b)| m.max((a - b).abs())) / scale;
        *least = Some(least.map_or(mismatch, |known| known.min(mismatch)));
        if mismatch > NEAR {
            continue;
        }
        // The longest quiet interval between the two passages.
        let quiet = &passages.quiet[all.len() - back..all.len()];
        let longest = quiet.iter().max_by(|a, b| a.2.total_cmp(&b.2))?;
        let period = last.time - before.time;
        let closed = close(motion, &longest.1, period, scale);
        if let Some((state, period)) = closed.filter(|closed| moves(motion, closed, scale)) {
            let (state, period) = least_period(motion, (state, period), back, scale);
            return reported(motion, &state, period);
        }
    }
    None
}

/// Whether the state moves: an equilibrium closes after any time, and is no cycle.
fn moves(motion: &Motion<'_>, (state, period): &(Vec<f64>, f64), scale: f64) -> bool {
    rates(motion, state)
        .is_some_and(|rates| rates.iter().any(|rate| rate.abs() * period > EQUILIBRIUM * scale))
}

/// The least period of a cycle closed after several passages.
fn least_period(
    motion: &Motion<'_>,
    (state, period): (Vec<f64>, f64),
    passages: usize,
    scale: f64,
) -> (Vec<f64>, f64) {
    for parts in (2..=passages).rev() {
        let part = period / parts as f64;
        let is_near = shot(motion, &state, part, None).is_ok_and(|(image, _)| {
            image.state.iter().zip(&state).all(|(a, b)| (a - b).abs() <= PART * scale)
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
    for _ in 0..30 {
        let (image, _) = shot(motion, &state, time, None).ok()?;
        let mismatch: Vec<f64> = image.state.iter().zip(&state).map(|(a, b)| a - b).collect();
        let residual = mismatch.iter().fold(0.0, |m: f64, r| m.max(r.abs()));
        if residual <= CLOSED * scale || residual <= 1e-10 * scale && residual > 0.3 * best {
            let is_same = (time - period).abs() < 0.2 * period;
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
        let share = (0.3 * scale
            / step.as_slice()[..n].iter().fold(0.0, |m: f64, s| m.max(s.abs())))
        .min(1.0);
        for (value, step) in state.iter_mut().zip(step.as_slice()) {
            *value += share * step;
        }
        time += share * step.as_slice()[n];
        if !(time > 0.3 * period && time < 3.0 * period) {
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
    motion.run(&start, 1e-6 * motion.time_scale(), MOTION_TOLERANCE, &mut first).ok()?;
    first.0
}

/// The cycle from its section: the first release of the lowest contact that releases, or the least first coordinate.
fn reported(motion: &Motion<'_>, state: &[f64], period: f64) -> Option<MotionOrbit> {
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
    let phases = match &cycle.signature {
        MotionSignature::Steady(phases) => phases.clone(),
        MotionSignature::Events(_) => Vec::new(),
    };
    let order: Vec<_> = cycle.events.iter().map(|e| (e.kind, e.contact, e.slip_sign)).collect();
    cycle.signature = MotionSignature::of(&order, phases);
    Some(cycle)
}
