//! What a run keeps while it is integrated: events, their counts, and the intervals of stick and separation.

use quell_dynamics::motion::{
    ContactPhase, MotionEvent, MotionObserver, MotionSegment, RecordedEvent,
};
use quell_dynamics::simulation::EventKind;

/// Kinds of events, in the order of their counts and codes.
pub const KINDS: [EventKind; 5] = [
    EventKind::Stick,
    EventKind::Release,
    EventKind::Reversal,
    EventKind::Separation,
    EventKind::Landing,
];

/// Largest number of numbers in the states of the events kept, about 160 megabytes.
const MOST_NUMBERS: usize = 20_000_000;

/// The place of a kind in [`KINDS`].
pub(super) fn code(kind: EventKind) -> u8 {
    KINDS.iter().zip(0..).find(|(known, _)| **known == kind).map_or(0, |(_, code)| code)
}

/// An interval in which a contact sticks or is open.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PhaseInterval {
    /// [`ContactPhase::Stick`] or [`ContactPhase::Open`].
    pub phase: ContactPhase,
    /// Its start.
    pub from: f64,
    /// Its end.
    pub to: f64,
}

/// Events and intervals of a run.
#[derive(Clone, Debug, Default)]
pub struct EventHistory {
    /// The first events, in order; all of them unless [`EventHistory::lost`].
    pub events: Vec<RecordedEvent>,
    /// Number of events of each contact, kind by kind.
    pub counts: Vec<[u64; KINDS.len()]>,
    /// Number of events that were not kept.
    pub lost: u64,
    /// Intervals of stick and separation of each contact.
    pub intervals: Vec<Vec<PhaseInterval>>,
    most: usize,
    keeps_intervals: bool,
}

impl EventHistory {
    /// For a run with so many contacts and numbers in its state.
    pub(super) fn new(contacts: usize, size: usize, keeps_intervals: bool) -> Self {
        Self {
            counts: vec![[0; KINDS.len()]; contacts],
            intervals: vec![Vec::new(); contacts],
            most: MOST_NUMBERS / size.max(1),
            keeps_intervals,
            ..Self::default()
        }
    }
}

impl MotionObserver for EventHistory {
    fn segment(&mut self, segment: &MotionSegment<'_>) {
        if !self.keeps_intervals {
            return;
        }
        let from = segment.clock().time();
        let to = segment.clock().after(segment.duration()).time();
        for (contact, intervals) in self.intervals.iter_mut().enumerate() {
            let phase = segment.phase(contact);
            match intervals.last_mut() {
                _ if matches!(phase, ContactPhase::Slip(_)) => {}
                Some(last) if last.to == from && last.phase == phase => last.to = to,
                _ => intervals.push(PhaseInterval { phase, from, to }),
            }
        }
    }

    fn event(&mut self, event: &MotionEvent<'_>) {
        self.counts[event.contact][usize::from(code(event.kind))] += 1;
        if self.events.len() >= self.most {
            self.lost += 1;
            return;
        }
        self.events.push(event.recorded());
    }

    fn watches(&self) -> bool {
        self.keeps_intervals
    }
}
