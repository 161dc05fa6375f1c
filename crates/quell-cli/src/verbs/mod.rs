//! One verb, one file, one `run`.

pub(crate) mod attractor;
pub(crate) mod basins;
pub(crate) mod bifurcation;
pub(crate) mod check;
pub(crate) mod cite;
pub(crate) mod compare;
pub(crate) mod completions;
pub(crate) mod design;
pub(crate) mod fit;
pub(crate) mod friction;
pub(crate) mod map;
pub(crate) mod modes;
pub(crate) mod new;
mod numbers;
pub(crate) mod orbit;
pub(crate) mod probability;
pub(crate) mod report;
pub(crate) mod reproduce;
pub(crate) mod resonances;
pub(crate) mod response;
pub(crate) mod schema;
mod shard;
pub(crate) mod simulate;
pub(crate) mod sketch;
pub(crate) mod stability;
pub(crate) mod thresholds;
pub(crate) mod waveforms;
