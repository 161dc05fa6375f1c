//! The failure of a measurement.

use std::fmt::Display;

use quell::complaint::Failure;

/// The failure of a computation that returned no value.
pub(super) fn failed(name: &str, why: &impl Display) -> Failure {
    Failure::Failed { key: format!("reproduce {name}"), why: why.to_string().into() }
}
