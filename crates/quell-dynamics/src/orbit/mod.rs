//! Periodic motions, exactly: shooting on the period map, Floquet multipliers through stick, slip and separation.
//!
//! The steady response to periodic dither is a fixed point of the map over one common period (or n of them). Its stability
//! is decided by the multipliers of the map's derivative, which is integrated along the run with a jump at every event; neither
//! averaging nor a long simulation is needed. [`OrbitFamily`] makes a system with parameters a
//! [`PeriodMap`](quell_numerics::continuation::PeriodMap), so that shooting, branches, thresholds and their curves are those of
//! [`quell_numerics::continuation`]. A belt is its system ([`Belt::system`](quell_model::Belt::system)).
//!
//! | file | contents |
//! |---|---|
//! | `family` | one period with its derivative and its signature |
//! | `periodic`, `verdict` | a periodic motion, its multipliers and verdict; found near a state, or continued from steady sliding |
//! | `cycle` | every limit cycle of one mass without dither, by the map of its sizes |
//! | `free`, `passages`, `watch` | limit cycles of other systems: the search, its section, and its length |
//! | `approach` | how a run approaches steady sliding |
//! | `recurrence` | when a run comes back near its own states |
//! | `ramp` | a run whose dither grows from zero |
//! | `cycle_search` | a stable limit cycle from several starts |
//! | `settled`, `transient` | the periodic motion on which a run ends |
//! | `cycle_samples`, `passing` | samples over a period, and how near a state it passes |
//! | `sliding` | the verdict on steady sliding, and how a start on it is displaced |
//! | `threshold_kind`, `thresholds` | values of a parameter at which the base response gains or loses stability |
//! | `curves`, `threshold_curve` | their curves over a second parameter |
//! | `sensitivity` | their derivatives with respect to other numbers |

mod approach;
mod curves;
mod cycle;
mod cycle_samples;
mod cycle_search;
mod family;
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
mod threshold_kind;
mod thresholds;
mod transient;
mod verdict;
mod watch;

pub use curves::{ThresholdPlane, threshold_curves};
pub use cycle::{CycleMapError, FreeEnd, cycles, free_end, keeps_vibrating};
pub(crate) use cycle::{cycle_reached, verdict_of_sliding};
pub use cycle_samples::{CycleSamples, SampledContact};
pub use cycle_search::{
    BASE_STEPS, CycleSearch, NamedStart, NoSqueal, TriedStart, base_state, kicked_by, search_cycle,
    squealing_state, usual_starts, without_cycle,
};
pub use family::{MotionSignature, NoImage, OrbitFamily, SystemAt};
pub use free::{NoCycle, free_cycle, limit_cycles};
pub use passing::nearest_distance;
pub(crate) use periodic::orbit_at;
pub use periodic::{NoOrbit, Orbit, base_response, is_on_sliding, near, shortened, sliding_state};
pub use ramp::ramped_motion;
pub use sensitivity::sensitivity_of_threshold;
pub use settled::{LEAST_PERIODS, MOST_PERIODS, SettledMotion, settled, settled_many};
pub use sliding::{NoSlidingVerdict, displaced, sliding_verdict};
pub use threshold_curve::{
    CurvesFound, Open, OpenLine, PointForm, ThresholdCurve, ThresholdCurveEnd, ThresholdCurvePoint,
};
pub use threshold_kind::{BranchEnding, ResponseGap, ThresholdKind};
pub use thresholds::{
    BranchResponse, BranchThresholds, SignatureChange, Threshold, branch_thresholds,
};
pub use verdict::OrbitVerdict;
