//! Attractors: where runs settle, which attractor that is, and from which starts.
//!
//! ```text
//! start → settle (blocks of periods, until a growth rate decides) → Settled
//! Settled → measure (period, rotation number, extremes, section)  → Attractor
//! many Settled → gather                                            → BasinsOfAttraction
//! ```
//!
//! Everything is judged on the stroboscopic section, one state per common period of the dithers (per tenth of 2π without
//! dither). No decision is based on a small residual alone, because near a threshold everything is slow. A rate
//! decides: that of the multipliers where a run converges to the base response, that of ∮(2ζ + μ′N)dτ where it
//! is on a closed curve in slip.
//!
//! | file | contents |
//! |---|---|
//! | `section` | the stroboscopic section |
//! | `base_response` | the response continued from sliding, and a distance from it that decays geometrically |
//! | `settings` | belt, section and base response: the settings of every judgement |
//! | `average` | averages over a section that converge faster than any power for quasi-periodic motion |
//! | `rotation` | revolutions per period, and the fraction at which the motion locks |
//! | `block_observer` | observation of a block of periods: section, sticks, contraction of areas |
//! | `settle`, `unsettled` | runs side by side, until each has settled, or why one has not |
//! | `measure` | classification of the attractor of a settled run |
//! | `basin`, `starts` | which starts lead to the same attractor, of one mass and of any system |
//! | `end_of_run` | the motion on which a run of any system ends |
//! | `outcome` | whether it is quiet, without a record of it |
//! | `switches` | values of a parameter at which that changes |
//! | `system_attractor` | that motion |

mod average;
mod base_response;
mod basin;
mod block_observer;
mod end_of_run;
mod measure;
mod outcome;
mod rotation;
mod section;
mod settings;
mod settle;
mod starts;
mod switches;
mod system_attractor;
mod unsettled;

pub use base_response::BaseResponse;
pub use basin::{Basin, BasinLabel, BasinsOfAttraction, gather};
pub use end_of_run::{EndOfRun, NoEnd, end_of_run, orbit_of_run, starts_of_mass};
pub use measure::{Attractor, AttractorKind, measure};
pub use outcome::{NoOutcome, NoStart, RunOutcome, outcome_of_run};
pub use rotation::{Ratio, Rotation};
pub use section::StroboscopicSection;
pub use settings::AttractorSettings;
pub use settle::{Patience, SettleOutcome, Settled, settle, settle_many};
pub use starts::{GroupedStarts, JudgedStarts, StartJudge, UnknownEnd};
pub use switches::{
    RunSwitch, RunSwitches, SWITCH_CLOSENESS, StartOfRun, TriedValue, VariedRun, values_tried,
};
pub use system_attractor::{MotionKind, SystemAttractor};
pub use unsettled::Unsettled;
