//! Event-exact trajectories of the belt by adaptive Taylor series.
//!
//! * Slip is a Taylor step of order [`ORDER`] on one analytic branch of the law
//!   (`slip`). Its length keeps the last two retained terms below the tolerance.
//! * Stick is in closed form. The release is the first root of |f_s| − μ_s N: under a single sine it is
//!   found without a series (`release`), under any other dither with one (`stick`).
//! * Every root of a step is isolated or proven absent
//!   ([`quell_numerics::polynomial::first_crossing`]). Kinks and jumps of the dither are time
//!   events (`forcing`).
//! * Order of simultaneous events: first the kink or jump, then the stick test with the
//!   new value (stick while |f_s| − μ_s N ≤ 0), then release or reversal, then passive events.
//! * Lengths are measured in the law's velocity scale v_m: multiplying F, v₀, v_m, D and x(0)
//!   by a power of two leaves every event time identical to the last bit.
//! * With μ_s > μ_k, forward uniqueness fails at a tangential release. The rule "stick while
//!   |f_s| ≤ μ_s N" is our declared selection, and such releases are counted
//!   ([`FinalState::near_tangential_releases`]).
//! * Steps are counted: a run that would not end in reasonable time is stopped, and the reason is reported (`step_budget`).
//!
//! Taylor step control: Jorba and Zou (2005). Order of events and stick rules: the errata
//! and traps of the project's documentation, chapter "The belt".
//!
//! | file | contents |
//! |---|---|
//! | `state`, `run`, `simulate` | what goes into a run and comes out of it, and the functions that integrate |
//! | `run_state` | the state of a run between events; `engine` and `transitions` change it |
//! | `engine` | one run between its slip steps; `transitions` decides what the contact does at v_r = 0 |
//! | `slip`, `slip_step` | the series of a slip step, and what engine and lanes exchange about it |
//! | `stick`, `release` | the end of a stick |
//! | `forcing`, `clock`, `taylor` | dither, time, order of the series |
//! | `lanes` | slip steps of many runs side by side |
//! | `observer`, `event`, `largest_slip` | what a run reports |
//! | `step_budget` | the limit on steps |

mod clock;
mod collocation;
mod engine;
mod event;
mod forcing;
mod lane_row;
mod lanes;
mod largest_slip;
mod observer;
mod release;
mod run;
mod run_state;
mod simulate;
mod slip;
mod slip_step;
mod state;
mod step_budget;
mod stick;
mod taylor;
mod transitions;
mod variation;

pub use quell_numerics::dispatch::InstructionSet;

pub use clock::Clock;
pub use event::{Event, EventKind};
pub(crate) use forcing::{Forcing, harmonic_series};
pub use largest_slip::{LargestSlip, largest_slips};
pub(crate) use observer::shift;
pub use observer::{EventRecorder, Observer, Sample, Sampler, Segment, VelocitySection};
pub use run::SimulationRun;
pub(crate) use simulate::continue_slip;
pub use simulate::{DEFAULT_TOLERANCE, simulate, simulate_many, simulate_many_with};
pub use state::{FinalState, Stalled, Start};
pub(crate) use step_budget::StepBudget;
pub use step_budget::{MOST_STEPS, apart, count_taken, is_used_up, left, within};
pub use taylor::ORDER;
pub(crate) use taylor::{RECIPROCALS, Series};
pub use variation::{Matrix2, Variation};
