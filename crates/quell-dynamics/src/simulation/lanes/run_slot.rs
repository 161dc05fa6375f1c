//! The place of a run in its lane.

use quell_model::Belt;

use super::super::engine::Engine;
use super::super::slip_step::SlipDue;

/// A run in its lane.
pub(super) struct RunSlot<'a> {
    /// Number of the run in the queue.
    pub(super) number: usize,
    pub(super) belt: &'a Belt,
    pub(super) engine: Engine<'a>,
    /// The slip step that the engine asked for last.
    pub(super) due: SlipDue,
    /// Round of the loop in which the state of `engine` was last brought up to date.
    pub(super) synced: u64,
}
