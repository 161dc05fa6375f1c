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
//! | `cycle_search` | a stable limit cycle from several starts |
//! | `settled` | the periodic motion on which a run ends |
//! | `sliding` | the verdict on steady sliding, and how a start on it is displaced |
//! | `thresholds` | values of a parameter at which the base response gains or loses stability |
//! | `curves`, `threshold_curve` | their curves over a second parameter |
//! | `sensitivity` | their derivatives with respect to other numbers |

mod approach;
mod curves;
mod cycle_samples;
mod cycle_search;
pub mod family;
mod free;
mod passages;
mod passing;
mod periodic;
mod ramp;
mod recurrence;
mod sensitivity;
mod settled;
mod sliding;
mod threshold_curve;
mod thresholds;
mod transient;
mod watch;

pub use curves::{MotionPlane, motion_curves};
pub use cycle_samples::{CycleSamples, SampledContact};
pub use cycle_search::{
    BASE_STEPS, CycleSearch, NamedStart, TriedStart, base_state, kicked_by, search_cycle,
    squealing_state, usual_starts, without_cycle,
};
pub use free::{NoCycle, free_cycle, limit_cycles};
pub use passing::nearest_distance;
pub use periodic::{
    MotionOrbit, NoMotionOrbit, base_motion, is_on_sliding, motion_near, sliding_state,
};
pub use ramp::ramped_motion;
pub use sensitivity::motion_sensitivity;
pub use settled::{LEAST_PERIODS, MOST_PERIODS, SettledMotion, settled, settled_many};
pub use sliding::{displaced, sliding_verdict};
pub use threshold_curve::{
    CurvesFound, Open, OpenLine, PointForm, ThresholdCurve, ThresholdCurveEnd, ThresholdCurvePoint,
};
pub use thresholds::{MotionSignatureChange, MotionThreshold, MotionThresholds, motion_thresholds};
