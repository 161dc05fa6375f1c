//! Passive observers of a system's motion: they receive every smooth segment and every event, and change no bit of the result.

use quell_numerics::dispatch::{Work, with_fused_multiply_add};
use quell_numerics::lane::horner;

use super::contact_series::ContactSeries;
use super::extremes::turning_points;
use super::mass_piece::MassPiece;
use super::phase::{ContactNow, ContactPhase};
use super::rows::RowEntries;
use super::series::horner_states;
use super::state::MotionEnd;
use crate::sample_times::SampleTimes;
use crate::simulation::{Clock, EventKind, ORDER, Series};

/// One smooth piece of a motion: a Taylor step during which no contact changes.
#[derive(Clone, Copy)]
pub struct MotionSegment<'a> {
    pub(super) clock: Clock,
    pub(super) duration: f64,
    pub(super) size: usize,
    pub(super) series: SegmentSeries<'a>,
    pub(super) now: &'a [ContactNow],
}

/// Where the series of a segment are.
#[derive(Clone, Copy)]
pub(super) enum SegmentSeries<'a> {
    /// In the memory of an engine.
    Known { states: &'a [f64], contacts: &'a [ContactSeries], pushes: &'a [Series] },
    /// Of a slipping mass: computed where they are asked for.
    OfMass(&'a MassPiece<'a>),
}

impl<'a> MotionSegment<'a> {
    /// Its start.
    pub fn clock(&self) -> Clock {
        self.clock
    }

    /// Its length.
    pub fn duration(&self) -> f64 {
        self.duration
    }

    /// What a contact does on it.
    pub fn phase(&self, contact: usize) -> ContactPhase {
        self.now[contact].phase
    }

    /// Whether a rigid contact sticks on it, so that its slip velocity is zero.
    #[inline(always)]
    pub(super) fn is_held(&self, contact: usize) -> bool {
        self.now[contact].sticks()
    }

    /// Taylor coefficients of every number of the state, order by order.
    pub fn states(&self) -> &'a [f64] {
        match self.series {
            SegmentSeries::Known { states, .. } => &states[..(ORDER + 1) * self.size],
            SegmentSeries::OfMass(piece) => piece.states(),
        }
    }

    /// All series of a contact.
    pub(super) fn contact(&self, contact: usize) -> &'a ContactSeries {
        match self.series {
            SegmentSeries::Known { contacts, .. } => &contacts[contact],
            SegmentSeries::OfMass(piece) => piece.complete(),
        }
    }

    /// The series of a contact that do not depend on its law: slip and load.
    fn guided(&self, contact: usize) -> &'a ContactSeries {
        match self.series {
            SegmentSeries::Known { contacts, .. } => &contacts[contact],
            SegmentSeries::OfMass(piece) => piece.contact,
        }
    }

    /// Writes the state at time `since` after its start, 0 ≤ `since` ≤ its duration, to `out`.
    pub fn state(&self, since: f64, out: &mut [f64]) {
        with_fused_multiply_add(StateAt { states: self.states(), since, out });
    }

    /// One number of the state at time `since` after its start.
    pub(super) fn number(&self, place: usize, since: f64) -> f64 {
        let mut series = [0.0; ORDER + 1];
        for (coefficient, state) in series.iter_mut().zip(self.states().chunks(self.size)) {
            *coefficient = state[place];
        }
        Self::value(&series, since)
    }

    /// Taylor coefficients of the slip velocity γ of a contact; zero where a rigid contact sticks.
    pub fn slip_velocity(&self, contact: usize) -> &'a [f64; ORDER + 1] {
        &self.guided(contact).slip
    }

    /// Taylor coefficients of the friction force T of a contact; zero where it is open.
    pub fn friction(&self, contact: usize) -> &'a [f64; ORDER + 1] {
        &self.contact(contact).friction
    }

    /// Taylor coefficients of the normal load N of a contact; where it is open those of the load that it would have, which is
    /// negative.
    pub fn normal_load(&self, contact: usize) -> &'a [f64; ORDER + 1] {
        &self.guided(contact).load
    }

    /// Taylor coefficients of a row times the part of the state that begins at `from`: 0 for displacements or the states of
    /// first-order equations, the number of coordinates for velocities.
    pub fn row(&self, row: &[f64], from: usize) -> [f64; ORDER + 1] {
        self.row_of(&RowEntries::at(row, from))
    }

    /// The same for the entries of a row.
    #[inline(always)]
    pub(super) fn row_of(&self, row: &RowEntries) -> Series {
        let mut series = [0.0; ORDER + 1];
        for (coefficient, state) in series.iter_mut().zip(self.states().chunks(self.size)) {
            *coefficient = row.dot(state);
        }
        series
    }

    /// Taylor coefficients of an input that is a force, by its number among these; `None` where the engine does not keep them.
    #[inline(always)]
    pub(super) fn force(&self, push: usize) -> Option<&'a Series> {
        match self.series {
            SegmentSeries::Known { pushes, .. } => pushes.get(push),
            SegmentSeries::OfMass(_) => None,
        }
    }

    /// Times after the start at which the slope of a series on the segment changes its sign, in order; none is missed.
    pub fn turning_points(&self, series: &[f64; ORDER + 1]) -> Vec<f64> {
        let mut found = Vec::new();
        turning_points(series, self.duration, |since| found.push(since));
        found
    }

    /// Value of a series of [`MotionSegment::slip_velocity`] and its neighbours at a time after the start.
    pub fn value(series: &[f64; ORDER + 1], since: f64) -> f64 {
        with_fused_multiply_add(ValueAt { series, since })
    }
}

