//! Runs: functions from a checked study to a typed result, which can be written as JSON and as a dataset.
//!
//! One file per verb. Numbers are reported in the units of the equations and, for a study in SI, also in
//! SI ([`crate::fields`]).

pub mod actuator;
pub mod basins;
pub mod bifurcation;
pub mod check;
pub mod compare;
pub mod criticality;
pub mod decay;
pub mod describing;
pub mod design;
pub mod disc;
mod effect_words;
pub mod exponents;
pub mod fewer_contacts;
pub mod fit;
pub mod found_attractor;
pub mod friction;
pub mod law;
pub mod manoeuvre;
pub mod moment;
pub mod named_estimates;
pub mod noise_response;
pub mod orbit;
pub mod probability;
pub mod protocol;
pub mod quench_numbers;
pub mod ramp;
pub mod record_fit;
pub mod recorded_motion;
pub mod response;
mod sample_times;
pub mod simulate;
pub mod sliding_growth;
pub mod slip;
pub mod stability;
pub mod system;
pub mod thresholds;
pub mod varied;
pub mod waveforms;
pub mod window;

use crate::complaint::Failure;
use quell_numerics::interval::RealInterval;

/// The failure of an interrupted verb.
fn stopped(verb: &str) -> Failure {
    Failure::Failed { key: verb.to_owned(), why: "stopped; no results were kept".into() }
}

/// `count` values at equal steps; both ends are included and exact.
fn evenly(RealInterval { lower: from, upper: to }: RealInterval, count: usize) -> Vec<f64> {
    let last = count.saturating_sub(1);
    let value = |k: usize| from + (to - from) * k as f64 / last as f64;
    (0..count).map(|k| if k == last { to } else { value(k) }).collect()
}

fn failed(why: impl std::fmt::Display) -> Failure {
    Failure::Failed { key: "simulation".to_owned(), why: why.to_string().into() }
}
