//! The verbs: arguments in, answer out. There is one file per verb, as in the command line.

pub(crate) mod actuator;
pub(crate) mod attractor;
pub(crate) mod basins;
pub(crate) mod bifurcation;
pub(crate) mod check;
pub(crate) mod cite;
pub(crate) mod compare;
pub(crate) mod design;
pub(crate) mod fit;
pub(crate) mod friction;
pub(crate) mod map;
pub(crate) mod modes;
pub(crate) mod new;
pub(crate) mod orbit;
pub(crate) mod probability;
pub(crate) mod receptance;
pub(crate) mod report;
pub(crate) mod reproduce;
pub(crate) mod resonances;
pub(crate) mod response;
pub(crate) mod schema;
pub(crate) mod simulate;
pub(crate) mod sketch;
pub(crate) mod stability;
pub(crate) mod thresholds;
pub(crate) mod waveforms;

use quell::{Complaint, Failure};
use serde_json::Value as Json;

/// A complaint about an argument.
fn refused(argument: &'static str, value: impl Into<Json>, allowed: &str) -> Failure {
    Complaint::option(argument, value, allowed).into()
}