struct StateAt<'a> {
    states: &'a [f64],
    since: f64,
    out: &'a mut [f64],
}

impl Work for StateAt<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        horner_states(self.states, self.since, self.out);
    }
}

struct ValueAt<'a> {
    series: &'a [f64; ORDER + 1],
    since: f64,
}

impl Work for ValueAt<'_> {
    type Output = f64;

    #[inline(always)]
    fn run(self) -> f64 {
        horner(self.series, self.since)
    }
}

/// An event of a contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MotionEvent<'a> {
    /// Time.
    pub time: f64,
    /// Number of the contact, in the order of the system.
    pub contact: usize,
    /// Kind.
    pub kind: EventKind,
    /// Sign of the slip velocity afterwards; 0 in stick and after a separation.
    pub slip_sign: i8,
    /// Whether friction changes without a jump there (μ_s = μ(0⁺)): a release with zero slip acceleration.
    pub is_smooth: bool,
    /// State.
    pub state: &'a [f64],
}

impl MotionEvent<'_> {
    /// The event with a state of its own.
    pub fn recorded(&self) -> RecordedEvent {
        RecordedEvent {
            time: self.time,
            contact: self.contact,
            kind: self.kind,
            slip_sign: self.slip_sign,
            state: self.state.to_vec(),
        }
    }
}

/// All events of one moment, which are one decision.
#[derive(Clone, Copy)]
pub struct MotionMoment<'a> {
    /// What the contacts do from here on.
    pub after: &'a [ContactPhase],
    /// The guards that reached zero together, each with the rate at which it fell, the first one first.
    pub triggers: &'a [(Trigger, f64)],
    /// Whether the moment is a jump of the dither, which no change of the state moves.
    pub is_jump: bool,
    /// Whether independent guards reached zero together, so that derivatives by the state are one-sided.
    pub is_one_sided: bool,
}

/// The guard that reached zero.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Trigger {
    /// The slip velocity of a contact; of an elastic slider its own speed γ − Ṫ/k_t.
    Slip(usize),
    /// The slip velocity of an elastic slider that goes on sliding.
    Turn(usize),
    /// The margin μ_s N ∓ T of a sticking contact; 1 where T rose to its bound, −1 where it fell to it.
    Margin(usize, i8),
    /// The load of a contact.
    Load(usize),
}

/// Observes the motion of a system.
pub trait MotionObserver {
    /// Called after a segment has been integrated.
    fn segment(&mut self, segment: &MotionSegment<'_>) {
        let _ = segment;
    }

    /// Called for every event, which is at the end of the last segment; events of one moment in the order of contacts.
    fn event(&mut self, event: &MotionEvent<'_>) {
        let _ = event;
    }

    /// Called once for all events of a moment, before them.
    fn moment(&mut self, moment: &MotionMoment<'_>) {
        let _ = moment;
    }

    /// Whether [`MotionObserver::segment`] is to be called. Asked once, at the start of a run.
    fn watches(&self) -> bool {
        true
    }
}

impl MotionObserver for () {
    fn watches(&self) -> bool {
        false
    }
}

impl<A: MotionObserver, B: MotionObserver> MotionObserver for (A, B) {
    fn segment(&mut self, segment: &MotionSegment<'_>) {
        self.0.segment(segment);
        self.1.segment(segment);
    }

    fn event(&mut self, event: &MotionEvent<'_>) {
        self.0.event(event);
        self.1.event(event);
    }

    fn moment(&mut self, moment: &MotionMoment<'_>) {
        self.0.moment(moment);
        self.1.moment(moment);
    }

    fn watches(&self) -> bool {
        self.0.watches() || self.1.watches()
    }
}

impl<A: MotionObserver> MotionObserver for &mut A {
    fn segment(&mut self, segment: &MotionSegment<'_>) {
        (**self).segment(segment);
    }

