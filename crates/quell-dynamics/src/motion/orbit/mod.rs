//! Periodic motions of systems, exactly: shooting on the period map, Floquet multipliers through stick, slip and separation.
//!
//! [`family`] makes a system with parameters a [`PeriodMap`](quell_numerics::continuation::PeriodMap), so that branches, thresholds
//! and their curves are those of [`quell_numerics::continuation`], as for the belt.
//!
//! | file | contents |
//! |---|---|
//! | `family` | one period with its derivative and its signature |
//! | `periodic` | a periodic motion, its multipliers and verdict; found near a state, or continued from steady sliding |
//! | `free`, `passages`, `watch` | limit cycles without dither: the search, its section, and its length |
//! | `approach` | how a run approaches steady sliding |
//! | `recurrence` | when a run comes back near its own states |
//! | `ramp` | a run whose dither grows from zero |
//! | `settled` | the periodic motion on which a run ends |
//! | `thresholds` | values of a parameter at which the base response gains or loses stability |
//! | `curves` | their curves over a second parameter |
//! | `sensitivity` | their derivatives with respect to other numbers |

mod approach;
mod curves;
pub mod family;
mod free;
mod passages;
mod periodic;
mod ramp;
mod recurrence;
mod sensitivity;
mod settled;
mod thresholds;
mod transient;
mod watch;

pub use curves::{MotionCurve, MotionCurves, MotionPlane, motion_curves};
pub use free::{NoCycle, free_cycle};
pub use periodic::{
    MotionOrbit, NoMotionOrbit, base_motion, is_on_sliding, motion_near, sliding_state,
};
pub use ramp::ramped_motion;
pub use sensitivity::motion_sensitivity;
pub use settled::{LEAST_PERIODS, MOST_PERIODS, SettledMotion, settled, settled_many};
pub use thresholds::{MotionThreshold, MotionThresholds, motion_thresholds};
