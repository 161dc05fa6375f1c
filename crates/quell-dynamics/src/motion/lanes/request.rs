//! What a run side by side with others is computed from.

use super::super::Motion;
use super::super::engine::MotionRun;
use super::super::equations::MotionEquations;
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

/// A run of the engine for any system, with its number in the order of the requests and the equations.
pub(super) struct QueuedRun<'a> {
    pub(super) number: usize,
    pub(super) equations: &'a MotionEquations,
    pub(super) request: PlannedMotion<'a>,
}

impl<'a> QueuedRun<'a> {
    /// The run, before its first decision.
    pub(super) fn prepared(self, tolerance: f64) -> MotionRun<'a> {
        let PlannedMotion { motion, start, until, observer } = self.request;
        MotionRun::new((motion.system, self.equations), &start, until, tolerance, observer)
    }
}

/// Runs of systems of one shape.
pub(super) type Queue<'a> = Vec<QueuedRun<'a>>;

/// Receives the end of a run and its number.
pub(super) type Finish<'f> = &'f mut dyn FnMut(usize, Result<MotionEnd, MotionStopped>);
