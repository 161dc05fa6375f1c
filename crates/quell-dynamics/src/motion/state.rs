//! The states at both ends of a system's run.

use super::phase::ContactPhase;
use crate::simulation::Start;

/// State at the start of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct MotionStart {
    /// Time; decides the phase of the dither.
    pub time: f64,
    /// Displacements and velocities, or the states of first-order equations.
    pub state: Vec<f64>,
}

impl From<Start> for MotionStart {
    /// The start of one mass on a rigid contact, in the numbers of its equations.
    fn from(start: Start) -> Self {
        Self { time: start.time, state: vec![start.displacement, start.velocity] }
    }
}

/// State of a contact at the end of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactEnd {
    /// What it does.
    pub phase: ContactPhase,
    /// γ.
    pub slip_velocity: f64,
    /// T.
    pub friction: f64,
    /// N; 0 where it is open.
    pub normal_load: f64,
    /// Mean deflection z of the bristles, a length; `None` of a law without them.
    pub bristle: Option<f64>,
}

/// State at the end of a run, and counts of what happened during it.
#[derive(Clone, Debug, PartialEq)]
pub struct MotionEnd {
    /// Time.
    pub time: f64,
    /// State.
    pub state: Vec<f64>,
    /// The contacts.
    pub contacts: Vec<ContactEnd>,
    /// Number of events.
    pub events: u64,
    /// Number of segments integrated.
    pub steps: u64,
    /// Releases at which the threshold was barely crossed: forward uniqueness is not guaranteed there, and our rule decided.
    pub near_tangential_releases: u64,
    /// Contacts whose forces in stick were not unique, because their rows depend on each other: the least-norm forces were
    /// taken. The motion is unique.
    pub dependent: Vec<usize>,
}

impl MotionEnd {
    /// The start that continues this run.
    pub fn restart(&self) -> MotionStart {
        MotionStart { time: self.time, state: self.state.clone() }
    }
}
