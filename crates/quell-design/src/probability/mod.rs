//! Uncertain parameters: their joint distribution, samples of it, and what samples say about a result.
//!
//! | file | contents |
//! |---|---|
//! | `distribution` | one parameter |
//! | `joint` | several parameters with a correlation, and the samples for sensitivity indices |
//! | `statistics` | interval of a probability, quantiles |
//! | `sensitivity` | Sobol indices |

mod distribution;
mod joint;
mod sensitivity;
mod statistics;

pub use distribution::Distribution;
pub use joint::{JointDistribution, NoCorrelation, SampledPoints};
pub use sensitivity::{SobolEstimate, SobolIndices, sobol_indices};
pub use statistics::{binomial_interval, quantile};