    fn event(&mut self, event: &MotionEvent<'_>) {
        (**self).event(event);
    }

    fn moment(&mut self, moment: &MotionMoment<'_>) {
        (**self).moment(moment);
    }

    fn watches(&self) -> bool {
        (**self).watches()
    }
}

/// An event with its own state.
#[derive(Clone, Debug, PartialEq)]
pub struct RecordedEvent {
    /// Time.
    pub time: f64,
    /// Number of the contact.
    pub contact: usize,
    /// Kind.
    pub kind: EventKind,
    /// Sign of the slip velocity afterwards; 0 in stick and after a separation.
    pub slip_sign: i8,
    /// State.
    pub state: Vec<f64>,
}

/// Records every event.
#[derive(Clone, Debug, Default)]
pub struct MotionRecorder {
    /// The events, in order.
    pub events: Vec<RecordedEvent>,
}

impl MotionObserver for MotionRecorder {
    fn event(&mut self, event: &MotionEvent<'_>) {
        self.events.push(event.recorded());
    }

    fn watches(&self) -> bool {
        false
    }
}

/// Samples the state at t₀ + nΔ for n = 0, 1, …, or at given times.
#[derive(Clone, Debug)]
pub struct MotionSampler {
    wanted: SampleTimes,
    /// Times of the samples.
    pub times: Vec<f64>,
    /// States, one after the other.
    pub states: Vec<f64>,
    /// What the contacts do, one after the other.
    pub phases: Vec<ContactPhase>,
    /// Slip velocities of the contacts, one after the other; 0 in stick.
    pub slip_velocities: Vec<f64>,
    /// Friction forces of the contacts, one after the other.
    pub friction: Vec<f64>,
    /// Normal loads of the contacts, one after the other; 0 where open.
    pub normal_loads: Vec<f64>,
}

impl MotionSampler {
    /// `count` samples from `first`, `step` apart.
    pub fn new(first: f64, step: f64, count: usize) -> Self {
        Self::of(SampleTimes::Even { first, step, count })
    }

    /// Samples at these times, in ascending order.
    pub fn at(times: Vec<f64>) -> Self {
        Self::of(SampleTimes::Given(times))
    }

    fn of(wanted: SampleTimes) -> Self {
        Self {
            wanted,
            times: Vec::new(),
            states: Vec::new(),
            phases: Vec::new(),
            slip_velocities: Vec::new(),
            friction: Vec::new(),
            normal_loads: Vec::new(),
        }
    }
}

impl MotionSampler {
    /// Adds a sample at the end of a run, beyond those of the grid: its last point may round to just after the end.
    pub fn push_end(&mut self, end: &MotionEnd) {
        self.push(end.time, end);
    }

    /// Completes the samples of a run at given times: those of its last moment are its end, and may round to just after it.
    pub fn finish(&mut self, end: &MotionEnd) {
        let contacts = end.contacts.len();
        while self.times.last() == Some(&end.time) {
            self.times.pop();
            let count = self.times.len();
            self.states.truncate(count * end.state.len());
            self.phases.truncate(count * contacts);
            for values in [&mut self.slip_velocities, &mut self.friction, &mut self.normal_loads] {
                values.truncate(count * contacts);
            }
        }
        while let Some(time) = self.wanted.get(self.times.len()) {
            self.push(time, end);
        }
    }

    fn push(&mut self, time: f64, end: &MotionEnd) {
        self.times.push(time);
        self.states.extend(&end.state);
        for contact in &end.contacts {
            self.phases.push(contact.phase);
            self.slip_velocities.push(contact.slip_velocity);
            self.friction.push(contact.friction);
            self.normal_loads.push(contact.normal_load);
        }
    }
}

impl MotionObserver for MotionSampler {
    fn segment(&mut self, segment: &MotionSegment<'_>) {
        while let Some(time) = self.wanted.get(self.times.len()) {
            let since = segment.clock.until(time);
            if since > segment.duration {
                break;
            }
            let since = since.max(0.0);
            self.times.push(time);
            let from = self.states.len();
            self.states.resize(from + segment.size, 0.0);
            segment.state(since, &mut self.states[from..]);
            for (contact, now) in segment.now.iter().enumerate() {
                self.phases.push(now.phase);
                let slip_velocity = MotionSegment::value(segment.slip_velocity(contact), since);
                self.slip_velocities.push(slip_velocity);
                self.friction.push(MotionSegment::value(segment.friction(contact), since));
                let load = MotionSegment::value(segment.normal_load(contact), since);
                self.normal_loads.push(if now.is_open() { 0.0 } else { load });
            }
        }
    }
}
