//! Attractors: where runs end, what they end on, and from which starts.
//!
//! ```text
//! start → settle (blocks of periods, until a growth rate decides) → Settled
//! Settled → measure (period, rotation number, extremes, section)  → Attractor
//! many Settled → gather                                            → Basins
//! ```
//!
//! Everything is judged on the stroboscopic section, one state a common period of the dithers (a tenth of 2π without
//! dither). A decision is never made on a small residual: near a threshold everything is slow. What decides
//! is a rate: that of the multipliers where a run nears the response of sliding, that of ∮(2ζ + μ′N)dτ where it
//! lies on a closed curve in slip.
//!
//! | file | what |
//! |---|---|
//! | `strobe` | when the section is taken |
//! | `quiet` | the response that sliding becomes, and the distance from it in which it decays evenly |
//! | `average` | averages over a section that converge faster than any power for quasi-periodic motion |
//! | `rotation` | turns a period, and the fraction at which it locks |
//! | `watch` | what is seen of a block of periods: section, sticks, contraction of area |
//! | `settle` | runs side by side, until each has settled |
//! | `measure` | what it has settled on |
//! | `basin` | which starts end on the same attractor |
//! | `switches` | values of a parameter at which runs from a start begin or cease to end on the base response |

mod average;
mod basin;
mod measure;
mod quiet;
mod rotation;
mod settle;
mod strobe;
mod switches;
mod watch;

pub use crate::orbit::Unsettled;
pub use basin::{Basin, Basins, Label, gather};
pub use measure::{Attractor, Kind, measure, orbit_reached};
pub use quiet::Quiet;
pub use rotation::{Ratio, Rotation};
pub use settle::{Outcome, Patience, Settled, settle, settle_many};
pub use strobe::{Scene, Strobe};
pub use switches::{Reached, Switch, Switches, ramped, reached, switches};
