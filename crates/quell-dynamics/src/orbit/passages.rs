//! The section of a limit cycle: the moments at which the lowest contact that releases does so, or, without releases, at which the
//! first number of the state is least.

use quell_numerics::polynomial::derivative;

use crate::motion::{MotionEvent, MotionObserver, MotionSegment, RecordedEvent};
use crate::simulation::EventKind;

/// Watches a run: passages through the section, and states between events.
pub(super) struct Passages {
    pub(super) events: Vec<RecordedEvent>,
    /// State in the middle of the longest segment since the last passage, with its time and the segment's length.
    pub(super) quiet: Vec<(f64, Vec<f64>, f64)>,
    /// Largest and latest rate of the state.
    pub(super) rates: (f64, f64),
    size: usize,
    contact: Option<usize>,
}

impl Passages {
    pub(super) fn new(size: usize) -> Self {
        Self {
            events: Vec::new(),
            quiet: vec![(0.0, Vec::new(), 0.0)],
            rates: (0.0, 0.0),
            size,
            contact: None,
        }
    }

    /// Whether a contact has released since the section was chosen.
    pub(super) fn has_released(&self) -> bool {
        self.contact.is_some()
    }

    /// Forgets the section and its passages, not how fast the motion was.
    pub(super) fn forget(&mut self) {
        *self = Self { rates: self.rates, ..Self::new(self.size) };
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
        let series = segment.row(&[1.0], 0);
        let curvature = derivative(&derivative(&series));
        for since in segment.turning_points(&series) {
            if MotionSegment::value(&curvature, since) > 0.0 {
                self.pass_at(segment, since);
            }
        }
    }

    fn pass_at(&mut self, segment: &MotionSegment<'_>, since: f64) {
        let mut state = vec![0.0; self.size];
        segment.state(since, &mut state);
        let time = segment.clock().after(since).time();
        self.pass(RecordedEvent {
            time,
            contact: 0,
            kind: EventKind::Release,
            slip_sign: 0,
            state,
        });
    }
}
