//! The states at both ends of a run, and why a run can stop early.

use std::fmt;

/// State at the start of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Start {
    /// τ; decides the phase of the dither.
    pub time: f64,
    /// x.
    pub displacement: f64,
    /// x′.
    pub velocity: f64,
}

impl Start {
    /// x = 0, x′ = 0 at τ = 0.
    pub const REST: Self = Self { time: 0.0, displacement: 0.0, velocity: 0.0 };

    /// The state (x, x′) of a belt as a system, at τ = 0.
    ///
    /// # Panics
    /// On a state of fewer numbers.
    pub fn of_state(state: &[f64]) -> Self {
        Self { time: 0.0, displacement: state[0], velocity: state[1] }
    }
}

/// State at the end of a run, and counts of what happened during it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FinalState {
    /// τ.
    pub time: f64,
    /// x.
    pub displacement: f64,
    /// x′.
    pub velocity: f64,
    /// Whether the mass moves with the belt.
    pub sticking: bool,
    /// Sign of v_r; 0 in stick.
    pub slip_sign: i8,
    /// Number of events.
    pub events: u64,
    /// Number of segments integrated.
    pub steps: u64,
    /// Releases at which the threshold was barely crossed (rate of |f_s| − μ_s N below 10⁻⁶
    /// of its scale). Forward uniqueness is not guaranteed there, and our rule decided.
    pub near_tangential_releases: u64,
}

impl FinalState {
    /// The start that continues this run.
    pub fn restart(&self) -> Start {
        Start { time: self.time, displacement: self.displacement, velocity: self.velocity }
    }
}

/// The engine could not continue: the numbers of the study are too extreme for it, or the run would not end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stalled {
    /// τ at which it stopped.
    pub time: f64,
    /// x there.
    pub displacement: f64,
    /// x′ there.
    pub velocity: f64,
    /// The reason.
    pub why: &'static str,
}

impl Stalled {
    /// The result of a run that has not been started yet.
    pub(crate) const NEVER_STARTED: Self = Self::before(&Start::REST, "the run was never started");

    /// A run that does not leave its start.
    pub(crate) const fn before(start: &Start, why: &'static str) -> Self {
        let Start { time, displacement, velocity } = *start;
        Self { time, displacement, velocity, why }
    }
}

impl fmt::Display for Stalled {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "the integration stopped at τ = {:?}: {}", self.time, self.why)
    }
}

impl std::error::Error for Stalled {}

/// How a run ends.
pub(super) type RunResult = Result<FinalState, Stalled>;
