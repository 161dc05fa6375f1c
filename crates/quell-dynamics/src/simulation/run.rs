//! What is to be integrated: a belt, its initial state, the end time and the observer.

use quell_model::Belt;

use super::observer::Observer;
use super::state::Start;

/// One run: a belt, integrated from a state to a time, and the observer of the run.
pub struct SimulationRun<'a> {
    /// The belt.
    pub belt: &'a Belt,
    /// The initial state. At x′ = v₀ the contact is decided by f_s alone, without an event.
    pub start: Start,
    /// τ at which the run ends.
    pub until: f64,
    /// Receives every segment and event.
    pub observer: &'a mut dyn Observer,
}

/// What all runs of one call share.
#[derive(Clone, Copy, Debug)]
pub(super) struct RunTerms {
    /// Bound on the last retained terms of a step, relative to F.
    pub(super) tolerance: f64,
    /// Sign of the branch of the law on which slip goes on, regardless of the sign of v_r; `None` where the contact decides.
    pub(super) branch: Option<f64>,
}
