//! Periodic responses, exactly: Newton shooting on the period map, Floquet multipliers through stick and slip.
//!
//! The steady response to periodic dither is a fixed point of the map over one common period (or n of them). Its stability
//! is decided by the multipliers of the map's derivative, which `variation` integrates along the run with a jump at
//! every event; neither averaging nor a long simulation is needed. In pure slip det M = exp(−∮(2ζ + μ′N)dτ). With a
//! stick one multiplier is 0, because the mass always leaves the stick in the same state.
//!
//! Shooting, branches and thresholds are the mathematics of [`quell_numerics::continuation`]. [`family`] provides the
//! period map of a belt, and is the part to be rewritten for a model with more masses and contacts.
//!
//! * [`threshold`]: the values of a parameter at which the base response gains or loses stability;
//! * [`cycle`]: the limit cycles of an undithered belt, stable or not, and the limit sets of undithered runs.
//!
//! | file | contents |
//! |---|---|
//! | `period` | the common period of the dithers |
//! | `variation`, `collocation` | the variational equation along a run |
//! | `period_map` | one period with its derivative, and the multipliers |
//! | `periodic_orbit`, `verdict`, `no_orbit` | a periodic response, its stability, and why none was found |
//! | `accuracy` | the errors of an orbit and of its multipliers |
//! | `shooting` | an orbit near a state, or continued from steady sliding |

mod accuracy;
mod collocation;
pub mod cycle;
pub mod family;
mod no_orbit;
mod period;
mod period_map;
mod periodic_orbit;
mod shooting;
pub mod threshold;
mod variation;
mod verdict;

pub use no_orbit::{NoOrbit, Unsettled};
pub use period::common_period;
pub(crate) use period_map::multipliers_of;
pub use periodic_orbit::Orbit;
pub use shooting::{from_sliding, near};
pub use variation::Matrix2;
pub(crate) use variation::Variation;
pub use verdict::OrbitVerdict;
