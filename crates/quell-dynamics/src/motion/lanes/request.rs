//! What a run side by side with others is computed from.

use super::super::Motion;
use super::super::engine::MotionRun;
use super::super::observer::MotionObserver;
use super::super::state::{MotionEnd, MotionStart};
use super::super::stopped::MotionStopped;

/// A run of a system, to be computed side by side with others.
pub struct PlannedMotion<'a> {
    /// The system.
    pub motion: &'a Motion<'a>,
    /// Where the run starts.
    pub start: MotionStart,
    /// The time at which it ends.
    pub until: f64,
    /// Receives its segments and events.
    pub observer: &'a mut dyn MotionObserver,
}

impl<'a> PlannedMotion<'a> {
    /// The run, before its first decision.
    pub(super) fn prepared(self, tolerance: f64) -> MotionRun<'a> {
        let Motion { system, equations, .. } = self.motion;
        MotionRun::new((system, equations), &self.start, self.until, tolerance, self.observer)
    }
}

/// Runs, each with its number in the order of the requests.
pub(super) type Queue<'a> = Vec<(usize, PlannedMotion<'a>)>;

/// Receives the end of a run and its number.
pub(super) type Finish<'f> = &'f mut dyn FnMut(usize, Result<MotionEnd, MotionStopped>);
